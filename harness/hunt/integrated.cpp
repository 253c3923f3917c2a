// Computes the motion of free bodies under force laws, independently of every engine.
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "engine/scene/geometry.h"
#include "harness/hunt/outline.h"
#include "harness/hunt/relations.h"
#include "harness/hunt/subject.h"

namespace plumb::harness::hunt {
namespace {

// Integration steps per sample. Twice as many give the error, which must stay below a tenth of the bound.
constexpr int kSteps = 48;
constexpr double kKnown = 0.1;
// For Precise: the bound, as a fraction of the scene's size, and the largest growth of perturbations for
// which errors of its tolerance stay below that bound.
constexpr double kPreciseShare = 1e-6, kGrown = 1000;
// Largest change of a result when its step is halved, as a fraction of the bound.
constexpr double kSteady = 0.25;
constexpr double kShare = 0.05;  // tolerance of first-order methods, as a fraction of the smallest body
// rad, largest rotation in a step of a body with an off-centre force: beyond it, first-order methods
// misjudge the force's direction.
constexpr double kMostTurn = 0.5;

double length(Vec2d v) { return std::hypot(v.x, v.y); }
Vec2d turned(double angle, Vec2d v) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// Force and torque on each body.
struct Loads {
  std::vector<Vec2d> force;
  std::vector<double> torque;
};

class Free {
 public:
  explicit Free(const Case& one) : scene_(one.scene) {
    for (const Body& body : scene_.bodies) inertia_.push_back(inertia_of(body));
    for (const ForceLaw& law : scene_.forces) {
      if (const auto* force = std::get_if<PointForce>(&law)) add_switches(force->start, force->duration);
      if (const auto* torque = std::get_if<Torque>(&law)) add_switches(torque->start, torque->duration);
    }
  }

  std::vector<BodyState> start() const {
    std::vector<BodyState> out;
    for (const Body& body : scene_.bodies) out.push_back(initial_state(body));
    return out;
  }

  /// Integrates from `from` to `to` by the classical fourth-order Runge-Kutta method, in parts between the
  /// times at which forces switch on or off.
  void advance(std::vector<BodyState>& states, double from, double to, int steps) const {
    std::vector<double> ends{from};
    for (const double at : switches_)
      if (at > from && at < to) ends.push_back(at);
    ends.push_back(to);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      middle_ = 0.5 * (ends[i] + ends[i + 1]);
      const double h = (ends[i + 1] - ends[i]) / steps;
      for (int k = 0; k < steps; ++k) step(states, ends[i] + k * h, h);
    }
  }

 private:
  void add_switches(double at, double lasts) {
    switches_.insert(at);
    if (std::isfinite(lasts)) switches_.insert(at + lasts);
  }

  void step(std::vector<BodyState>& y, double t, double h) const {
    const auto a = rates(y, t), b = rates(moved(y, a, h / 2), t + h / 2),
               c = rates(moved(y, b, h / 2), t + h / 2), d = rates(moved(y, c, h), t + h);
    y = moved(moved(moved(moved(y, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
  }

  static std::vector<BodyState> moved(std::vector<BodyState> y, const std::vector<BodyState>& rate,
                                      double h) {
    for (std::size_t i = 0; i < y.size(); ++i) {
      y[i].position += h * rate[i].position, y[i].angle += h * rate[i].angle;
      y[i].velocity += h * rate[i].velocity, y[i].angular_velocity += h * rate[i].angular_velocity;
    }
    return y;
  }

  std::vector<BodyState> rates(const std::vector<BodyState>& y, double t) const {
    Loads loads{std::vector<Vec2d>(y.size()), std::vector<double>(y.size(), 0)};
    for (const ForceLaw& law : scene_.forces) std::visit([&](const auto& l) { add(l, y, t, loads); }, law);
    std::vector<BodyState> out(y.size());
    for (std::size_t i = 0; i < y.size(); ++i) {
      const Body& body = scene_.bodies[i];
      if (body.type == BodyType::Static) continue;
      out[i].position = y[i].velocity, out[i].angle = y[i].angular_velocity;
      if (body.type != BodyType::Dynamic) continue;
      out[i].velocity = (1 / body.mass) * loads.force[i] + body.gravity_scale * scene_.gravity -
                        body.linear_damping * y[i].velocity;
      out[i].angular_velocity = loads.torque[i] / inertia_[i] - body.angular_damping * y[i].angular_velocity;
    }
    return out;
  }

  std::size_t at(const std::string& name) const { return find_body(scene_, name).value(); }
  void push(Loads& loads, std::size_t body, Vec2d arm, Vec2d force) const {
    loads.force[body] += force;
    loads.torque[body] += arm.x * force.y - arm.y * force.x;
  }
  // A part lies between two switches, so a force acts during the whole part or not at all: test its middle.
  bool acts(double start, double duration) const { return middle_ >= start && middle_ < start + duration; }

  void add(const LinearDrag& law, const std::vector<BodyState>& y, double, Loads& out) const {
    const std::size_t i = at(law.body);
    out.force[i] -= law.coefficient * y[i].velocity;
    if constexpr (requires { law.angular_coefficient; })
      out.torque[i] -= law.angular_coefficient * y[i].angular_velocity;
  }
  void add(const QuadraticDrag& law, const std::vector<BodyState>& y, double, Loads& out) const {
    const std::size_t i = at(law.body);
    out.force[i] -= law.coefficient * length(y[i].velocity) * y[i].velocity;
  }
  void add(const PointForce& law, const std::vector<BodyState>& y, double, Loads& out) const {
    if (!acts(law.start, law.duration)) return;
    const std::size_t i = at(law.body);
    const Vec2d force = law.frame == Frame::Body ? turned(y[i].angle, law.force) : law.force;
    push(out, i, turned(y[i].angle, law.point), force);
  }
  void add(const Torque& law, const std::vector<BodyState>&, double, Loads& out) const {
    if (acts(law.start, law.duration)) out.torque[at(law.body)] += law.torque;
  }
  void add(const SinusoidalForce& law, const std::vector<BodyState>& y, double t, Loads& out) const {
    const std::size_t i = at(law.body);
    push(out, i, turned(y[i].angle, law.point),
         std::sin(law.angular_frequency * t + law.phase) * law.amplitude);
  }
  void add(const SpringForce& law, const std::vector<BodyState>& y, double, Loads& out) const {
    struct End {
      Vec2d point{}, velocity{}, arm{};
    };
    const auto end = [&](const std::string& name, Vec2d anchor) {
      if (name == kWorld) return End{.point = anchor};
      const BodyState& s = y[at(name)];
      const Vec2d arm = turned(s.angle, anchor);
      return End{s.position + arm, s.velocity + s.angular_velocity * Vec2d{-arm.y, arm.x}, arm};
    };
    const End a = end(law.body_a, law.anchor_a), b = end(law.body_b, law.anchor_b);
    const Vec2d way = b.point - a.point;
    const double now = length(way);
    if (now == 0) return;
    const Vec2d along = (1 / now) * way;
    const double tension =
        law.stiffness * (now - law.rest_length) + law.damping * dot(b.velocity - a.velocity, along);
    if (law.body_a != kWorld) push(out, at(law.body_a), a.arm, tension * along);
    if (law.body_b != kWorld) push(out, at(law.body_b), b.arm, -tension * along);
  }
  void add(const AttractionForce& law, const std::vector<BodyState>& y, double, Loads& out) const {
    const std::size_t i = at(law.body);
    Vec2d centre = law.centre, arm{};
    std::optional<std::size_t> holder;
    if (law.centre_body != kWorld) {
      holder = at(law.centre_body);
      arm = turned(y[*holder].angle, law.centre);
      centre = y[*holder].position + arm;
    }
    const Vec2d way = centre - y[i].position;
    const double r = length(way);
    if (r == 0) return;
    const Vec2d force = law.strength * scene_.bodies[i].mass * std::pow(r, -law.exponent - 1) * way;
    out.force[i] += force;
    if (holder) push(out, *holder, arm, -1.0 * force);
  }

  // Scenes with formulas are not `integrable`.
  void add(const FormulaForce&, const std::vector<BodyState>&, double, Loads&) const {}
  void add(const FormulaSpring&, const std::vector<BodyState>&, double, Loads&) const {}

  const Scene& scene_;
  std::vector<double> inertia_;
  std::set<double> switches_;
  mutable double middle_ = 0;  // s, middle of the part that is being integrated
};

/// Returns true if shapes that may touch are so near to each other that they might touch within a sample.
bool may_meet(const Case& one, const std::vector<BodyState>& states) {
  const std::vector<double> extent = extents(one.scene);
  for (std::size_t i = 0; i < states.size(); ++i)
    for (std::size_t j = i + 1; j < states.size(); ++j) {
      const Body &a = one.scene.bodies[i], &b = one.scene.bodies[j];
      if (a.type != BodyType::Dynamic && b.type != BodyType::Dynamic) continue;
      const double spin =
          extent[i] * std::abs(states[i].angular_velocity) + extent[j] * std::abs(states[j].angular_velocity);
      const double way = 3 * one.dt * (length(states[i].velocity - states[j].velocity) + spin) +
                         0.01 * (extent[i] + extent[j]);
      for (const Shape& s : a.shapes)
        for (const Shape& t : b.shapes) {
          if (!may_touch(s.filter, t.filter)) continue;
          for (const Outline& of : outlines_of(s))
            for (const Outline& other : outlines_of(t))
              if (separation(placed(of, states[i]), placed(other, states[j])) < way) return true;
        }
    }
  return false;
}

/// Returns for each body true if a force on it depends on its angle.
std::vector<bool> pulled_beside_centre(const Scene& scene) {
  std::vector<bool> out(scene.bodies.size(), false);
  const auto mark = [&](const std::string& name, Vec2d arm) {
    if (const auto at = find_body(scene, name); at && arm != Vec2d{}) out[*at] = true;
  };
  for (const ForceLaw& law : scene.forces) {
    if (const auto* force = std::get_if<PointForce>(&law))
      mark(force->body, force->frame == Frame::Body ? Vec2d{1, 0} : force->point);
    if (const auto* force = std::get_if<SinusoidalForce>(&law)) mark(force->body, force->point);
    if (const auto* spring = std::get_if<SpringForce>(&law))
      mark(spring->body_a, spring->anchor_a), mark(spring->body_b, spring->anchor_b);
    if (const auto* pull = std::get_if<AttractionForce>(&law)) mark(pull->centre_body, pull->centre);
  }
  return out;
}

double bound_of(const Case& one, const Engine& engine, double fastest, double hardest, double time) {
  if (engine.kind == Engine::Kind::Precise) return kPreciseShare * largest_size(one.scene);
  // Tolerates the displacement of three steps, plus the effect of a velocity that is one step late.
  return kShare * largest_size(one.scene) + 3 * one.dt * fastest + one.dt * hardest * time;
}

}  // namespace

namespace {

// Returns true if bodies move freely until they meet, under forces that are integrated here.
bool are_free(const Case& one) {
  if (!one.scene.joints.empty() || has_formulas(one.scene)) return false;
  return std::none_of(one.scene.bodies.begin(), one.scene.bodies.end(),
                      [](const Body& body) { return body.lock_x || body.lock_y || body.fixed_rotation; });
}

}  // namespace

bool integrable(const Case& one) { return !one.scene.forces.empty() && are_free(one); }

Verdict integrated_relation(const Case& one, const Engine& engine, const Motion& motion) {
  if (!motion.failure.empty() || !are_free(one)) return {};
  const Free free(one);
  std::vector<BodyState> coarse = free.start(), fine = coarse;
  const std::vector<double> extent = extents(one.scene);
  const auto distance = [&](const std::vector<BodyState>& a, const std::vector<BodyState>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (one.scene.bodies[i].type == BodyType::Dynamic)
        most = std::max(
            most, length(a[i].position - b[i].position) + extent[i] * std::abs(a[i].angle - b[i].angle));
    return most;
  };
  const std::vector<bool> beside = pulled_beside_centre(one.scene);
  double fastest = 0, hardest = 0;
  for (std::size_t k = 1; k < motion.samples.size(); ++k) {
    if (may_meet(one, fine)) return {};
    const double from = static_cast<double>(k - 1) * one.dt, to = static_cast<double>(k) * one.dt;
    const std::vector<BodyState> before = fine;
    free.advance(coarse, from, to, kSteps), free.advance(fine, from, to, 2 * kSteps);
    for (std::size_t i = 0; i < fine.size(); ++i) {
      if (beside[i] && engine.kind != Engine::Kind::Precise &&
          std::abs(fine[i].angle - before[i].angle) > kMostTurn)
        return {};
      fastest = std::max(fastest, length(fine[i].velocity) + extent[i] * std::abs(fine[i].angular_velocity));
      hardest = std::max(
          hardest, length(fine[i].velocity - before[i].velocity) / one.dt +
                       extent[i] * std::abs(fine[i].angular_velocity - before[i].angular_velocity) / one.dt);
    }
    const double bound = bound_of(one, engine, fastest, hardest, to);
    if (!(distance(coarse, fine) <= kKnown * bound)) return {};
    const double off = distance(motion.samples[k].states, fine);
    if (off <= bound) continue;
    // A first-order error halves with the step, so the change is the remaining uncertainty.
    if (engine.kind != Engine::Kind::Precise) {
      const std::vector<double> change = apart(one, motion, run(engine, one, {.refine = 2}));
      if (k >= change.size() || change[k] > kSteady * bound) return {};
    }
    const std::vector<double> calm = growth(one, engine, motion);
    const double most =
        engine.kind == Engine::Kind::Precise ? kGrown * 30e-6 * largest_size(one.scene) : 0.02 * bound;
    if (k >= calm.size() || calm[k] > most) return {};
    return Objection{.law = "integrated",
                     .judge = "integrated",
                     .what = fmt::format("differs by {:.3g} m from the motion by Newton's second law", off),
                     .right = "free bodies move as an integration of their forces to far more digits says",
                     .figure = off,
                     .bound = bound,
                     .unit = "m",
                     .time = to};
  }
  return {};
}

}  // namespace plumb::harness::hunt
