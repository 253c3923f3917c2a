#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/precise/dynamics/feature_shape.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/dynamics/scene_partition.h"
#include "engine/precise/event_search/conservative_advancement.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// Returns a row's rate of change for the motions of its two bodies.
double speed_along(const Row<double>& row, const Twist<double>& a, const Twist<double>& b);

/// Two shapes that touch at an instant, in one or two points, with their relative motion there; or a limit of
/// a joint that is reached, with one point.
struct ContactCandidate {
  ShapePair pair{};
  std::optional<std::size_t> limit{};  ///< index among `limits_and_motors()`; then without shapes
  double friction = 0;                 ///< static, and of impacts
  double sliding_friction = 0;         ///< kinetic, of a persistent contact that slips
  double restitution = 0;
  int count = 0;
  Feature features[2] = {};
  ContactRows rows[2] = {};
  double gap_rate[2] = {};    ///< m/s, the gap's rate: negative when it closes
  double slip_speed = 0;      ///< m/s, of b against a along the tangent
  double rate_tolerance = 0;  ///< m/s, rounding error of these rates, or `grazing_speed` if larger
  double grazing_speed = 0;   ///< m/s: slower approaches end before the gap changes by more than rounding
};

/// Returns true if the gap of a point closes faster than rounding.
inline bool closes_at(const ContactCandidate& candidate, int point) {
  return candidate.gap_rate[point] < -candidate.rate_tolerance;
}
/// Returns true if any point does.
inline bool closes(const ContactCandidate& candidate) {
  return std::any_of(candidate.gap_rate, candidate.gap_rate + candidate.count,
                     [&](double rate) { return rate < -candidate.rate_tolerance; });
}

/// Holds the shapes of a scene that may touch, and finds those that touch at an instant.
class ContactFinder {
 public:
  ContactFinder(const Scene& scene, const ScenePartition& partition);

  std::span<const FeatureShape> shapes() const { return shapes_; }
  bool may_collide(std::size_t a, std::size_t b) const;
  double friction(const ShapePair& pair) const;
  double restitution(const ShapePair& pair) const;
  /// Sets friction and restitution of two shapes.
  void set_coefficients(ContactCandidate& candidate) const;
  const ContactRules& rules() const { return rules_; }
  /// Returns the restitution of one impact, at the speed of approach that it has.
  double restitution_at(const ContactCandidate& candidate, int point) const;
  double scale_of_speed() const { return speed_; }
  double scale_of_length() const { return length_; }

  /// Returns the rounding error of a gap, m, for bodies in the given states.
  double gap_rounding(std::span<const BodyState> states) const;

  /// Returns the shapes that touch, pairs in ascending order. `states` is by body of the scene. Adds to
  /// `passing` the pairs that touch where a chain may not push: at its back, and at an end that belongs to
  /// the next segment.
  std::vector<ContactCandidate> find_candidates(std::span<const BodyState> states, double tolerance,
                                                std::vector<ShapePair>& passing) const;

  /// Updates gap rates and slip speed after velocities have changed.
  void update_rates(std::span<const BodyState> states, ContactCandidate& candidate) const;

 private:
  void update_limit_rate(std::span<const BodyState> states, ContactCandidate& candidate) const;

  ScenePartition partition_;
  std::vector<FeatureShape> shapes_;
  std::vector<char> dynamic_;  // by body
  ContactRules rules_;
  double speed_ = 1, length_ = 1;
};

/// Broad phase of a step: returns the pairs whose swept boxes overlap.
std::vector<ShapePair> overlapping_pairs(const ContactFinder& finder, const StepMotionBounds& bounds);

}  // namespace plumb::precise
