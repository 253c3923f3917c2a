#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "engine/math/trigonometry.h"
#include "harness/hunt/objection.h"
#include "harness/hunt/subject.h"
#include "harness/joint_gap.h"

namespace plumb::harness::hunt {
namespace {

// Samples after which an open joint is a violation: impacts open joints for a moment.
constexpr int kLasting = 6;
constexpr double kGapShare = 0.05;   // largest gap, as a fraction of the bodies' arms and extents
constexpr double kAngleBound = 0.2;  // rad, largest angular gap

const std::string& name_of(const Joint& joint) {
  return std::visit([](const auto& j) -> const std::string& { return j.name; }, joint);
}

bool may_break(const Joint& joint) {
  return std::visit([](const auto& j) { return j.break_force > 0 || j.break_torque > 0; }, joint);
}

// Returns true if a rope's end reaches its pulley. The rope then has no direction, so the motion is
// undetermined.
bool at_its_pulley(const Case& one, const Joint& joint, const std::vector<BodyState>& states) {
  const auto* rope = std::get_if<PulleyJoint>(&joint);
  if (rope == nullptr) return false;
  const auto short_of = [&](const std::string& name, Vec2d anchor, Vec2d ground) {
    const auto at = find_body(one.scene, name);
    if (!at) return false;
    const BodyState& s = states[*at];
    const Vec2d arm = rotation_of(s.angle) * anchor;
    return length(s.position + arm - ground) <=
           2 * one.dt * length(s.velocity + cross(s.angular_velocity, arm));
  };
  return short_of(rope->body_a, rope->anchor_a, rope->ground_a) ||
         short_of(rope->body_b, rope->anchor_b, rope->ground_b);
}

bool judged(const Case& one) {
  return one.actions.empty() && !one.scene.joints.empty() && starts_closed(one.scene);
}

/// Mechanisms that joints tie to something immovable, and that a moving kinematic body has met. The joints
/// cannot hold where that body pushes the mechanism away from what it is tied to.
class PressedMechanisms {
 public:
  explicit PressedMechanisms(const Scene& scene) : scene_(scene), groups_(joint_groups(scene)) {
    tied_.assign(scene.bodies.size(), false), pressed_ = tied_;
    for (const Joint& joint : scene.joints)
      std::visit(
          [&](const auto& j) {
            const auto a = dynamic(j.body_a), b = dynamic(j.body_b);
            if (a.has_value() != b.has_value()) tied_[groups_[a ? *a : *b]] = true;
          },
          joint);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      if (!is_moving_kinematic(body) && !(dynamic(body.name) && tied_[groups_[i]])) continue;
      for (const Shape& shape : body.shapes)
        for (const Outline& outline : outlines_of(shape)) parts_.push_back({i, &shape, outline});
    }
  }

  void look(const std::vector<BodyState>& states) {
    for (const Part& pusher : parts_) {
      if (!is_moving_kinematic(scene_.bodies[pusher.body])) continue;
      const Outline there = placed(pusher.outline, states[pusher.body]);
      for (const Part& part : parts_) {
        if (is_moving_kinematic(scene_.bodies[part.body]) || pressed_[groups_[part.body]] ||
            !may_touch(pusher.shape->filter, part.shape->filter) || joined(scene_, pusher.body, part.body))
          continue;
        if (separation(placed(part.outline, states[part.body]), there) < 0)
          pressed_[groups_[part.body]] = true;
      }
    }
  }

  bool contain(const Joint& joint) const {
    return std::visit(
        [&](const auto& j) {
          const auto a = dynamic(j.body_a), b = dynamic(j.body_b);
          return (a && pressed_[groups_[*a]]) || (b && pressed_[groups_[*b]]);
        },
        joint);
  }

 private:
  struct Part {
    std::size_t body;
    const Shape* shape;
    Outline outline;
  };
  std::optional<std::size_t> dynamic(const std::string& name) const {
    const auto at = find_body(scene_, name);
    return at && scene_.bodies[*at].type == BodyType::Dynamic ? at : std::nullopt;
  }

  const Scene& scene_;
  std::vector<std::size_t> groups_;
  std::vector<bool> tied_{}, pressed_{};  // by group
  std::vector<Part> parts_{};
};

/// An angle of b relative to a that a joint keeps within a range.
struct Hold {
  double angle = 0;  // rad, relative to the reference
  double lower = 0, upper = 0;
};

std::optional<Hold> hold_of(const Scene& scene, const Joint& joint, const std::vector<BodyState>& states) {
  return std::visit(
      [&](const auto& j) -> std::optional<Hold> {
        using Kind = std::decay_t<decltype(j)>;
        const auto angle = [&](const std::string& name) {
          const auto at = find_body(scene, name);
          return at ? states[*at].angle : 0;
        };
        if constexpr (std::is_same_v<Kind, RevoluteJoint>) {
          if (j.limits)
            return Hold{angle(j.body_b) - angle(j.body_a) - j.reference_angle, j.limits->lower,
                        j.limits->upper};
        } else if constexpr (std::is_same_v<Kind, WeldJoint>) {
          if (!j.angular_spring) return Hold{angle(j.body_b) - angle(j.body_a) - j.reference_angle, 0, 0};
        } else if constexpr (std::is_same_v<Kind, PrismaticJoint>) {
          return Hold{angle(j.body_b) - angle(j.body_a) - j.reference_angle, 0, 0};
        } else if constexpr (std::is_same_v<Kind, GearJoint>) {
          return Hold{angle(j.body_b) - j.ratio * angle(j.body_a) - j.phase, 0, 0};
        }
        return {};
      },
      joint);
}

}  // namespace

Verdict joint_gap_law(const Case& one, const Engine& engine, const Motion& motion) {
  if (!judged(one)) return {};
  const JointGaps gaps(one.scene);
  const std::vector<double> extent = extents(one.scene);
  std::vector<int> open(one.scene.joints.size(), 0);
  std::vector<bool> over(one.scene.joints.size(), false);
  PressedMechanisms pressed(one.scene);
  const double step = engine.kind == Engine::Kind::Precise ? 0 : one.dt / one.substeps;
  for (std::size_t k = 1; k < motion.samples.size(); ++k) {
    const std::vector<BodyState>& states = motion.samples[k].states;
    pressed.look(states);
    for (std::size_t i = 0; i < open.size(); ++i) {
      over[i] =
          over[i] || pressed.contain(one.scene.joints[i]) || at_its_pulley(one, one.scene.joints[i], states);
      if (may_break(one.scene.joints[i]) || over[i]) continue;
      double size = 0, speed = 0;
      for (const auto& end : {gaps.end_a(i), gaps.end_b(i)}) {
        if (!end.body || one.scene.bodies[*end.body].type != BodyType::Dynamic) continue;
        const BodyState& s = states[*end.body];
        const double arm = length(end.anchor);
        size += std::max(arm, extent[*end.body]);
        // Displacement error of a tangent step along a curved path, per substep.
        speed += std::abs(s.angular_velocity) * arm * std::min(1.0, std::abs(s.angular_velocity) * step);
      }
      if (!(size > 0)) size = largest_size(one.scene);  // the bodies are points without a size
      const double gap = gaps.gap(i, states);
      const double bound =
          engine.kind == Engine::Kind::Precise ? 1e-5 * size : kGapShare * size + 2 * speed * step;
      open[i] = gap > bound ? open[i] + 1 : 0;
      if (open[i] < kLasting) continue;
      return Objection{
          .judge = "joint_gap",
          .what = fmt::format("joint '{}' is open by {:.3g} m", name_of(one.scene.joints[i]), gap),
          .right = "joints stay closed",
          .figure = gap,
          .bound = bound,
          .unit = "m",
          .time = static_cast<double>(k) * one.dt,
          .subject = name_of(one.scene.joints[i])};
    }
  }
  return {};
}

Verdict joint_angle_law(const Case& one, const Engine&, const Motion& motion) {
  if (!judged(one)) return {};
  std::vector<int> off(one.scene.joints.size(), 0);
  PressedMechanisms pressed(one.scene);
  for (std::size_t k = 1; k < motion.samples.size(); ++k) {
    pressed.look(motion.samples[k].states);
    for (std::size_t i = 0; i < off.size(); ++i) {
      if (may_break(one.scene.joints[i]) || pressed.contain(one.scene.joints[i])) continue;
      const auto hold = hold_of(one.scene, one.scene.joints[i], motion.samples[k].states);
      if (!hold) continue;
      const double beyond = std::max(hold->angle - hold->upper, hold->lower - hold->angle);
      off[i] = beyond > kAngleBound ? off[i] + 1 : 0;
      if (off[i] < kLasting) continue;
      return Objection{.judge = "joint_angle",
                       .what = fmt::format("joint '{}' violates its angle or limit by {:.3g} rad",
                                           name_of(one.scene.joints[i]), beyond),
                       .right = "joints keep their angles and limits",
                       .figure = beyond,
                       .bound = kAngleBound,
                       .unit = "rad",
                       .time = static_cast<double>(k) * one.dt,
                       .subject = name_of(one.scene.joints[i])};
    }
  }
  return {};
}

}  // namespace plumb::harness::hunt
