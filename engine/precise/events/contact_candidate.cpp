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

Aabb<double> tight_aabb(const FeatureShape& shape, const Pose<double>& pose, double margin) {
  Aabb<double> box{{1e300, 1e300}, {-1e300, -1e300}};
  for (const Corner<double>& corner : shape.corners) {
    const Vec2d p = pose.position + pose.rotation * corner.point;
    box = merged(box, {p, p});
  }
  return box.grown(shape.radius + margin);
}

}  // namespace

double speed_along(const Row<double>& row, const Twist<double>& a, const Twist<double>& b) {
  return dot(row.linear_a, a.velocity) + row.angular_a * a.angular_velocity + dot(row.linear_b, b.velocity) +
         row.angular_b * b.angular_velocity;
}

ContactFinder::ContactFinder(const Scene& scene, const ScenePartition& partition)
    : partition_(partition), shapes_(partition.shapes), rules_(scene.contact_rules) {
  for (const Body& body : scene.bodies) dynamic_.push_back(body.type == BodyType::Dynamic);
  const Scales scales = scales_of(scene, partition);
  speed_ = scales.speed;
  length_ = scales.length;
}

bool ContactFinder::may_collide(std::size_t a, std::size_t b) const {
  const FeatureShape &p = shapes_[a], &q = shapes_[b];
  if (p.body == q.body || !(dynamic_[p.body] || dynamic_[q.body]) || !may_touch(p.filter, q.filter))
    return false;
  return !std::binary_search(partition_.non_colliding.begin(), partition_.non_colliding.end(),
                             std::pair<std::size_t, std::size_t>(std::minmax(p.body, q.body)));
}

double ContactFinder::friction(const ShapePair& pair) const {
  return combine(rules_.friction, shapes_[pair.a].friction, shapes_[pair.b].friction);
}

double ContactFinder::restitution(const ShapePair& pair) const {
  return combine(rules_.restitution, shapes_[pair.a].restitution, shapes_[pair.b].restitution);
}

void ContactFinder::set_coefficients(ContactCandidate& candidate) const {
  candidate.friction = friction(candidate.pair);
  candidate.sliding_friction = rules_.friction_while_sliding * candidate.friction;
  candidate.restitution = restitution(candidate.pair);
}

double ContactFinder::restitution_at(const ContactCandidate& candidate, int point) const {
  const double speed = -candidate.gap_rate[point];
  if (speed < rules_.restitution_threshold) return 0;
  return falling_restitution(candidate.restitution, speed, rules_.yield_speed);
}

double ContactFinder::gap_rounding(std::span<const BodyState> states) const {
  double extent = 0;
  for (const FeatureShape& o : shapes_) {
    extent = std::max(extent, length(states[o.body].position) + o.extent + o.radius);
  }
  return 32 * kEpsilon * extent;
}

std::vector<ContactCandidate> ContactFinder::find_candidates(std::span<const BodyState> states,
                                                             double tolerance,
                                                             std::vector<ShapePair>& passing) const {
  passing.clear();
  std::vector<Pose<double>> poses;
  std::vector<Aabb<double>> boxes;
  for (const FeatureShape& o : shapes_) {
    poses.push_back(pose_of(states[o.body]));
    boxes.push_back(tight_aabb(o, poses.back(), tolerance));
  }
  std::vector<ContactCandidate> found;
  for (const ShapePair& pair :
       sweep_and_prune(boxes, [&](std::size_t a, std::size_t b) { return may_collide(a, b); })) {
    const FeatureShape &a = shapes_[pair.a], &b = shapes_[pair.b];
    if (separation(a, poses[pair.a], b, poses[pair.b]).distance > tolerance) continue;
    ContactCandidate candidate;
    candidate.pair = pair;
    set_coefficients(candidate);
    for (const Feature& f : touching_features(a, poses[pair.a], twist_of(states[a.body]), b, poses[pair.b],
                                              twist_of(states[b.body]), tolerance)) {
      const Gap gap = gap_of(f, a, poses[pair.a], b, poses[pair.b]);
      if (allows_contact(f, gap, a, poses[pair.a], b, poses[pair.b], tolerance))
        candidate.features[candidate.count++] = f;
    }
    if (candidate.count == 0) {
      passing.push_back(pair);
      continue;
    }
    update_rates(states, candidate);
    found.push_back(candidate);
  }
  return found;
}

void ContactFinder::update_rates(std::span<const BodyState> states, ContactCandidate& candidate) const {
  if (candidate.limit) return update_limit_rate(states, candidate);
  const FeatureShape &a = shapes_[candidate.pair.a], &b = shapes_[candidate.pair.b];
  const BodyState &state_a = states[a.body], &state_b = states[b.body];
  const Twist<double> twist_a = twist_of(state_a), twist_b = twist_of(state_b);
  for (int i = 0; i < candidate.count; ++i) {
    candidate.rows[i] =
        rows_of(candidate.features[i], a, pose_of(state_a), twist_a, b, pose_of(state_b), twist_b);
    candidate.gap_rate[i] = speed_along(candidate.rows[i].normal, twist_a, twist_b);
  }
  candidate.slip_speed = speed_along(candidate.rows[0].tangent, twist_a, twist_b);
  const double around = length(twist_a.velocity) + length(twist_b.velocity) +
                        std::abs(twist_a.angular_velocity) * (a.extent + a.radius) +
                        std::abs(twist_b.angular_velocity) * (b.extent + b.radius);
  candidate.rate_tolerance = std::max(1e-12 * speed_ + 256 * kEpsilon * around, candidate.grazing_speed);
}

/// Updates the rates of a limit. Its row stays the same while bodies do not move.
void ContactFinder::update_limit_rate(std::span<const BodyState> states, ContactCandidate& candidate) const {
  const Row<double>& row = candidate.rows[0].normal;
  double around = 0;
  candidate.gap_rate[0] = 0;
  const auto add = [&](int body, Vec2d linear, double angular) {
    if (body == kFixedFrame) return;
    const BodyState& s = states[static_cast<std::size_t>(body)];
    candidate.gap_rate[0] += dot(linear, s.velocity) + angular * s.angular_velocity;
    around += length(linear) * length(s.velocity) + std::abs(angular * s.angular_velocity);
  };
  add(row.a, row.linear_a, row.angular_a);
  add(row.b, row.linear_b, row.angular_b);
  candidate.rate_tolerance = 1e-12 * speed_ + 256 * kEpsilon * around;
}

std::vector<ShapePair> overlapping_pairs(const ContactFinder& finder, const StepMotionBounds& bounds) {
  std::vector<Aabb<double>> boxes;
  for (const FeatureShape& o : finder.shapes()) boxes.push_back(bounds.swept(o));
  return sweep_and_prune(boxes, [&](std::size_t a, std::size_t b) { return finder.may_collide(a, b); });
}

}  // namespace plumb::precise
