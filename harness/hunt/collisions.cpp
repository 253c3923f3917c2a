// Computes the motion of smooth discs that strike each other and static obstacles, event by event, from
// closed forms alone.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "harness/hunt/outline.h"
#include "harness/hunt/relations.h"
#include "harness/hunt/subject.h"

namespace plumb::harness::hunt {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// Largest growth of a perturbation for which the errors of a step stay below the bound.
constexpr double kPerturbation = 1e-7, kGrown = 8;
// Two impacts of one body count as simultaneous if the time between them is at most this fraction of a step;
// mechanics determines no answer for these.
constexpr double kAtOnce = 0.01;
// Tolerance of positions: kShare of the largest disc, the displacement of a step, and the displacement at
// kDrift of the largest speed since the first impact. Tolerance of velocities: kSpeed of the largest speed.
constexpr double kShare = 0.05, kDrift = 0.01, kSpeed = 0.04;
// Largest change of a result when its step is halved, as a fraction of the bound. A first-order error is
// halved with the step.
constexpr double kSteady = 0.25;
constexpr int kMostImpacts = 2000;

struct Disc {
  std::size_t body = 0;
  double radius = 0, inverse_mass = 0, restitution = 0;
  Vec2d at{}, velocity{};
};

struct Obstacle {
  Outline outline;
  double restitution = 0;
};

/// Returns the first time at which a point that moves from `at` comes within `reach` of another, if they
/// approach.
double time_to_point(Vec2d at, Vec2d velocity, Vec2d other, double reach) {
  const Vec2d d = at - other;
  const double closing = dot(d, velocity), speed = dot(velocity, velocity);
  if (!(closing < 0)) return kNever;
  const double inside = dot(d, d) - reach * reach;
  const double root = closing * closing - speed * inside;
  if (root < 0) return kNever;
  return std::max(0.0, inside / (-closing + std::sqrt(root)));
}

struct Impact {
  double time = kNever;
  std::size_t a = 0, b = 0;  // b: beyond the discs, an obstacle
  Vec2d normal{};            // from b to a
};

class Discs {
 public:
  /// Returns the frictionless discs of a scene on which nothing else acts; none if the scene contains
  /// anything else.
  static std::optional<Discs> of(const Case& one) {
    const Scene& scene = one.scene;
    if (length(scene.gravity) > 0 || !scene.joints.empty() || !scene.forces.empty() || !one.sensors.empty())
      return {};
    Discs out;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      if (body.type == BodyType::Kinematic) return {};
      for (const Shape& shape : body.shapes)
        if (!(shape.filter == Filter{})) return {};
      if (body.type == BodyType::Static) {
        for (const Shape& shape : body.shapes) {
          if (std::holds_alternative<Chain>(shape.geometry) ||
              std::holds_alternative<Segment>(shape.geometry))
            return {};
          out.obstacles_.push_back(
              {placed(outlines_of(shape).front(), initial_state(body)), shape.restitution});
        }
        continue;
      }
      if (body.shapes.size() != 1 || body.linear_damping != 0 || body.lock_x || body.lock_y) return {};
      const auto* circle = std::get_if<Circle>(&body.shapes.front().geometry);
      if (circle == nullptr || body.shapes.front().position != Vec2d{} || body.shapes.front().friction != 0 ||
          !(body.mass > 0))
        return {};
      out.discs_.push_back(
          {i, circle->radius, 1 / body.mass, body.shapes.front().restitution, body.position, body.velocity});
    }
    const Combine friction = scene.contact_rules.friction;
    if (friction == Combine::Maximum || friction == Combine::Average || out.discs_.empty() ||
        scene.contact_rules.restitution_threshold > 0)
      return {};
    for (const Action& action : one.actions)
      if (action.kind != ActionKind::Push && action.kind != ActionKind::Teleport) return {};
    out.scene_ = &scene, out.actions_ = &one.actions, out.dt_ = one.dt;
    return out;
  }

  std::vector<Disc>& discs() { return discs_; }
  std::size_t impacts() const { return impacts_; }
  std::vector<Impact> all() const;  ///< next impact of each pair, for the present motion

  /// Advances by step number `step`. Returns false if mechanics does not determine the motion: simultaneous
  /// impacts, overlapping discs, a heap that comes to rest.
  bool step(int step) {
    for (const Action& action : *actions_)
      if (action.step == step && !act(action)) return false;
    double left = dt_;
    for (;;) {
      Impact first, second;
      for (const Impact& each : all()) {
        if (each.time < first.time)
          second = first, first = each;
        else if (each.time < second.time)
          second = each;
      }
      const double until = std::min(left, first.time);
      if (second.time - first.time < kAtOnce * dt_ && first.time <= left + kAtOnce * dt_ &&
          share(first, second))
        return false;
      for (Disc& disc : discs_) disc.at += until * disc.velocity;
      left -= until;
      if (!(first.time <= until)) return is_apart();
      if (!strike(first) || ++impacts_ > kMostImpacts) return false;
    }
  }

 private:
  bool act(const Action& action) {
    for (Disc& disc : discs_) {
      if (scene_->bodies[disc.body].name != action.target) continue;
      if (action.kind == ActionKind::Push) disc.velocity = action.position;
      if (action.kind == ActionKind::Teleport) disc.at = action.position;
      return is_apart();
    }
    return false;
  }

  double gap(const Disc& a, const Disc& b) const { return length(a.at - b.at) - a.radius - b.radius; }
  bool is_apart() const {
    for (std::size_t i = 0; i < discs_.size(); ++i) {
      for (std::size_t j = i + 1; j < discs_.size(); ++j)
        if (gap(discs_[i], discs_[j]) < -1e-9 * (discs_[i].radius + discs_[j].radius)) return false;
      for (const Obstacle& obstacle : obstacles_)
        if (separation(placed({{{0, 0}}, discs_[i].radius}, {.position = discs_[i].at}), obstacle.outline) <
            -1e-9 * discs_[i].radius)
          return false;
    }
    return true;
  }
  bool share(const Impact& a, const Impact& b) const {
    const auto same = [&](std::size_t x, std::size_t y) { return x == y && x < discs_.size(); };
    return same(a.a, b.a) || same(a.a, b.b) || same(a.b, b.a) || same(a.b, b.b);
  }

  static Impact with_obstacle(const Disc& disc, const Outline& outline) {
    Impact out;
    const double reach = disc.radius + outline.radius;
    const std::vector<Vec2d>& core = outline.core;
    for (std::size_t i = 0; i < core.size(); ++i) {
      const double corner = time_to_point(disc.at, disc.velocity, core[i], reach);
      if (corner < out.time) {
        const Vec2d between = disc.at + corner * disc.velocity - core[i];
        out.time = corner, out.normal = (1 / length(between)) * between;
      }
      const Vec2d along = core[(i + 1) % core.size()] - core[i];
      const double size = length(along);
      if (core.size() < 2 || size == 0) continue;
      const Vec2d normal{along.y / size, -along.x / size};
      const double speed = dot(normal, disc.velocity), height = dot(normal, disc.at - core[i]) - reach;
      if (!(speed < 0) || height < -reach) continue;
      const double time = std::max(0.0, height / -speed);
      const double place = dot(along, disc.at + time * disc.velocity - core[i]) / (size * size);
      if (place >= 0 && place <= 1 && time < out.time) out.time = time, out.normal = normal;
    }
    return out;
  }

  double combined(double a, double b) const {
    switch (scene_->contact_rules.restitution) {
      case Combine::GeometricMean:
        return std::sqrt(a * b);
      case Combine::Product:
        return a * b;
      case Combine::Minimum:
        return std::min(a, b);
      case Combine::Average:
        return (a + b) / 2;
      case Combine::Maximum:
        break;
    }
    return std::max(a, b);
  }

  bool strike(const Impact& impact) {
    Disc& a = discs_[impact.a];
    Disc* b = impact.b < discs_.size() ? &discs_[impact.b] : nullptr;
    const double e = combined(
        a.restitution, b != nullptr ? b->restitution : obstacles_[impact.b - discs_.size()].restitution);
    const double closing = dot(impact.normal, a.velocity - (b != nullptr ? b->velocity : Vec2d{}));
    double fastest = 0;
    for (const Disc& disc : discs_) fastest = std::max(fastest, length(disc.velocity));
    // Gives up at discs that touch at low speed or without restitution: they stay together.
    if (closing > -1e-3 * fastest || e < 0.05) return false;
    const double impulse = -(1 + e) * closing / (a.inverse_mass + (b != nullptr ? b->inverse_mass : 0));
    a.velocity += impulse * a.inverse_mass * impact.normal;
    if (b != nullptr) b->velocity -= impulse * b->inverse_mass * impact.normal;
    return true;
  }

  const Scene* scene_ = nullptr;
  const std::vector<Action>* actions_ = nullptr;
  double dt_ = 0;
  std::vector<Disc> discs_;
  std::vector<Obstacle> obstacles_;
  std::size_t impacts_ = 0;
};

}  // namespace

namespace {

std::vector<Impact> Discs::all() const {
  std::vector<Impact> out;
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    const Disc& a = discs_[i];
    for (std::size_t j = i + 1; j < discs_.size(); ++j) {
      const Disc& b = discs_[j];
      const double time = time_to_point(a.at, a.velocity - b.velocity, b.at, a.radius + b.radius);
      if (time == kNever) continue;
      const Vec2d between = a.at - b.at + time * (a.velocity - b.velocity);
      out.push_back({time, i, j, (1 / length(between)) * between});
    }
    for (std::size_t k = 0; k < obstacles_.size(); ++k) {
      Impact each = with_obstacle(a, obstacles_[k].outline);
      if (each.time == kNever) continue;
      each.a = i, each.b = discs_.size() + k;
      out.push_back(each);
    }
  }
  return out;
}

// Returns true if an impact follows within a step and a half.
bool is_near_impact(const Discs& discs, double dt) {
  const std::vector<Impact> all = discs.all();
  return std::any_of(all.begin(), all.end(), [&](const Impact& each) { return each.time < 1.5 * dt; });
}

}  // namespace

namespace {

// Returns true if the motion at sample `k` is nearly the same with half the step.
bool is_steady(const Case& one, const Engine& engine, const Motion& motion, std::size_t k, double place,
               double speed) {
  const Motion finer = run(engine, one, {.refine = 2});
  if (finer.samples.size() <= k) return false;
  for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
    const BodyState &a = motion.samples[k].states[i], &b = finer.samples[k].states[i];
    if (length(a.position - b.position) > kSteady * place ||
        length(a.velocity - b.velocity) > kSteady * speed)
      return false;
  }
  return true;
}

}  // namespace

bool are_smooth_discs(const Case& one) { return Discs::of(one).has_value(); }

Verdict collisions_relation(const Case& one, const Engine& engine, const Motion& motion) {
  auto discs = Discs::of(one);
  if (!discs || !motion.failure.empty()) return {};
  // Runs from slightly perturbed starts: the result is uncertain by the distance between them.
  std::vector<Discs> others(2, *discs);
  double largest = 0;
  for (const Disc& disc : discs->discs()) largest = std::max(largest, disc.radius);
  for (std::size_t i = 0; i < discs->discs().size(); ++i) {
    const double by = kPerturbation * largest, sign = i % 2 == 0 ? 1 : -1;
    others[0].discs()[i].at += Vec2d{sign * by, -by};
    others[1].discs()[i].at += Vec2d{by, sign * by};
  }
  std::size_t since = 0;   // samples since the first impact
  std::size_t struck = 0;  // samples since the last impact
  int differs = 0;         // consecutive samples at which the runs differ in their number of impacts
  for (std::size_t k = 1; k < motion.samples.size(); ++k) {
    const int step = static_cast<int>(k) - 1;
    const std::size_t before = discs->impacts();
    if (!discs->step(step)) return {};
    if (discs->impacts() > 0) ++since;
    struck = discs->impacts() > before ? 0 : struck + 1;
    double fastest = 0, off = 0, wrong = 0, grown = 0;
    // A step that ends at an impact may end just before it in some runs.
    bool alike = true;
    for (Discs& other : others) {
      if (!other.step(step)) return {};
      alike = alike && other.impacts() == discs->impacts();
      for (std::size_t i = 0; i < other.discs().size(); ++i)
        grown = std::max(grown, length(other.discs()[i].at - discs->discs()[i].at));
    }
    differs = alike ? 0 : differs + 1;
    if (differs > 1) return {};
    if (!alike) continue;
    if (grown > kGrown * 1.5 * kPerturbation * largest) return {};
    std::size_t worst = 0;
    for (const Disc& disc : discs->discs()) {
      const BodyState& state = motion.samples[k].states[disc.body];
      fastest = std::max(fastest, length(disc.velocity));
      const double apart = length(state.position - disc.at);
      if (apart > off) off = apart, worst = disc.body;
      wrong = std::max(wrong, length(state.velocity - disc.velocity));
    }
    // Leaves out scenes with slow discs, because bodies may fall asleep below a twentieth of their size per
    // second.
    for (const Disc& disc : discs->discs())
      if (one.sleeping && disc.velocity != Vec2d{} && length(disc.velocity) < 0.3 * disc.radius) return {};
    const bool precise = engine.kind == Engine::Kind::Precise;
    const double bound =
        precise ? 1e-5 * largest
                : kShare * largest + one.dt * fastest * (1 + kDrift * static_cast<double>(since));
    const double most = precise ? 1e-5 * fastest : kSpeed * fastest;
    const bool is_off = off > bound;
    // A step may end just before an impact, or just after it.
    const bool is_wrong = wrong > most && struck > 1 && !is_near_impact(*discs, one.dt);
    if (!is_off && !is_wrong) continue;
    if (!precise && !is_steady(one, engine, motion, k, bound, most)) return {};
    if (is_off)
      return Objection{.law = "collisions",
                       .judge = "collisions",
                       .what = fmt::format("'{}' is {:.3g} m off after {} impacts",
                                           one.scene.bodies[worst].name, off, discs->impacts()),
                       .right = "smooth discs exchange momentum along the line of their centres",
                       .figure = off,
                       .bound = bound,
                       .unit = "m",
                       .time = static_cast<double>(k) * one.dt};
    return Objection{
        .law = "collisions",
        .judge = "collisions",
        .what = fmt::format("a velocity is {:.3g} m/s off after {} impacts", wrong, discs->impacts()),
        .right = "smooth discs exchange momentum along the line of their centres",
        .figure = wrong,
        .bound = most,
        .unit = "m/s",
        .time = static_cast<double>(k) * one.dt};
  }
  return {};
}

}  // namespace plumb::harness::hunt
