#pragma once

#include <cstddef>
#include <vector>

#include "harness/impacts.h"
#include "harness/truth_table.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

/// Bound on the distance of a body's state from the truth, in SI units.
struct StateBound {
  double position = 0, angle = 0, velocity = 0, angular_velocity = 0;
};

/// Returns the bound of rounding errors in a state: each update of a body rounds at most `kRoundings` times,
/// each time by half of epsilon relative to the updated value. A rounded velocity moves the body for the rest
/// of the run:
///     velocity kRoundings eps n V,  position kRoundings eps n (X + V t)
/// after n substeps, with X and V the largest coordinate and speed of the scene. The same holds for angles.
/// In addition, the lever arm of an impact's impulse is a difference of coordinates, so its rounding adds
/// spin.
StateBound rounding_bound(const Scale& scale, double epsilon, double steps, double time);

inline constexpr double kRoundings = 4;

/// Bound on an engine's distance from the truth that its method explains, for every body on every sample.
/// Derived from the order of the method, the substep h and the truth's own motion, not from any engine.
///
/// **Smooth motion.** A first-order scheme evaluates each force, and applies each change of velocity, up to
/// one substep early or late. With TV the total variation so far, along the truth,
///   dV = h d TV(a),  dP = h d TV(v) + V dt.
/// Joint forces begin at the start, from free fall, so |a(0) - g| is part of TV(a). (A scheme that makes
/// velocities satisfy the joints where the step began shows the velocity of one step earlier: h |a - g|.)
/// A second-order scheme is centred; its leading errors have one more derivative and one more power of h:
///   dV = h^2 d TV(a'),  dP = h^2 d TV(a) + V dt.
/// (The constants of the classic schemes are between 1/24 and 1/2; 1 is used.) Angles are bounded alike. An
/// adaptive method errs by its tolerance, relative to the scene's own length and speed, `kAdaptiveSteps`
/// times a sample.
///
/// **Forces that rotate.** An angle error rotates the acceleration of a body-fixed force (|F|/m per rad). For
/// a world-fixed force at a point of the body it changes the torque (|F||r|/I per rad). Both are fed back;
/// the rest of the motion of a jointed body is fed back only through its own variation. A joint's force that
/// acts a substep early or late turns the body until the joint corrects it: h m r/I |a - g| in the angular
/// velocity and h times that in the angle, with r the joint's distance from the centre.
///
/// **Persistent contacts.** Their forces act up to a substep early or late, whatever the order of the method.
/// With f = a - g: h |f| in velocity and h^2 |f| in position while they last, which the contact itself
/// corrects (and m r/I of these in the angle, r the body's radius). Along the body's motion nothing corrects
/// the error of their beginning: dV = h |f.v|/|v|.
///
/// **Impacts.** An impact is detected up to one substep late or early, and the existing error of the
/// approaching bodies shifts the time further: D = h + (P_i + P_j)/closing speed. Until then the velocity is
/// that of the other side of the jump, so P_i += |jump| D. The contact's normal has rotated by
///   turn = (sliding speed D + P_i + P_j across the normal) / (distance of the centres - closing speed D).
/// The jump is |jump| (u.n) n / closing in the relative velocity u and the normal n, so it is off by
///   |jump|/closing ((turn sliding + V_i + V_j along n + g D) along n + turn closing across n),
/// with g the gravity along n that the two do not share.
/// The lever arm of the impulse is off by the error of the contact point (a disc's only by rounding). That
/// changes the angular velocity by m/I |jump| per unit of arm. V and P are kept by component, x and y: an
/// error along a line of impacts does not turn their normals.
class Envelope {
 public:
  Envelope(const scenarios::Problem& problem, const TruthTable& truth, const reference::Method& method,
           double tolerance);

  /// Returns the bound without rounding.
  const StateBound& at(int sample, std::size_t body) const {
    return bounds_[static_cast<std::size_t>(sample) * bodies_ + body];
  }

  static constexpr double kAdaptiveSteps = 10;

 private:
  std::size_t bodies_;
  std::vector<StateBound> bounds_;
};

}  // namespace plumb::harness
