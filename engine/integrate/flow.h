#pragma once

#include <span>

namespace plumb {

/// An ordinary differential equation dy/dt = rate(t, y).
class Flow {
 public:
  virtual ~Flow() = default;
  virtual void rate(double time, std::span<const double> y, std::span<double> out) = 0;
  /// What the flow's forces put into the motion at the last `rate`, W: those that have no potential of their
  /// own in the account of who asks.
  virtual double power() const { return 0; }
};

}  // namespace plumb
