#include "engine/precise/events/contact_candidate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/trigonometry.h"
#include "engine/precise/impact_laws/impact_law.h"

namespace plumb::precise {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Pose<double> pose_of(const BodyState& s) { return {s.position, rotation_of(s.angle)}; }
Twist<double> twist_of(const BodyState& s) { return {s.velocity, s.angular_velocity}; }

Aabb<double> tight_aabb(const FeatureShape& outline, const Pose<double>& pose, double margin) {
  Aabb<double> box{{1e300, 1e300}, {-1e300, -1e300}};
  for (const Corner<double>& corner : outline.corners) {
    const Vec2d p = pose.position + pose.rotation * corner.point;
    box = merged(box, {p, p});
  }
  return box.grown(outline.radius + margin);
}

}  // namespace

double speed_along(const Row<double>& row, const Twist<double>& a, const Twist<double>& b) {
  return dot(row.linear_a, a.velocity) + row.angular_a * a.angular_velocity + dot(row.linear_b, b.velocity) +
         row.angular_b * b.angular_velocity;
}

TouchFinder::TouchFinder(const Scene& scene, const Parts& parts)
    : parts_(parts), outlines_(parts.outlines), rules_(scene.contact_rules) {
  for (const Body& body : scene.bodies) dynamic_.push_back(body.type == BodyType::Dynamic);
  const Scales scales = scales_of(scene, parts);
  speed_ = scales.speed;
  length_ = scales.length;
}

bool TouchFinder::may_meet(std::size_t a, std::size_t b) const {
  const FeatureShape &p = outlines_[a], &q = outlines_[b];
  if (p.body == q.body || !(dynamic_[p.body] || dynamic_[q.body]) || !may_touch(p.filter, q.filter))
    return false;
  return !std::binary_search(parts_.apart.begin(), parts_.apart.end(),
                             std::pair<std::size_t, std::size_t>(std::minmax(p.body, q.body)));
}

double TouchFinder::friction(const OutlinePair& pair) const {
  return combine(rules_.friction, outlines_[pair.a].friction, outlines_[pair.b].friction);
}

double TouchFinder::restitution(const OutlinePair& pair) const {
  return combine(rules_.restitution, outlines_[pair.a].restitution, outlines_[pair.b].restitution);
}

void TouchFinder::set_coefficients(ContactCandidate& touch) const {
  touch.friction = friction(touch.pair);
  touch.sliding_friction = rules_.friction_while_sliding * touch.friction;
  touch.restitution = restitution(touch.pair);
}

double TouchFinder::restitution_at(const ContactCandidate& touch, int point) const {
  const double speed = -touch.closing[point];
  if (speed < rules_.restitution_threshold) return 0;
  return falling_restitution(touch.restitution, speed, rules_.yield_speed);
}

double TouchFinder::near(std::span<const BodyState> states) const {
  double extent = 0;
  for (const FeatureShape& o : outlines_) {
    extent = std::max(extent, length(states[o.body].position) + o.reach + o.radius);
  }
  return 32 * kEpsilon * extent;
}

std::vector<ContactCandidate> TouchFinder::touches(std::span<const BodyState> states, double near,
                                                   std::vector<OutlinePair>& passing) const {
  passing.clear();
  std::vector<Pose<double>> poses;
  std::vector<Aabb<double>> boxes;
  for (const FeatureShape& o : outlines_) {
    poses.push_back(pose_of(states[o.body]));
    boxes.push_back(tight_aabb(o, poses.back(), near));
  }
  std::vector<ContactCandidate> found;
  for (const OutlinePair& pair :
       pairs_of_boxes(boxes, [&](std::size_t a, std::size_t b) { return may_meet(a, b); })) {
    const FeatureShape &a = outlines_[pair.a], &b = outlines_[pair.b];
    if (separation(a, poses[pair.a], b, poses[pair.b]).distance > near) continue;
    ContactCandidate touch;
    touch.pair = pair;
    set_coefficients(touch);
    for (const Feature& f : touching_features(a, poses[pair.a], twist_of(states[a.body]), b, poses[pair.b],
                                              twist_of(states[b.body]), near)) {
      const Gap gap = gap_of(f, a, poses[pair.a], b, poses[pair.b]);
      if (admits(f, gap, a, poses[pair.a], b, poses[pair.b], near)) touch.features[touch.count++] = f;
    }
    if (touch.count == 0) {
      passing.push_back(pair);
      continue;
    }
    measure(states, touch);
    found.push_back(touch);
  }
  return found;
}

void TouchFinder::measure(std::span<const BodyState> states, ContactCandidate& touch) const {
  if (touch.stop) return measure_stop(states, touch);
  const FeatureShape &a = outlines_[touch.pair.a], &b = outlines_[touch.pair.b];
  const BodyState &state_a = states[a.body], &state_b = states[b.body];
  const Twist<double> twist_a = twist_of(state_a), twist_b = twist_of(state_b);
  for (int i = 0; i < touch.count; ++i) {
    touch.rows[i] = rows_of(touch.features[i], a, pose_of(state_a), twist_a, b, pose_of(state_b), twist_b);
    touch.closing[i] = speed_along(touch.rows[i].normal, twist_a, twist_b);
  }
  touch.slip = speed_along(touch.rows[0].tangent, twist_a, twist_b);
  const double around = length(twist_a.velocity) + length(twist_b.velocity) +
                        std::abs(twist_a.angular_velocity) * (a.reach + a.radius) +
                        std::abs(twist_b.angular_velocity) * (b.reach + b.radius);
  touch.quiet = std::max(1e-12 * speed_ + 256 * kEpsilon * around, touch.graze);
}

/// Updates the rates of a limit. Its row stays the same while bodies do not move.
void TouchFinder::measure_stop(std::span<const BodyState> states, ContactCandidate& touch) const {
  const Row<double>& row = touch.rows[0].normal;
  double around = 0;
  touch.closing[0] = 0;
  const auto add = [&](int body, Vec2d linear, double angular) {
    if (body == kFixedFrame) return;
    const BodyState& s = states[static_cast<std::size_t>(body)];
    touch.closing[0] += dot(linear, s.velocity) + angular * s.angular_velocity;
    around += length(linear) * length(s.velocity) + std::abs(angular * s.angular_velocity);
  };
  add(row.a, row.linear_a, row.angular_a);
  add(row.b, row.linear_b, row.angular_b);
  touch.quiet = 1e-12 * speed_ + 256 * kEpsilon * around;
}

std::vector<OutlinePair> near_pairs(const TouchFinder& finder, const StepMotionBounds& paths) {
  std::vector<Aabb<double>> boxes;
  for (const FeatureShape& o : finder.outlines()) boxes.push_back(paths.swept(o));
  return pairs_of_boxes(boxes, [&](std::size_t a, std::size_t b) { return finder.may_meet(a, b); });
}

}  // namespace plumb::precise
