#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/integrate/flow.h"
#include "engine/integrate/step_polynomial.h"
#include "engine/precise/dynamics/motion.h"

namespace plumb::precise {

/// Passes a closed linkage through a kinematic singularity, where joints' rows become dependent (a four-bar
/// that lies in one line) and two branches of its manifold cross. The motion along its own branch is smooth
/// there, but the equations of motion are not: at a distance d off the manifold, and s from the crossing,
/// accelerations have errors of d / s. So this flow is dy/dt = f(P(y)), with f the equations of motion and P
/// the nearest point on the branch. It is as smooth as the branch: a step with stages on both sides of the
/// crossing keeps its order. The motion so far selects the branch: P starts from its extrapolated polynomial.
class SingularityPassage final : public Flow {
 public:
  explicit SingularityPassage(EquationsOfMotion& equations);

  /// Sets the expected motion: the extrapolated step from `start` to `end`, with y at its beginning.
  void set_expected(const StepPolynomial& path, double start, double end, std::span<const double> y);
  /// Sets the expected motion from y at `time` by the rates there.
  void set_expected(double time, std::span<const double> y, std::span<const double> rate);

  /// Finds the next crossing on the expected motion, after `from` and up to `to`. The branches meet (`meets`)
  /// unless lengths differ by more than rounding: then they approach each other and turn away.
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
  double minimum_between(double low, double high);

  EquationsOfMotion& equations_;
  StepPolynomial path_;
  double start_ = 0, length_ = 1;  // s, along the path
  std::vector<double> base_, expected_, nearest_;
};

}  // namespace plumb::precise
