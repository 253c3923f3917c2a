#pragma once

#include <string_view>
#include <variant>

/// The two honest ways to step: a fixed step that is cheap, or a tolerance that is met.
namespace plumb {

enum class Precision { Float, Double };

/// How velocities and positions follow from forces. The two Euler schemes are those of the course.
enum class Integrator {
  VelocityVerlet,     ///< second order; free flight under constant force is exact
  SemiImplicitEuler,  ///< first order: v += h a, then x += h v; falls g h t / 2 too far
  ExplicitEuler,      ///< first order: x += h v, then v += h a; falls g h t / 2 too little; gains energy
};

/// How joints are held in Realtime.
enum class JointSolver {
  Direct,     ///< sparse factorisation of all joints at once: no stretch, linear in the length of a chain
  Iterative,  ///< sequential impulses, one joint after another
};

/// Reaction of Realtime when its watch finds that a step violates a bound (docs/design.md).
enum class OnDoubt {
  Stop,    ///< takes the step back and throws `Error` (Run)
  Report,  ///< goes on; `Simulation::doubt` has what was found first
};

/// Fixed steps.
struct Realtime {
  double dt = 1.0 / 60;  ///< s, > 0
  int substeps = 4;      ///< >= 1
  int iterations = 4;    ///< sweeps over contacts (and iterative joints) a substep, >= 1
  Precision precision = Precision::Double;
  Integrator integrator = Integrator::VelocityVerlet;
  JointSolver joint_solver = JointSolver::Direct;
  OnDoubt on_doubt = OnDoubt::Stop;  ///< of velocity Verlet; the Euler schemes promise nothing
  friend bool operator==(const Realtime&, const Realtime&) = default;
};

/// How Precise follows the motion between events.
enum class MotionMethod {
  Automatic,   ///< Explicit, and Implicit for as long as the motion is stiff
  Explicit,    ///< DOP853, order 8
  Implicit,    ///< Radau IIA, order 9: modes far faster than the motion that is looked at do not limit steps
  Symplectic,  ///< RATTLE composed to order 8, at a fixed step: energy does not drift over long runs
};

/// Adaptive high-order steps in double; impacts are located in time.
struct Precise {
  double tolerance = 1e-9;  ///< local error a step, relative to the scene's own length and speed, > 0
  double max_dt =
      1.0 / 60;  ///< s, > 0: what `Simulation::step` advances by; steps of the motion may be longer
  MotionMethod method = MotionMethod::Automatic;
  bool estimate_error = false;  ///< runs a second motion at a tenth of the tolerance beside, to compare with
  friend bool operator==(const Precise&, const Precise&) = default;
};

using Accuracy = std::variant<Realtime, Precise>;

std::string_view name_of(Precision precision);  ///< "float", "double"
std::string_view name_of(
    Integrator integrator);  ///< "velocity_verlet", "semi_implicit_euler", "explicit_euler"
std::string_view name_of(JointSolver joint_solver);  ///< "direct", "iterative"
std::string_view name_of(OnDoubt on_doubt);          ///< "stop", "report"
std::string_view name_of(MotionMethod method);       ///< "automatic", "explicit", "implicit", "symplectic"

/// Throws `Error` (Value) that names the setting: dt <= 0, substeps < 1, a tolerance that is not positive.
void validate(const Accuracy& accuracy);

}  // namespace plumb
