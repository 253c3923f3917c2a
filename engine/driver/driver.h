#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/driver/plan.h"
#include "engine/scene/error.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Events of contacts in Precise.
enum class ContactEvent {
  Impact,      ///< shapes that met got an impulse
  Rest,        ///< a Zeno cascade of bounces ended; the last time is that of its limit
  Hold,        ///< a contact that lasts began
  Separation,  ///< the force of a persistent contact fell to zero
  SlipStart,   ///< a sticking or rolling contact began to slip
  SlipEnd,     ///< slip ended: the contact sticks, rolls, or slips back
  Change,      ///< a contact moved to another corner or edge
  Paradox,     ///< no force could hold a slipping contact (Painleve): an impulse ended its slip
};
inline constexpr std::size_t kContactEvents = 8;

/// How often, and when last.
struct EventCount {
  std::int64_t count = 0;
  double last = 0;  ///< s
};

/// Estimated distance of a run from the true motion: the largest over all bodies and steps.
struct ErrorEstimate {
  bool known = false;   ///< the run estimates its error
  double position = 0;  ///< m
  double angle = 0;     ///< rad
  double velocity = 0;  ///< m/s
};

/// Statistics of a run so far.
struct Statistics {
  std::int64_t steps = 0;             ///< Realtime: substeps; Precise: accepted steps
  std::int64_t rejected = 0;          ///< Precise: steps that were redone with a smaller one
  std::int64_t impacts = 0;           ///< velocity jumps that were resolved
  std::int64_t evaluations = 0;       ///< evaluations of the accelerations
  std::int64_t implicit = 0;          ///< Precise: accepted steps by the implicit method
  std::int64_t leaps = 0;             ///< Precise: steps across a kinematic singularity
  std::int64_t redundant_joints = 0;  ///< Precise: joints with redundant rows, named in the plan
  std::array<EventCount, kContactEvents> contacts{};  ///< Precise: by `ContactEvent`

  ErrorEstimate error{};  ///< Precise: with `Precise::estimate_error`

  const EventCount& of(ContactEvent event) const { return contacts[static_cast<std::size_t>(event)]; }
};

/// Reaction of a joint on body b, and the opposite on body a: the multipliers of its rows, its springs,
/// limits and motors.
struct JointReaction {
  std::string joint;
  Vec2d position{};   ///< m, of its anchor on body b, in the world's frame; of b itself if it has no anchor
  Vec2d force{};      ///< N
  double torque = 0;  ///< N m, about that anchor
};

/// Reaction of a persistent contact on body b at one point, and the opposite on body a.
struct ContactReaction {
  std::size_t body_a = 0, body_b = 0;  ///< of the scene
  Vec2d position{};                    ///< m
  Vec2d normal{};                      ///< from a to b
  double normal_force = 0;             ///< N, along the normal
  double tangent_force = 0;  ///< N, along the normal turned a quarter counter-clockwise; for a pair with two
                             ///< points, the first has the sum of both
};

/// Forces of joints, in the scene's order, and of contacts, by pair.
struct Reactions {
  std::vector<JointReaction> joints;
  std::vector<ContactReaction> contacts;
};

struct CompileOptions {
  bool every_stage = false;  ///< also run stages that the scene does not need; the bits stay the same
  /// Precise: numbers of the scene for which `Simulation::sensitivities` gives derivatives of the states,
  /// such as "bodies.ball.mass" (scene/number.h). The bits of the run stay the same; each number costs about
  /// eight runs.
  std::vector<std::string> parameters{};
};

/// Advances compiled bodies in time. One virtual call per step, none per body.
class Driver {
 public:
  virtual ~Driver() = default;

  /// Advances by dt (Realtime) or max_dt (Precise). Throws `Error` (Run) that names the body and the step if
  /// a state is not finite or a work limit is reached.
  virtual void step() = 0;
  virtual double time() const = 0;  ///< s
  virtual void read(std::span<BodyState> out) const = 0;

  /// Overwrites the motion of one body, and discards cached data about its contacts.
  virtual void write(std::size_t body, const BodyState& state) = 0;

  /// Returns everything on which the future depends, warm-starting impulses included: a restored run
  /// continues with the same bits.
  virtual std::vector<std::byte> save() const = 0;
  virtual void restore(std::span<const std::byte> snapshot) = 0;

  /// Returns the forces at the time of the state that `read` returns; throws `Error` (Unsupported) for a
  /// driver that has only impulses.
  virtual Reactions reactions() {
    throw Error(Error::Kind::Unsupported, "realtime", "forces", "",
                "fixed steps have impulses, not forces; 'plumb-precise' and Precise have forces");
  }

  /// Returns d state / d parameter by body, for the parameter of this index in `CompileOptions::parameters`;
  /// throws `NotDifferentiable`, and `Error` (Value) for a parameter that was not requested.
  virtual std::vector<BodyState> sensitivities(std::size_t parameter) {
    throw Error(Error::Kind::Value, "sensitivity", "parameter", std::to_string(parameter),
                "was not among the parameters that the scene was compiled with");
  }

  virtual const Plan& plan() const = 0;
  virtual void profile(bool on) = 0;  ///< switches the stages' clocks on or off
  virtual Statistics statistics() const = 0;
  /// Called if memory ran out during a step: `read` then returns the state before the step, if the driver
  /// keeps it. No further step is requested.
  virtual void abandon_step() {}
  /// Returns the first violation of a monitored bound in a run that continues despite it; or null.
  virtual const Error* violation() const { return nullptr; }
};

}  // namespace plumb
