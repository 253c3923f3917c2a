#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/driver/accuracy.h"
#include "engine/driver/snapshot.h"
#include "engine/integrate/compensated.h"
#include "engine/integrate/dop853.h"
#include "engine/integrate/radau.h"
#include "engine/integrate/step_control.h"
#include "engine/integrate/step_polynomial.h"
#include "engine/precise/dynamics/articulated_tree.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/dynamics/scene_partition.h"
#include "engine/precise/integration/passage.h"
#include "engine/precise/integration/stiff.h"
#include "engine/precise/integration/symplectic.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// Integrates the integrated bodies between events, in steps whose error meets the tolerance, and gives the
/// state at any time within the last step. The caller handles events: it makes a step, locates events inside
/// it, and ends it at one by `truncate`; after a jump it must call `restart`.
class EventFreeIntegrator {
 public:
  EventFreeIntegrator(const Scene& scene, const ScenePartition& partition, const Precise& precise,
                      EquationsOfMotion& equations);

  double time() const { return time_; }                ///< s: end of the last step
  const Compensated& state() const { return y_; }      ///< the state at `time()`, joints closed
  std::size_t dimension() const { return y_.size(); }  ///< 0: nothing is integrated

  /// Returns true if only constant forces act until the next event, so that steps are parabolas.
  bool is_ballistic() const { return constant_forces_ && !equations_.has_active_constraints(); }

  /// Makes one step that meets the tolerance, from `time` to at most `limit` (may be infinite) and to at most
  /// the next switching time of a force; returns its end. Throws `Error` (Run) that names the body when no
  /// step is small enough. With nothing to integrate, the step ends at its limit, which must then be finite.
  double step(double limit);

  /// Returns the work of forces other than gravity over the last step, J, to the step's accuracy. Returns
  /// nothing if unknown: for implicit steps with such forces, and for symplectic steps, whose energy
  /// oscillates within its own bound.
  std::optional<double> work() const;

  double start() const { return start_; }  ///< s: start of the last step
  const Compensated& state_at_start() const { return y0_; }

  /// Returns the polynomial over the last step, relative to `state_at_start`, with s = (t - start) / (time -
  /// start). It is of order 7 and is computed on the first call after a step. It covers all coordinates if
  /// shapes may touch or limits of joints may be reached.
  const StepPolynomial& polynomial();

  /// Computes the state at a time within the last step, by its polynomial. `project` closes the joints there
  /// too.
  void at(double time, bool project, Compensated& out);

  /// Makes the last step end at `time`, within it: repeats it with that length, so that it keeps the order of
  /// the method.
  void truncate(double time);

  /// Goes back to a time within the last step and discards the motion beyond it.
  void rewind(double time);

  /// Returns the state at `time` for changes; `restart` (or `reset`) must follow.
  Compensated& mutable_state() { return y_; }
  /// Continues after a jump of velocities or of forces: the next step begins from the changed state.
  void restart();
  /// Continues after a switch of formulas: prescribed bodies and motors take the speeds of their next piece.
  void pass_switch();
  /// Continues after bodies were changed from outside: closes joints and resets the step length.
  void reset();

  std::int64_t rejected() const { return rejected_; }
  std::int64_t implicit_steps() const { return implicit_steps_; }
  /// Returns the number of steps over a kinematic singularity.
  std::int64_t singularity_steps() const { return singularity_steps_; }
  /// Returns the joints that have redundant rows at the start.
  const std::vector<std::string>& redundant_joints() const { return redundant_joints_; }

  /// Throws `Error` (Run) that names the body whose motion changes fastest.
  [[noreturn]] void throw_step_underflow() const;

  /// Saves all data on which later steps depend, and states from the time `sampled` on.
  void save(double sampled, SnapshotWriter& out);
  void restore(SnapshotReader& in);

  double projection_nanoseconds = 0;  ///< spent closing joints, while `equations.cost.on`

 private:
  /// Coordinates of explicit steps: all of them, or only the angles of articulated trees.
  struct Coordinates {
    Coordinates(Flow& its_flow, std::size_t dimension)
        : flow(its_flow), method(dimension), polynomial(dimension), error_scale(dimension, 1.0) {}
    Flow& flow;
    Dop853 method;
    StepPolynomial polynomial;
    std::vector<double> error_scale;
  };
  bool uses_angles() const { return !tree_.empty() && !stiff_; }  // the next step
  Coordinates& current() { return uses_angles() ? angles_ : all_; }
  const Coordinates& current() const { return uses_angles() ? angles_ : all_; }
  bool last_used_angles() const { return !tree_.empty() && !last_implicit_; }  // the last step
  Coordinates& last() { return last_used_angles() ? angles_ : all_; }
  const Coordinates& last() const { return last_used_angles() ? angles_ : all_; }
  std::span<const double> coordinates_of(const Compensated& y);
  std::span<const double> rate_at_start() const { return current().method.first_rate(); }
  std::span<const double> rate_at_end();

  void begin_step();
  // Returns a time inside a piece of a formula of the motion that the last step has passed whole
  // (integrator_pieces.cpp).
  std::optional<double> time_in_passed_piece();
  void ballistic_step(double end);
  // These are for steps near kinematic singularities of closed linkages (integrator_singularity.cpp).
  bool is_near_singularity();
  void extrapolate_motion();
  void check_initial_rank();
  double step_near_singularity(double limit);
  double try_near_singularity(double end);
  double accept_near_singularity(double error);
  [[noreturn]] void throw_singular() const;
  Flow& flow_of_last() { return last_near_singularity_ ? passage_ : current().flow; }
  double symplectic_step(double limit);
  double longest_symplectic_step();
  double try_step(double end, bool again);
  void accept(double h, double error);
  void apply_increment(double end);
  void update_stiffness();
  double spectral_radius();
  double end_of_step(double limit) const;
  double next_switch() const;
  double first_step() const;
  void set_error_scale();
  void project(double time, Compensated& y);

  /// Number of steps whose errors together equal `Precise::tolerance`. Errors add up over thousands of steps
  /// and grow along chaotic motion. The three additional digits cost 2.4 times as many steps of a method of
  /// order 8.
  static constexpr double kSteps = 1000;

  const double tolerance_;
  const Scales scales_;
  const double longest_step_;  // s
  const std::vector<std::size_t> bodies_;
  const std::vector<double> switches_;
  std::vector<std::string> names_;  // by slot
  std::vector<std::string> redundant_joints_;
  EquationsOfMotion& equations_;
  const MotionMethod method_;
  const bool constant_forces_;  // contacts apart
  ArticulatedTree tree_;
  Coordinates all_, angles_;
  Radau implicit_;
  StiffMotion stiff_motion_;
  SymplecticMotion symplectic_;
  SingularityPassage passage_;
  StepControl control_;
  bool stiff_ = false, last_implicit_ = false;  // the next step is implicit; the last one was
  bool jumped_ = false;                         // since the last step
  bool last_was_ballistic_ = false;             // the last step was a ballistic parabola
  int signs_of_stiffness_ = 0, nonstiff_steps_ = 0;
  double start_ = 0, time_ = 0;
  Compensated y0_, y_;                                  // at the start and end of the last step
  bool polynomial_known_ = false, rate_known_ = false;  // of the last step; at its end
  double proposed_step_ = 0;                            // s; 0: none yet
  struct Rank {
    double min_pivot_ratio = 1;
    int dependent = 0;
  };
  Rank rank_at_start_;                  // of the joints' rows, at the start of the next step
  double previous_pivot_ratio_ = 1;     // `min_pivot_ratio` at the start of the last step
  bool near_singularity_ = false;       // the next step is near a kinematic singularity
  bool last_near_singularity_ = false;  // the last step was near one
  bool has_expected_ = false;           // the last step gave the expected passage
  std::int64_t rejected_ = 0, implicit_steps_ = 0, singularity_steps_ = 0;
};

}  // namespace plumb::precise
