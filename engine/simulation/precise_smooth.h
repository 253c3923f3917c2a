#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/integrate/compensated.h"
#include "engine/integrate/dop853.h"
#include "engine/integrate/radau.h"
#include "engine/integrate/step_control.h"
#include "engine/integrate/step_polynomial.h"
#include "engine/scene/scene.h"
#include "engine/simulation/accuracy.h"
#include "engine/simulation/precise_hanging.h"
#include "engine/simulation/precise_motion.h"
#include "engine/simulation/precise_parts.h"
#include "engine/simulation/precise_passage.h"
#include "engine/simulation/precise_stiff.h"
#include "engine/simulation/precise_symplectic.h"
#include "engine/simulation/snapshot.h"

namespace plumb::precise {

/// The motion of the integrated bodies between events: steps whose error meets the tolerance, and the state
/// at any time within the last one. Where events lie is the caller's to know: a step is made first and looked
/// at then, and events are looked for inside it; `cut` ends it at one, and after a jump `restart` is due.
class SmoothMotion {
 public:
  SmoothMotion(const Scene& scene, const Parts& parts, const Precise& precise, EquationsOfMotion& equations);

  double time() const { return time_; }                ///< s: where the last step ended
  const Compensated& state() const { return y_; }      ///< there, joints closed
  std::size_t dimension() const { return y_.size(); }  ///< 0: nothing is integrated

  /// Nothing but constant forces acts until the next event: steps are parabolas.
  bool flies() const { return ballistic_ && !equations_.holds_anything(); }

  /// One step that meets the tolerance, from `time` to at most `limit` (may be infinite) and to at most the
  /// next time at which a force is switched; returns where it ends. Throws `Error` (Run) that names the body
  /// when no step is small enough. With nothing to integrate, it ends as far as it may: `limit` is then
  /// finite.
  double step(double limit);

  /// What forces other than gravity have put into the motion over the last step, J, to the step's accuracy;
  /// nothing where it is not known, of implicit steps under such forces, and of symplectic ones, whose energy
  /// swings within its own bound.
  std::optional<double> work() const;

  double start() const { return start_; }  ///< s: where the last step began
  const Compensated& state_at_start() const { return y0_; }

  /// The polynomial over the last step, as the state's distance from `state_at_start` with s = (t - start) /
  /// (time - start). Of order 7; made when first asked for after a step. Where shapes may touch and limits of
  /// joints be met, all coordinates have one.
  const StepPolynomial& polynomial();

  /// The state at a time within the last step, by its polynomial. `project` closes the joints there too.
  void at(double time, bool project, Compensated& out);

  /// Makes the last step end at `time`, within it, as a step of its own: with the method's own order.
  void cut(double time);

  /// Goes back to a time within the last step: what was found beyond it is forgotten.
  void rewind(double time);

  /// The state at `time`, to be changed; `restart` (or `start_anew`) is due afterwards.
  Compensated& change() { return y_; }
  /// After a jump of velocities or of forces: the next step begins from `change` as it is.
  void restart();
  /// After bodies were moved from outside: closes joints, and the length of steps is found anew.
  void start_anew();

  std::int64_t rejected() const { return rejected_; }
  std::int64_t implicit_steps() const { return implicit_steps_; }
  /// Steps that were carried over a singular place of the mechanism.
  std::int64_t leaps() const { return leaps_; }
  /// Joints some of whose rows follow from others at the start.
  const std::vector<std::string>& redundant_joints() const { return redundant_joints_; }

  /// Throws `Error` (Run) that names the body whose motion changes fastest.
  [[noreturn]] void blame_fastest() const;

  /// All that later steps and states from `sampled` on depend on.
  void save(double sampled, SnapshotWriter& out);
  void restore(SnapshotReader& in);

  double projection_nanoseconds = 0;  ///< spent closing joints, while `equations.cost.on`

 private:
  /// What explicit steps are made in: all coordinates, or angles alone where these say where all is.
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
  // Near places where closed linkages are singular (precise_smooth_passage.cpp).
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

  /// Steps that may err by `Precise::tolerance` together: each by one part of so many. Errors add up over
  /// thousands of steps and grow along chaotic motion; a method of order 8 pays 2.4 times the steps for these
  /// three digits.
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
  const bool ballistic_;  // but for contacts
  HangingTree hanging_;
  Coordinates all_, angles_;
  Radau implicit_;
  StiffMotion stiff_motion_;
  SymplecticMotion symplectic_;
  Passage passage_;
  StepControl control_;
  bool stiff_ = false, last_implicit_ = false;  // the next step is implicit; the last one was
  bool jumped_ = false;                         // since the last step
  bool last_flew_ = false;                      // the last step was a parabola
  int signs_of_stiffness_ = 0, steps_without_ = 0;
  double start_ = 0, time_ = 0;
  Compensated y0_, y_;                                  // where the last step began and ended
  bool polynomial_known_ = false, rate_known_ = false;  // of the last step; at its end
  double proposed_step_ = 0;                            // s; 0: none yet
  struct Rank {
    double weakest = 1;
    int dependent = 0;
  };
  Rank rank_at_start_;         // of the joints' rows, where the next step begins
  double weakest_before_ = 1;  // and where the last one did
  bool near_ = false;          // the next step is near a place where a closed linkage is singular
  bool last_near_ = false;     // the last one was
  bool expects_ = false;       // its passage is expected by the step before
  std::int64_t rejected_ = 0, implicit_steps_ = 0, leaps_ = 0;
};

}  // namespace plumb::precise
