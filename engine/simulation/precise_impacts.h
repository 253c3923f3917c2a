#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/simulation/precise_motion.h"
#include "engine/simulation/precise_touch.h"
#include "engine/solve/coulomb.h"

namespace plumb::precise {

/// A motor or a brake at its speed: a force of at most `bound` along its row, N or N m, keeps it there.
struct Brake {
  std::size_t stop = 0;
  Row<double> row{};
  double bound = 0;
};

/// The Coulomb problem of touches' points: normals first, then one tangent a touch, then the brakes' rows.
struct TouchProblem {
  std::vector<std::size_t> touch_of, index_of;  ///< by point: which touch, and which of its points
  std::vector<std::size_t> touches;             ///< by patch; the brakes' patches follow
  ContactResponse response;
  CoulombProblem problem;  ///< response filled; rates are the caller's to fill

  /// Of the points that `take` chooses.
  static TouchProblem of(std::span<const Touch> touches, const std::function<bool(std::size_t, int)>& take,
                         std::span<const Brake> brakes, EquationsOfMotion& equations, double time,
                         std::span<const double> y);
};

/// Impacts at an instant: Newton's restitution and Coulomb's friction for impulses. For a touch with gap
/// rates u before and u' after,
///   u' >= -e u where it closes, u' >= 0 else;  impulses push, and only where equality holds;
///   tangential impulses oppose the slip that is left, or stop it within Coulomb's cone.
/// Two corners of one shape that close on an edge of another together are one problem; where one closes and
/// the other does not, they are struck in turn until neither closes, however often: alternating impacts
/// shrink like a geometric series, and end at its limit. Several touches at once are a sequence, the fastest
/// first, until none closes, or one problem (`ContactRules::simultaneous`). Limits of joints that are met
/// take part in every impact as joints do, but only push, and have no restitution.
class ImpactLaw {
 public:
  ImpactLaw(const TouchFinder& finder, EquationsOfMotion& equations)
      : finder_(finder), equations_(equations) {}

  /// Restitution by touch and point; the caller may have set it to zero where bouncing ends.
  using Restitution = std::function<double(const Touch& touch, int point)>;

  /// Resolves what closes. `states` are by body of the scene, of everything that has outlines; their
  /// velocities change with `y`. Returns how many impacts there were; throws `Error` (Run) where nothing can
  /// give way.
  std::int64_t resolve(double time, std::vector<Touch>& touches, std::span<BodyState> states, Compensated& y,
                       const Restitution& restitution);

  /// Painleve's paradox: a slipping touch that no finite force holds. An impulse stops its slip while it
  /// presses on, then sticks (or slips back) until the gap's rate is zero again. Returns whether one was
  /// found.
  bool jamb(double time, std::vector<Touch>& touches, std::span<BodyState> states, Compensated& y);

 private:
  void strike(double time, const std::function<bool(std::size_t touch, int point)>& takes_part,
              std::span<Touch> touches, std::span<BodyState> states, Compensated& y,
              const Restitution& restitution);
  std::string subject(const Touch& touch) const;
  void apply(const ContactResponse& response, std::span<const double> impulses, std::span<Touch> touches,
             std::span<BodyState> states, Compensated& y);

  const TouchFinder& finder_;
  EquationsOfMotion& equations_;
};

}  // namespace plumb::precise
