#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/precise/dynamics/motion.h"
#include "engine/precise/events/contact_candidate.h"
#include "engine/precise/events/coulomb.h"

namespace plumb::precise {

/// A motor or a brake at its target speed, held there by a force of at most `bound` along its row, N or N m.
struct Brake {
  std::size_t stop = 0;
  Row<double> row{};
  double bound = 0;
};

/// The Coulomb problem of touches' points: normals first, then one tangent per touch, then the brakes' rows.
struct TouchProblem {
  std::vector<std::size_t> touch_of, index_of;  ///< by point: index of the touch, and of the point within it
  std::vector<std::size_t> touches;             ///< by patch; the brakes' patches follow
  ContactResponse response;
  CoulombProblem problem;  ///< with the response; the caller fills the rates

  /// Builds the problem of the points that `take` selects.
  static TouchProblem of(std::span<const ContactCandidate> touches,
                         const std::function<bool(std::size_t, int)>& take, std::span<const Brake> brakes,
                         EquationsOfMotion& equations, double time, std::span<const double> y);
};

/// Impacts at an instant: Newton's restitution and Coulomb's friction for impulses. For a touch with gap
/// rates u before and u' after,
///     u' >= -e u if it approaches, u' >= 0 otherwise;  impulses push, and only where equality holds;
/// tangential impulses oppose the remaining slip, or stop it within Coulomb's cone. Two corners of one shape
/// that approach an edge of another together are one problem. If only one of them approaches, they are
/// resolved alternately until neither does: such impacts shrink like a geometric series, and end at its
/// limit. Simultaneous touches are resolved in sequence, the fastest first, until none approaches, or as one
/// problem (`ContactRules::simultaneous`). Reached limits of joints take part in every impact as joints do,
/// but only push, and have no restitution.
/// With another law of impact (`ContactRules::impact`) each pair is one point: for two corners that approach
/// together, the point of application of the impulse that would stop both. Joints take part; reached limits
/// are resolved in turn.
class ImpactLaw {
 public:
  ImpactLaw(const TouchFinder& finder, EquationsOfMotion& equations)
      : finder_(finder), equations_(equations) {}

  /// Restitution by touch and point; the caller may set it to zero where bouncing ends.
  using Restitution = std::function<double(const ContactCandidate& touch, int point)>;

  /// Resolves all approaching touches. `states` are by body of the scene, of all bodies with outlines; their
  /// velocities change with `y`. Returns the number of impacts; throws `Error` (Run) if nothing can move.
  std::int64_t resolve(double time, std::vector<ContactCandidate>& touches, std::span<BodyState> states,
                       Compensated& y, const Restitution& restitution);

  /// Resolves Painleve's paradox: a slipping touch that no finite force holds. An impulse stops the slip
  /// while it pushes, then sticks (or slips back) until the gap's rate is zero again. Returns true if such a
  /// touch was found.
  bool jamb(double time, std::vector<ContactCandidate>& touches, std::span<BodyState> states, Compensated& y);

 private:
  void strike(double time, const std::function<bool(std::size_t touch, int point)>& takes_part,
              std::span<ContactCandidate> touches, std::span<BodyState> states, Compensated& y,
              const Restitution& restitution);
  /// Resolves the approaching points of one touch by a law that follows the slip.
  void strike_point(double time, std::size_t touch, std::span<ContactCandidate> touches,
                    std::span<BodyState> states, Compensated& y, const Restitution& restitution);
  std::string subject(const ContactCandidate& touch) const;
  void apply(const ContactResponse& response, std::span<const double> impulses,
             std::span<ContactCandidate> touches, std::span<BodyState> states, Compensated& y);

  const TouchFinder& finder_;
  EquationsOfMotion& equations_;
};

}  // namespace plumb::precise
