#pragma once

namespace plumb {

/// A number as the unevaluated sum of two: `tail` is what rounding removed from `value`.
struct DoubleDouble {
  double value = 0, tail = 0;
};

}  // namespace plumb
