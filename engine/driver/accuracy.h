#pragma once

#include <string_view>
#include <variant>

#include "engine/world/integrator.h"
#include "engine/world/solver.h"

/// The two ways to step: fixed steps at low cost, or a tolerance that is met.
namespace plumb {

enum class Precision { Float, Double };

/// Reaction to a step that misses a bound of the invariant monitor (`MonitorBounds`).
enum class OnViolation {
  Ignore,  ///< no monitor
  Report,  ///< goes on; `Simulation::violation` has the first
  Stop,    ///< undoes the step and throws `Error` (Run)
};

/// Fixed steps of a world (engine/world/world.h).
struct Realtime {
  double dt = 1.0 / 60;  ///< s, > 0
  int substeps = 4;      ///< 1..1000; force laws are evaluated in each
  int iterations = 10;   ///< a substep, 1..1000: SequentialImpulses and Jakobsen
  Precision precision = Precision::Double;
  Integrator integrator = Integrator::VelocityVerlet;
  Solver solver = Solver::SoftSteps;
  bool continuous = true;  ///< continuous collision
  bool sleeping = false;   ///< islands at rest fall asleep
  OnViolation on_violation = OnViolation::Ignore;
  int threads = 1;  ///< threads that share a step, 1..64: each number gives the same bits
  friend bool operator==(const Realtime&, const Realtime&) = default;
};

/// Integration method of Precise between events.
enum class MotionMethod {
  Automatic,   ///< Explicit, and Implicit for as long as the motion is stiff
  Explicit,    ///< DOP853, order 8
  Implicit,    ///< Radau IIA, order 9: modes far faster than the motion of interest do not limit steps
  Symplectic,  ///< RATTLE composed to order 8, at a fixed step: energy does not drift over long runs
};

/// Adaptive high-order steps in double; impacts are located in time.
struct Precise {
  double tolerance = 1e-9;  ///< local error a step, relative to the scene's own length and speed, > 0
  double max_dt =
      1.0 / 60;  ///< s, > 0: advance of `Simulation::step`; steps of the integration may be longer
  MotionMethod method = MotionMethod::Automatic;
  bool estimate_error = false;  ///< also runs at a tenth of the tolerance, for comparison
  friend bool operator==(const Precise&, const Precise&) = default;
};

using Accuracy = std::variant<Realtime, Precise>;

std::string_view name_of(Precision precision);  ///< "float", "double"
std::string_view name_of(
    Integrator integrator);  ///< "velocity_verlet", "semi_implicit_euler", "explicit_euler"
std::string_view name_of(OnViolation on_violation);  ///< "ignore", "report", "stop"
std::string_view name_of(MotionMethod method);       ///< "automatic", "explicit", "implicit", "symplectic"

/// Throws `Error` (Value) that names the setting: dt <= 0, substeps < 1, a tolerance that is not positive.
void validate(const Accuracy& accuracy);

}  // namespace plumb
