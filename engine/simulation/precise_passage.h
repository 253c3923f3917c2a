#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/integrate/flow.h"
#include "engine/integrate/step_polynomial.h"
#include "engine/simulation/precise_motion.h"

namespace plumb::precise {

/// A closed linkage on its way through a place where it is singular: where joints' rows depend on each other
/// (a four-bar that lies in one line), two branches of its manifold cross. The motion along its own branch is
/// smooth there, but the equations of motion are not: off the manifold by d, at a distance s from the
/// crossing, accelerations are off by d / s. As a flow this is
///   dy/dt = f(P(y)),
/// f the equations of motion and P the nearest place on the branch, which is as smooth as the branch itself:
/// a step whose stages lie on either side of the crossing keeps its order. Which branch is the one, the
/// motion so far says: P starts from its polynomial carried on.
class Passage final : public Flow {
 public:
  explicit Passage(EquationsOfMotion& equations);

  /// The motion is expected to go on as over the step from `start` to `end`, with y where that began.
  void expect(const StepPolynomial& path, double start, double end, std::span<const double> y);
  /// Or from y at `time` by the rates there.
  void expect(double time, std::span<const double> y, std::span<const double> rate);

  /// Where the expected motion passes a crossing next, from `from` (alone) to `to`. It `meets` there unless
  /// lengths differ by more than rounding: then its branches come near, and turn away from each other.
  struct Crossing {
    double time = 0;
    bool meets = true;
  };
  std::optional<Crossing> crossing(double from, double to);

  void rate(double time, std::span<const double> y, std::span<double> out) override;
  double power() const override { return equations_.power(); }

 private:
  std::span<const double> expected(double time);
  double strength(double time);
  double least_between(double low, double high);

  EquationsOfMotion& equations_;
  StepPolynomial path_;
  double start_ = 0, length_ = 1;  // s, of the path
  std::vector<double> base_, at_, place_;
};

}  // namespace plumb::precise
