#pragma once

namespace plumb {

/// Returns the angle of the vector (x, y) from the x axis, in rad, in [-pi, pi]. Accurate to about 1 unit in
/// the last place, with the same bits on every platform (libm's differ). Zeros and infinities as in C's
/// atan2; NaN for NaN.
double arc_tangent(double y, double x);

}  // namespace plumb
