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

/// A motor (or a brake, whose target is 0) at its target speed, held there by a force of at most `bound`
/// along its row, N or N m.
struct MotorAtSpeed {
  std::size_t index = 0;  ///< in `limits_and_motors()`
  Row<double> row{};
  double bound = 0;
};

/// The Coulomb problem of candidates' points: normals first, then one tangent per candidate, then motors.
struct ContactProblem {
  std::vector<std::size_t> candidate_of,
      index_of;                         ///< by point: index of the candidate, and of the point within it
  std::vector<std::size_t> candidates;  ///< by patch; the motors' patches follow
  ContactResponse response;
  CoulombProblem problem;  ///< with the response; the caller fills the rates

  /// Builds the problem of the points that `select` selects.
  static ContactProblem of(std::span<const ContactCandidate> candidates,
                           const std::function<bool(std::size_t, int)>& select,
                           std::span<const MotorAtSpeed> motors, EquationsOfMotion& equations, double time,
                           std::span<const double> y);
};

/// Impacts at an instant: Newton's restitution and Coulomb's friction for impulses. For a point with gap
/// rates u before and u' after,
///     u' >= -e u if it approaches, u' >= 0 otherwise;  impulses push, and only where equality holds;
/// tangential impulses oppose the remaining slip, or stop it within Coulomb's cone. Two corners of one shape
/// that approach an edge of another together are one problem. If only one of them approaches, they are
/// resolved alternately until neither does: such impacts shrink like a geometric series, and end at its
/// limit. Simultaneous impacts are resolved in sequence, the fastest first, until none approaches, or as one
/// problem (`ContactRules::simultaneous`). Reached limits of joints take part in every impact as joints do,
/// but only push, and have no restitution.
/// With another law of impact (`ContactRules::impact`) each pair is one point: for two corners that approach
/// together, the point of application of the impulse that would stop both. Joints take part; reached limits
/// are resolved in turn.
class ImpactSolver {
 public:
  ImpactSolver(const ContactFinder& finder, EquationsOfMotion& equations)
      : finder_(finder), equations_(equations) {}

  /// Restitution by candidate and point; the caller may set it to zero where bouncing ends.
  using Restitution = std::function<double(const ContactCandidate& candidate, int point)>;

  /// Resolves all approaching candidates. `states` are by body of the scene, of all bodies with shapes; their
  /// velocities change with `y`. Returns the number of impacts; throws `Error` (Run) if nothing can move.
  std::int64_t resolve(double time, std::vector<ContactCandidate>& candidates, std::span<BodyState> states,
                       Compensated& y, const Restitution& restitution);

  /// Resolves Painleve's paradox: a slipping contact that no finite force holds. An impulse stops the slip
  /// while it pushes, then sticks (or slips back) until the gap's rate is zero again. Returns true if such a
  /// contact was found.
  bool resolve_jamming(double time, std::vector<ContactCandidate>& candidates, std::span<BodyState> states,
                       Compensated& y);

 private:
  void solve_impact(double time, const std::function<bool(std::size_t candidate, int point)>& takes_part,
                    std::span<ContactCandidate> candidates, std::span<BodyState> states, Compensated& y,
                    const Restitution& restitution);
  /// Resolves the approaching points of one candidate by a law that follows the slip (`ImpactRule`).
  void apply_impact_law(double time, std::size_t candidate, std::span<ContactCandidate> candidates,
                        std::span<BodyState> states, Compensated& y, const Restitution& restitution);
  std::string subject(const ContactCandidate& candidate) const;
  void apply(const ContactResponse& response, std::span<const double> impulses,
             std::span<ContactCandidate> candidates, std::span<BodyState> states, Compensated& y);

  const ContactFinder& finder_;
  EquationsOfMotion& equations_;
};

}  // namespace plumb::precise
