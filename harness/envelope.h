#pragma once

#include <cstddef>
#include <vector>

#include "harness/impacts.h"
#include "harness/truth_table.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

/// How far a body's state may be from the truth, in SI units.
struct StateBound {
  double position = 0, angle = 0, velocity = 0, angular_velocity = 0;
};

/// What rounding alone may do to a state: each update of a body rounds at most `kRoundings` times, each time
/// by half of epsilon relative to what is updated, and a rounded velocity moves the body for the rest of the
/// run:
///   velocity kRoundings eps n V,  position kRoundings eps n (X + V t)
/// after n substeps, with X and V the largest coordinate and speed of the scene. Likewise for angles; and the
/// arm of an impact's impulse is a difference of coordinates, which turns a body that should not turn.
StateBound rounding_bound(const Scale& scale, double epsilon, double steps, double time);

inline constexpr double kRoundings = 4;

/// An engine's distance from the truth that its method explains, for every body on every step's sample:
/// derived from the order of the method, the substep h and the truth's own motion, not from any engine.
///
/// **Smooth motion.** A first-order scheme evaluates each force, and lets each change of velocity act, up to
/// one substep early or late. With TV the total variation so far, along the truth,
///   dV = h d TV(a),  dP = h d TV(v) + V dt.
/// The forces of joints begin at the start, from free fall: |a(0) - g| is part of TV(a). (A scheme that makes
/// velocities fit the joints where the step began shows the velocity of one step earlier: h |a - g|.)
/// A second-order scheme is centred; its leading errors have one more derivative and one more power of h:
///   dV = h^2 d TV(a'),  dP = h^2 d TV(a) + V dt.
/// (The constants of the classic schemes are between 1/24 and 1/2; 1 is used.) Angles go the same way. An
/// adaptive method errs by its tolerance, relative to the scene's own length and speed, `kAdaptiveSteps`
/// times a sample.
///
/// **Forces that turn.** Where a force is fixed in a body, an angle error turns the acceleration (|F|/m per
/// rad); where it is fixed in the world and acts at a point of the body, it changes the torque (|F||r|/I per
/// rad). Both are fed back; so is the rest of the motion of a jointed body only through its own variation.
///
/// **Impacts.** One is noticed up to one substep late or early, and the time is shifted further by what the
/// approaching bodies are already off: D = h + (P_i + P_j)/closing speed. Until then the velocity is that of
/// the other side of the jump, so P_i += |jump| D. The contact's normal has turned by
///   turn = (sliding speed D + P_i + P_j across the normal) / (distance of the centres - closing speed D).
/// The jump is |jump| (u.n) n / closing in the relative velocity u and the normal n, so it is off by
///   |jump|/closing ((turn sliding + V_i + V_j along n) along n + turn closing across n).
/// The arm of the impulse is off by what the place of the contact is off (a disc's only by rounding), which
/// turns the body by m/I |jump| a unit of arm. V and P are kept by component, x and y: what is off along a
/// line of impacts does not turn their normals.
class Envelope {
 public:
  Envelope(const scenarios::Problem& problem, const TruthTable& truth, const reference::Method& method,
           double tolerance);

  /// Rounding is not included.
  const StateBound& at(int sample, std::size_t body) const {
    return bounds_[static_cast<std::size_t>(sample) * bodies_ + body];
  }

  static constexpr double kAdaptiveSteps = 10;

 private:
  std::size_t bodies_;
  std::vector<StateBound> bounds_;
};

}  // namespace plumb::harness
