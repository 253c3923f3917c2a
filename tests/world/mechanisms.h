#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "engine/world/world.h"

// Mechanisms drawn at random: bodies of very different mass, tied to each other by joints of all kinds.
namespace plumb::test {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double in(double a, double b) { return a + (b - a) * (double(engine_() >> 11) * 0x1p-53); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  bool one_in(int n) { return below(n) == 0; }

 private:
  std::mt19937_64 engine_;
};

enum class Ties { Hinges, Limits, Motors, Welds, SoftWelds, Sliders, Rods, Mixed };
inline constexpr const char* kTies[] = {"hinges",     "limits",  "motors", "welds",
                                        "soft welds", "sliders", "rods",   "mixed"};
enum class Layout { Star, Tree, Chain, Bridge, Grid, Walker };
inline constexpr const char* kLayouts[] = {"star", "tree", "chain", "bridge", "grid", "walker"};

struct Plan {
  Layout layout{};
  Ties ties{};
  int count = 0;     // of bodies
  double ratio = 1;  // of masses
  double arm = 1;    // m
  bool floor = false, gravity = false, load = false;
  double speed = 0, spin = 0;
  std::string text() const {
    return std::string(kLayouts[int(layout)]) + " of " + std::to_string(count) + ", " + kTies[int(ties)] +
           ", masses 1:" + std::to_string(ratio) + (floor ? ", floor" : "") + (gravity ? ", gravity" : "") +
           (load ? ", load" : "") + ", speed " + std::to_string(speed) + ", spin " + std::to_string(spin);
  }
};

inline Plan draw_plan(Draw& draw) {
  Plan plan;
  plan.layout = static_cast<Layout>(draw.below(6));
  plan.ties = static_cast<Ties>(draw.below(8));
  plan.count = 2 + draw.below(draw.one_in(4) ? 29 : 9);
  plan.ratio = std::pow(10, draw.one_in(3) ? 0 : draw.in(0, draw.one_in(4) ? 6 : 3));
  plan.floor = plan.layout == Layout::Walker || draw.one_in(3);
  plan.gravity = plan.floor || draw.one_in(2);
  plan.load = plan.layout == Layout::Bridge && draw.one_in(2);
  plan.speed = draw.one_in(2) ? 0 : draw.in(0, 10);
  plan.spin = draw.one_in(2) ? 0 : draw.in(-4, 4);
  return plan;
}

template <class Real>
struct Mechanism {
  BasicWorld<Real> world;
  std::vector<BodyId> bodies{};
  std::vector<JointId> joints{};
  double size = 1;  // m, of the shortest link
  bool driven = false;

  double energy() const {
    double sum = 0;
    const Vec2d g = world.gravity();
    for (const BodyId b : bodies) {
      const Vec2d v = world.velocity(b);
      const double w = world.angular_velocity(b);
      sum += 0.5 * world.mass(b) * length_squared(v) + 0.5 * world.inertia(b) * w * w -
             world.mass(b) * dot(g, world.centre(b));
    }
    return sum;
  }
  double gap() const {
    double worst = 0;
    for (const JointId j : joints) worst = std::max(worst, double(world.read(j).linear_error));
    return worst;
  }
};

// Joins two bodies at a point of the world.
template <class Real>
void tie(Mechanism<Real>& m, Draw& draw, Ties ties, BodyId a, BodyId b, Vec2d at) {
  auto& w = m.world;
  const Vec2d anchor_a = w.local_point(a, at), anchor_b = w.local_point(b, at);
  const double reference = std::remainder(w.angle(b) - w.angle(a), 2 * std::numbers::pi);
  if (ties == Ties::Mixed) ties = static_cast<Ties>(draw.below(7));
  const auto join = [&](const JointKind& kind) { m.joints.push_back(w.create_joint(a, b, {.kind = kind})); };
  switch (ties) {
    case Ties::Hinges:
      return join(RevoluteDefinition{.anchor_a = anchor_a, .anchor_b = anchor_b});
    case Ties::Limits: {
      const double room = draw.one_in(3) ? 0 : draw.in(0, 1);
      return join(RevoluteDefinition{.anchor_a = anchor_a,
                                     .anchor_b = anchor_b,
                                     .reference_angle = reference,
                                     .limits = Range{-room, room}});
    }
    case Ties::Motors:
      return join(RevoluteDefinition{.anchor_a = anchor_a,
                                     .anchor_b = anchor_b,
                                     .reference_angle = reference,
                                     .motor = Motor{.speed = 0, .max_force = std::pow(10, draw.in(-1, 3))}});
    case Ties::Welds:
      return join(WeldDefinition{.anchor_a = anchor_a, .anchor_b = anchor_b, .reference_angle = reference});
    case Ties::SoftWelds: {
      const Spring spring{.hertz = std::pow(10, draw.in(0, 1.3)), .damping_ratio = draw.in(0, 1)};
      return join(WeldDefinition{.anchor_a = anchor_a,
                                 .anchor_b = anchor_b,
                                 .reference_angle = reference,
                                 .angular_spring = spring});
    }
    case Ties::Sliders: {
      const double angle = draw.in(0, std::numbers::pi);
      return join(PrismaticDefinition{.anchor_a = anchor_a,
                                      .anchor_b = anchor_b,
                                      .axis = {std::cos(angle), std::sin(angle)},
                                      .reference_angle = reference,
                                      .limits = Range{-draw.in(0, 0.2), draw.in(0, 0.2)}});
    }
    default: {
      // A rod between the centres.
      const bool apart = length_squared(w.centre(a) - w.centre(b)) > 0.01;
      const Vec2d from = apart ? w.centre(a) : at, to = w.centre(b);
      return join(DistanceDefinition{.anchor_a = w.local_point(a, from),
                                     .anchor_b = w.local_point(b, to),
                                     .length = std::sqrt(length_squared(to - from))});
    }
  }
}

template <class Real>
Mechanism<Real> build(const Plan& plan, std::uint64_t seed, WorldDefinition definition = {}) {
  Draw draw(seed ^ 0x9e3779b97f4a7c15ull);
  definition.gravity = {0, plan.gravity ? -9.81 : 0};
  Mechanism<Real> m{BasicWorld<Real>(definition)};
  auto& w = m.world;
  const Filter own{.group = -1};
  const double height = plan.floor ? 6 : 0;
  const BodyId ground = w.create_body({.type = BodyType::Static});
  if (plan.floor)
    w.create_shape(w.create_body({.type = BodyType::Static, .position = {0, -1}}),
                   {.geometry = Box{4000, 2}});
  const auto density = [&] { return std::pow(plan.ratio, draw.in(0, 1)); };
  const auto box = [&](Vec2d at, double angle, double length, double width) {
    const BodyId b = w.create_body({.position = at, .angle = angle},
                                   {.geometry = Box{length, width}, .density = density(), .filter = own});
    m.bodies.push_back(b);
    return b;
  };
  const double pi = std::numbers::pi;
  switch (plan.layout) {
    case Layout::Star: {
      const double hub = draw.in(0.15, 0.5);
      const BodyId centre = w.create_body({.position = {0, height}},
                                          {.geometry = Circle{hub}, .density = density(), .filter = own});
      m.bodies.push_back(centre);
      const double arm = hub * draw.in(1, 6);
      for (int i = 0; i < plan.count - 1; ++i) {
        const double angle = 2 * pi * i / (plan.count - 1);
        const Vec2d d{std::cos(angle), std::sin(angle)}, o{0, height};
        const BodyId b = box(o + (hub + arm / 2) * d, angle, arm, 0.1 * arm);
        tie(m, draw, plan.ties, centre, b, o + hub * d);
      }
      m.size = hub;
      break;
    }
    case Layout::Tree: {
      struct Tip {
        BodyId body;
        Vec2d at;
        double angle;
      };
      std::vector<Tip> tips{{box({0, height}, 0, 1, 0.1), {0.5, height}, 0}};
      while (static_cast<int>(m.bodies.size()) < plan.count) {
        const Tip from = tips[draw.below(static_cast<int>(tips.size()))];
        const double angle = from.angle + draw.in(-1.2, 1.2), length = draw.in(0.4, 1.2);
        const Vec2d d{std::cos(angle), std::sin(angle)};
        const BodyId b = box(from.at + length / 2 * d, angle, length, 0.1);
        tie(m, draw, plan.ties, from.body, b, from.at);
        tips.push_back({b, from.at + length * d, angle});
      }
      m.size = 0.4;
      break;
    }
    case Layout::Chain:
    case Layout::Bridge: {
      const bool bridge = plan.layout == Layout::Bridge;
      BodyId last = ground;
      const bool hung = bridge || draw.one_in(2);
      for (int i = 0; i < plan.count; ++i) {
        const BodyId b = box({i + 0.5, height}, 0, 0.95, 0.2);
        if (i > 0 || hung) tie(m, draw, plan.ties, last, b, {double(i), height});
        last = b;
      }
      if (bridge) tie(m, draw, plan.ties, last, ground, {double(plan.count), height});
      if (plan.load)
        m.bodies.push_back(w.create_body({.position = {plan.count / 2.0, height + 0.6}},
                                         {.geometry = Box{1, 1}, .density = 5 * plan.ratio}));
      break;
    }
    case Layout::Grid: {
      const int n = std::max(2, static_cast<int>(std::sqrt(double(plan.count))));
      for (int i = 0; i < n * n; ++i) box({double(i % n), height + i / n}, 0, 1, 1);
      for (int i = 0; i < n * n; ++i) {
        const Vec2d at{double(i % n), height + i / n};
        if (i % n + 1 < n) tie(m, draw, plan.ties, m.bodies[i], m.bodies[i + 1], at + Vec2d{0.5, 0});
        if (i + n < n * n) tie(m, draw, plan.ties, m.bodies[i], m.bodies[i + n], at + Vec2d{0, 0.5});
      }
      break;
    }
    case Layout::Walker: {
      const int legs = 2 + plan.count % 5;
      const BodyId torso = box({0, 2.2}, 0, 0.6, 0.3);
      for (int i = 0; i < legs; ++i) {
        const double angle = -pi / 2 + (i - (legs - 1) / 2.0) * 0.5;
        const Vec2d d{std::cos(angle), std::sin(angle)}, hip{0.2 * d.x, 2.2 + 0.15 * d.y};
        tie(m, draw, plan.ties, torso, box(hip + 0.75 * d, angle, 1.5, 0.1), hip);
      }
      m.size = 0.3;
      break;
    }
  }
  Vec2d centre{};
  double mass = 0;
  for (const BodyId b : m.bodies) centre += double(w.mass(b)) * w.centre(b), mass += w.mass(b);
  centre = (1 / mass) * centre;
  const bool free = plan.layout != Layout::Bridge && plan.layout != Layout::Walker;
  const double heading = draw.in(0, 2 * pi);
  if (free)
    for (const BodyId b : m.bodies) {
      const Vec2d r = w.centre(b) - centre;
      w.set_velocity(b, Vec2d{plan.speed * std::cos(heading), plan.speed * std::sin(heading)} +
                            plan.spin * Vec2d{-r.y, r.x});
      w.set_angular_velocity(b, plan.spin);
    }
  return m;
}

struct Verdict {
  double growth = 0, gap = 0, scale = 0;
  int step = 0;
  bool lost = false;
};

// Runs it: the most that its energy has grown by, as a share of what there is, and the widest gap as a share
// of a link.
template <class Real>
Verdict run_mechanism(Mechanism<Real>& m, int steps, double dt = 1.0 / 60, int substeps = 4) {
  Verdict v;
  const double start = m.energy();
  double mass = 0, kinetic = 0;
  for (const BodyId b : m.bodies) {
    mass += m.world.mass(b);
    kinetic += 0.5 * m.world.mass(b) * length_squared(m.world.velocity(b)) +
               0.5 * m.world.inertia(b) * m.world.angular_velocity(b) * m.world.angular_velocity(b);
  }
  v.scale = kinetic + mass * std::sqrt(length_squared(m.world.gravity())) * m.size;
  const double scale = std::max(v.scale, 1e-6 * mass);
  for (int i = 0; i < steps; ++i) {
    m.world.step(dt, substeps);
    const double growth = (m.energy() - start) / scale;
    if (growth > v.growth || !(growth == growth)) v.growth = growth, v.step = i;
    v.gap = std::max(v.gap, m.gap() / m.size);
    v.lost = v.lost || !m.world.events().quarantined.empty();
    if (v.lost || !(growth < 1e3)) {
      v.lost = true;
      break;
    }
  }
  return v;
}

}  // namespace plumb::test
