#include "harness/hunt/subject.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include "engine/math/trigonometry.h"
#include "harness/joint_gap.h"

namespace plumb::harness::hunt {
namespace {

/// Initial state of one end of a joint.
struct End {
  const Body* body = nullptr;  // nullopt: the fixed frame
  Vec2d anchor{};              // m, in the body's frame

  double mass() const { return body != nullptr && body->type == BodyType::Dynamic ? body->mass : INFINITY; }
  double inertia() const {  // about the anchor
    if (body == nullptr || body->type != BodyType::Dynamic || body->fixed_rotation) return INFINITY;
    return inertia_of(*body) + body->mass * dot(anchor, anchor);
  }
  double angle() const { return body == nullptr ? 0 : body->angle; }
  Vec2d point() const {
    return body == nullptr ? anchor : body->position + rotation_of(body->angle) * anchor;
  }
};

struct Held {
  End a, b;
  double distance, angle;  // separation of the anchors, m; angle of b relative to a, rad
};

template <class Kind>
Held held(const Scene& scene, const Kind& joint) {
  Held out{};
  if (const auto at = find_body(scene, joint.body_a)) out.a.body = &scene.bodies[*at];
  if (const auto at = find_body(scene, joint.body_b)) out.b.body = &scene.bodies[*at];
  if constexpr (requires { joint.anchor_a; }) out.a.anchor = joint.anchor_a;
  if constexpr (requires { joint.anchor_b; }) out.b.anchor = joint.anchor_b;
  out.distance = length(out.b.point() - out.a.point());
  out.angle = out.b.angle() - out.a.angle();
  return out;
}

// Returns an upper bound of a spring's energy: its effective mass, or inertia, is at most that of the lighter
// end. Returns 0 if both are infinite.
double spring_energy(const Spring& spring, double mass_a, double mass_b, double away) {
  const double mass = std::min(mass_a, mass_b), w = 2 * M_PI * spring.hertz;
  return std::isfinite(mass) ? 0.5 * mass * w * w * away * away : 0;
}

double along(const Scene& scene, const Held& h, Vec2d axis) {
  (void)scene;
  const Vec2d turned = rotation_of(h.a.angle()) * axis;
  return dot(turned, h.b.point() - h.a.point()) / length(axis);
}

struct Stored {
  const Scene& scene;
  double time;

  double motor(const std::optional<Motor>& m) const {
    return m ? m->max_force * std::abs(m->speed) * time : 0;
  }
  double operator()(const RevoluteJoint& j) const {
    const Held h = held(scene, j);
    double out = motor(j.motor);
    if (j.spring)
      out += spring_energy(*j.spring, h.a.inertia(), h.b.inertia(),
                           h.angle - j.reference_angle - j.target_angle);
    return out;
  }
  double operator()(const DistanceJoint& j) const {
    const Held h = held(scene, j);
    double out = motor(j.motor);
    if (j.spring) out += spring_energy(*j.spring, h.a.mass(), h.b.mass(), h.distance - j.length);
    return out;
  }
  double operator()(const PrismaticJoint& j) const {
    const Held h = held(scene, j);
    double out = motor(j.motor);
    if (j.spring)
      out += spring_energy(*j.spring, h.a.mass(), h.b.mass(), along(scene, h, j.axis) - j.target_translation);
    return out;
  }
  double operator()(const WheelJoint& j) const {
    const Held h = held(scene, j);
    double out = motor(j.motor);
    if (j.spring) out += spring_energy(*j.spring, h.a.mass(), h.b.mass(), along(scene, h, j.axis));
    return out;
  }
  double operator()(const WeldJoint& j) const {
    const Held h = held(scene, j);
    double out = 0;
    if (j.linear_spring) out += spring_energy(*j.linear_spring, h.a.mass(), h.b.mass(), h.distance);
    if (j.angular_spring)
      out += spring_energy(*j.angular_spring, h.a.inertia(), h.b.inertia(), h.angle - j.reference_angle);
    return out;
  }
  double operator()(const MotorJoint& j) const {
    const Held h = held(scene, j);
    const Vec2d target = h.a.point() + rotation_of(h.a.angle()) * j.target_position;
    const Vec2d at = h.b.body == nullptr ? Vec2d{} : h.b.body->position;
    return j.max_force * length(at - target) + j.max_torque * std::abs(h.angle - j.target_angle);
  }
  double operator()(const MouseJoint& j) const {
    return j.max_force * length(held(scene, j).b.point() - j.target);
  }
  double operator()(const auto&) const { return 0; }
};

bool outside(const std::optional<Range>& range, double value, double slack) {
  return range && (value < range->lower - slack || value > range->upper + slack);
}

struct Closed {
  const Scene& scene;
  double slack;  // m

  bool operator()(const RevoluteJoint& j) const {
    return !outside(j.limits, held(scene, j).angle - j.reference_angle, 0.01);
  }
  bool operator()(const PrismaticJoint& j) const {
    const Held h = held(scene, j);
    return !outside(j.limits, along(scene, h, j.axis), slack) && std::abs(h.angle - j.reference_angle) < 0.01;
  }
  bool operator()(const WheelJoint& j) const {
    return !outside(j.limits, along(scene, held(scene, j), j.axis), slack);
  }
  bool operator()(const WeldJoint& j) const {
    return j.angular_spring || std::abs(held(scene, j).angle - j.reference_angle) < 0.01;
  }
  bool operator()(const GearJoint& j) const {
    const Held h = held(scene, j);
    return std::abs(h.b.angle() - j.ratio * h.a.angle() - j.phase) < 0.01;
  }
  bool operator()(const auto&) const { return true; }
};

}  // namespace

std::vector<double> extents(const Scene& scene) {
  std::vector<double> out(scene.bodies.size(), 0);
  for (std::size_t i = 0; i < out.size(); ++i)
    for (const Shape& shape : scene.bodies[i].shapes)
      for (const Outline& outline : outlines_of(shape)) out[i] = std::max(out[i], reach_of(outline));
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          const auto grow = [&](const std::string& name, Vec2d anchor) {
            if (const auto at = find_body(scene, name); at && scene.bodies[*at].shapes.empty())
              out[*at] = std::max(out[*at], length(anchor));
          };
          if constexpr (requires { j.anchor_a; }) grow(j.body_a, j.anchor_a);
          if constexpr (requires { j.anchor_b; }) grow(j.body_b, j.anchor_b);
        },
        joint);
  }
  return out;
}

double typical_size(const Scene& scene) {
  const std::vector<double> all = extents(scene);
  double least = INFINITY;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (scene.bodies[i].type == BodyType::Dynamic && all[i] > 0) least = std::min(least, all[i]);
  return std::isfinite(least) ? least : 1;
}

double largest_size(const Scene& scene) {
  const std::vector<double> all = extents(scene);
  double most = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (scene.bodies[i].type == BodyType::Dynamic) most = std::max(most, all[i]);
  return most > 0 ? most : 1;
}

bool joined(const Scene& scene, std::size_t a, std::size_t b) {
  return std::any_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) {
    return std::visit(
        [&](const auto& j) {
          const std::string &x = scene.bodies[a].name, &y = scene.bodies[b].name;
          return !j.collide && ((j.body_a == x && j.body_b == y) || (j.body_a == y && j.body_b == x));
        },
        joint);
  });
}

std::vector<std::size_t> joint_groups(const Scene& scene) {
  std::vector<std::size_t> first(scene.bodies.size());
  std::iota(first.begin(), first.end(), std::size_t{0});
  std::map<std::string_view, std::size_t> index;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) index[scene.bodies[i].name] = i;
  for (const Joint& joint : scene.joints)
    std::visit(
        [&](const auto& j) {
          const auto a = index.find(j.body_a), b = index.find(j.body_b);
          if (a == index.end() || b == index.end() || scene.bodies[a->second].type != BodyType::Dynamic ||
              scene.bodies[b->second].type != BodyType::Dynamic)
            return;
          const std::size_t keep = std::min(first[a->second], first[b->second]);
          const std::size_t gone = std::max(first[a->second], first[b->second]);
          std::replace(first.begin(), first.end(), gone, keep);
        },
        joint);
  return first;
}

bool is_moving_kinematic(const Body& body) {
  return body.type == BodyType::Kinematic && (length(body.velocity) > 0 || body.angular_velocity != 0);
}

bool driven(const Case& one) {
  for (const Action& action : one.actions)
    if (action.kind != ActionKind::Sleep) return true;
  for (const Body& body : one.scene.bodies) {
    if (is_moving_kinematic(body)) return true;
    for (const Shape& shape : body.shapes)
      if (shape.surface_speed != 0) return true;
  }
  for (const ForceLaw& law : one.scene.forces)
    if (std::holds_alternative<PointForce>(law) || std::holds_alternative<Torque>(law) ||
        std::holds_alternative<SinusoidalForce>(law) || std::holds_alternative<FormulaForce>(law) ||
        std::holds_alternative<FormulaSpring>(law))
      return true;
  return false;
}

double stored(const Scene& scene, double time) {
  double sum = 0;
  for (const Joint& joint : scene.joints) sum += std::visit(Stored{scene, time}, joint);
  return sum;
}

OverlapTest::OverlapTest(const Scene& scene) : scene_(scene) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    for (const Shape& shape : scene.bodies[i].shapes)
      for (Outline& outline : outlines_of(shape)) {
        const double extent = reach_of(outline);
        parts_.push_back({i, &shape, std::move(outline), extent});
      }
  now_.resize(parts_.size());
}

bool OverlapTest::may_collide(const Part& a, const Part& b) const {
  const auto dynamic = [&](const Part& part) { return scene_.bodies[part.body].type == BodyType::Dynamic; };
  return a.body != b.body && (dynamic(a) || dynamic(b)) && may_touch(a.shape->filter, b.shape->filter) &&
         !joined(scene_, a.body, b.body);
}

bool OverlapTest::exceeds(std::span<const BodyState> states, double fraction) {
  const auto boxes_meet = [](const Outline& a, const Outline& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
  };
  for (std::size_t i = 0; i < parts_.size(); ++i) now_[i] = placed(parts_[i].outline, states[parts_[i].body]);
  for (std::size_t i = 0; i < parts_.size(); ++i)
    for (std::size_t k = i + 1; k < parts_.size(); ++k) {
      const Part &a = parts_[i], &b = parts_[k];
      if (!boxes_meet(now_[i], now_[k]) || !may_collide(a, b)) continue;
      if (separation(now_[i], now_[k]) < -fraction * std::min(a.extent, b.extent)) return true;
    }
  return false;
}

bool starts_apart(const Scene& scene) {
  std::vector<BodyState> states;
  for (const Body& body : scene.bodies) states.push_back(initial_state(body));
  return !OverlapTest(scene).exceeds(states, 0.01);
}

bool starts_closed(const Scene& scene) {
  const double slack = 0.01 * typical_size(scene);
  const JointGaps gaps(scene);
  std::vector<BodyState> states;
  for (const Body& body : scene.bodies) states.push_back(initial_state(body));
  for (std::size_t i = 0; i < scene.joints.size(); ++i)
    if (gaps.gap(i, states) > slack || !std::visit(Closed{scene, slack}, scene.joints[i])) return false;
  return true;
}

}  // namespace plumb::harness::hunt
