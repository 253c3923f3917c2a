#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/precise/dynamics/feature_shape.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/dynamics/parts.h"
#include "engine/precise/event_search/conservative_advancement.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// Returns a row's rate of change for the motions of its two bodies.
double speed_along(const Row<double>& row, const Twist<double>& a, const Twist<double>& b);

/// Two shapes that touch at an instant, in one or two points, with their relative motion there; or a limit of
/// a joint that is reached, with one point.
struct ContactCandidate {
  OutlinePair pair{};
  std::optional<std::size_t> stop{};  ///< index of the limit among the equations' stops; then without shapes
  double friction = 0;                ///< static, and of impacts
  double sliding_friction = 0;        ///< kinetic, of a persistent contact that slips
  double restitution = 0;
  int count = 0;
  Feature features[2] = {};
  ContactRows rows[2] = {};
  double closing[2] = {};  ///< m/s, the gap's rate: negative when it closes
  double slip = 0;         ///< m/s, of b against a along the tangent
  double quiet = 0;        ///< m/s, rounding error of these rates, or `graze` if larger
  double graze = 0;        ///< m/s: slower approaches end before the gap changes by more than rounding
};

/// Returns true if a point of a touch closes, faster than rounding.
inline bool closes_at(const ContactCandidate& touch, int point) {
  return touch.closing[point] < -touch.quiet;
}
/// Returns true if any point does.
inline bool closes(const ContactCandidate& touch) {
  return std::any_of(touch.closing, touch.closing + touch.count,
                     [&](double rate) { return rate < -touch.quiet; });
}

/// The outlines of a scene that may touch; finds those that touch at an instant.
class TouchFinder {
 public:
  TouchFinder(const Scene& scene, const Parts& parts);

  std::span<const FeatureShape> outlines() const { return outlines_; }
  bool may_meet(std::size_t a, std::size_t b) const;
  double friction(const OutlinePair& pair) const;
  double restitution(const OutlinePair& pair) const;
  /// Sets the coefficients of a touch of two shapes.
  void set_coefficients(ContactCandidate& touch) const;
  const ContactRules& rules() const { return rules_; }
  /// Returns the restitution of one impact, at the speed of approach that it has.
  double restitution_at(const ContactCandidate& touch, int point) const;
  double scale_of_speed() const { return speed_; }
  double scale_of_length() const { return length_; }

  /// Returns the rounding error of a gap, m, for bodies in the given states.
  double near(std::span<const BodyState> states) const;

  /// Returns the shapes that touch, pairs in ascending order. `states` is by body of the scene. Adds to
  /// `passing` the pairs that touch where a chain may not push: at its back, and at an end that belongs to
  /// the next segment.
  std::vector<ContactCandidate> touches(std::span<const BodyState> states, double near,
                                        std::vector<OutlinePair>& passing) const;

  /// Updates the rates of a touch after velocities have changed.
  void measure(std::span<const BodyState> states, ContactCandidate& touch) const;

 private:
  void measure_stop(std::span<const BodyState> states, ContactCandidate& touch) const;

  Parts parts_;
  std::vector<FeatureShape> outlines_;
  std::vector<char> dynamic_;  // by body
  ContactRules rules_;
  double speed_ = 1, length_ = 1;
};

/// Broad phase of a step: returns the pairs whose swept boxes overlap.
std::vector<OutlinePair> near_pairs(const TouchFinder& finder, const StepMotionBounds& paths);

}  // namespace plumb::precise
