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
#include "engine/precise/dynamics/hanging.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/dynamics/parts.h"
#include "engine/precise/integration/passage.h"
#include "engine/precise/integration/stiff.h"
#include "engine/precise/integration/symplectic.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// Integrates the integrated bodies between events, in steps whose error meets the tolerance, and gives the
/// state at any time within the last step. The caller handles events: it makes a step, locates events inside
/// it, and ends it at one by `cut`; after a jump it must call `restart`.
class EventFreeIntegrator {
 public:
  EventFreeIntegrator(const Scene& scene, const Parts& parts, const Precise& precise,
                      EquationsOfMotion& equations);

  double time() const { return time_; }                ///< s: end of the last step
  const Compensated& state() const { return y_; }      ///< the state at `time()`, joints closed
  std::size_t dimension() const { return y_.size(); }  ///< 0: nothing is integrated

  /// Returns true if only constant forces act until the next event, so that steps are parabolas.
  bool flies() const { return ballistic_ && !equations_.holds_anything(); }

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
  void cut(double time);

  /// Goes back to a time within the last step and discards the motion beyond it.
  void rewind(double time);

  /// Returns the state at `time` for changes; `restart` (or `start_anew`) must follow.
  Compensated& change() { return y_; }
  /// Continues after a jump of velocities or of forces: the next step begins from the changed state.
  void restart();
  /// Continues after bodies were changed from outside: closes joints and resets the step length.
  void start_anew();

  std::int64_t rejected() const { return rejected_; }
  std::int64_t implicit_steps() const { return implicit_steps_; }
  /// Returns the number of steps over a kinematic singularity.
  std::int64_t leaps() const { return leaps_; }
  /// Returns the joints that have redundant rows at the start.
  const std::vector<std::string>& redundant_joints() const { return redundant_joints_; }

  /// Throws `Error` (Run) that names the body whose motion changes fastest.
  [[noreturn]] void throw_step_underflow() const;

  /// Saves all data on which later steps depend, and states from the time `sampled` on.
  void save(double sampled, SnapshotWriter& out);
  void restore(SnapshotReader& in);

  double projection_nanoseconds = 0;  ///< spent closing joints, while `equations.cost.on`

 private:
  /// Coordinates of explicit steps: all of them, or only the angles of hanging trees.
  struct Coordinates {
    Coordinates(Flow& its_flow, std::size_t dimension)
        : flow(its_flow), method(dimension), polynomial(dimension), error_scale(dimension, 1.0) {}
    Flow& flow;
    Dop853 method;
    StepPolynomial polynomial;
    std::vector<double> error_scale;
  };
  bool in_angles() const { return !hanging_.empty() && !stiff_; }  // the next step
  Coordinates& now() { return in_angles() ? angles_ : all_; }
  const Coordinates& now() const { return in_angles() ? angles_ : all_; }
  bool was_in_angles() const { return !hanging_.empty() && !last_implicit_; }  // the last step
  Coordinates& last() { return was_in_angles() ? angles_ : all_; }
  const Coordinates& last() const { return was_in_angles() ? angles_ : all_; }
  std::span<const double> seen(const Compensated& y);
  std::span<const double> rate_at_start() const { return now().method.first_rate(); }
  std::span<const double> rate_at_end();

  void begin();
  void fly(double end);
  // These are for steps near kinematic singularities of closed linkages (smooth_passage.cpp).
  bool is_near_crossing();
  void expect_passage();
  void look_at_rows();
  double step_near_crossing(double limit);
  double try_near_crossing(double end);
  double accept_near_crossing(double error);
  [[noreturn]] void refuse_crossing() const;
  Flow& flow_of_last() { return last_near_ ? passage_ : now().flow; }
  double symplectic_step(double limit);
  double longest_symplectic_step();
  double try_step(double end, bool again);
  void accept(double h, double error);
  void take_increment(double end);
  void watch_stiffness();
  double fastest_rate();
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
  const bool ballistic_;  // contacts apart
  HangingTree hanging_;
  Coordinates all_, angles_;
  Radau implicit_;
  StiffMotion stiff_motion_;
  SymplecticMotion symplectic_;
  Passage passage_;
  StepControl control_;
  bool stiff_ = false, last_implicit_ = false;  // the next step is implicit; the last one was
  bool jumped_ = false;                         // since the last step
  bool last_flew_ = false;                      // the last step was a ballistic parabola
  int signs_of_stiffness_ = 0, steps_without_ = 0;
  double start_ = 0, time_ = 0;
  Compensated y0_, y_;                                  // at the start and end of the last step
  bool polynomial_known_ = false, rate_known_ = false;  // of the last step; at its end
  double proposed_step_ = 0;                            // s; 0: none yet
  struct Rank {
    double weakest = 1;
    int dependent = 0;
  };
  Rank rank_at_start_;         // of the joints' rows, at the start of the next step
  double weakest_before_ = 1;  // `weakest` at the start of the last step
  bool near_ = false;          // the next step is near a kinematic singularity
  bool last_near_ = false;     // the last step was near one
  bool expects_ = false;       // the last step gave the expected passage
  std::int64_t rejected_ = 0, implicit_steps_ = 0, leaps_ = 0;
};

}  // namespace plumb::precise
