#pragma once

#include <span>

namespace plumb {

/// An ordinary differential equation dy/dt = rate(t, y).
class Flow {
 public:
  virtual ~Flow() = default;
  virtual void rate(double time, std::span<const double> y, std::span<double> out) = 0;
  /// Returns the power of the flow's forces at the last `rate`, W: of those without a potential in the
  /// caller's energy balance.
  virtual double power() const { return 0; }
};

}  // namespace plumb
