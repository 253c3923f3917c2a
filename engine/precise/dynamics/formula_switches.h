#pragma once

#include <vector>

#include "engine/scene/formula.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// The times at which steps must end because of a scene's formulas of time (forces, paths, speeds of motors).
///
/// *Pieces*: a corner of a table, or the start of a pulse `t > 1 && t < 1.01 ? 5 : 0`. A step beyond it would
/// not resolve it, or miss the piece between its evaluations. They are found by evaluating formulas over
/// intervals of time (`Formula::survey`), which are halved until no decision changes within them. Pieces that
/// last less than 1e-9 s (relative to the time, after 1 s) may be missed.
///
/// *Quiet times*: a formula that hardly changes for long, such as `exp(-((t-5)/0.01)^2)`, does not limit the
/// step, which would pass its rise and fall. A step ends before the formula may leave the values that it has
/// at the step's ends, unless it is busy most of the time.
class FormulaSwitches {
 public:
  explicit FormulaSwitches(const Scene& scene);

  /// Returns the time after `time`, s, at which a step must end; infinity without such formulas. Times within
  /// the last interval get its end, whatever `time`.
  double next(double time);

  // The last interval is part of a run's state.
  double after() const { return after_; }
  double end() const { return end_; }
  void restore(double after, double end) { after_ = after, end_ = end; }

 private:
  struct Entry {
    Formula formula;
    bool of_time_alone = false;
  };
  std::vector<Entry> formulas_;
  double after_ = 0, end_ = 0;  // s, the last interval; empty before the first search
};

}  // namespace plumb::precise
