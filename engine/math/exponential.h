#pragma once

namespace plumb {

/// Returns e to the power `x`, and the natural logarithm of `x`, each to about 1 unit in the last place, with
/// the same bits on every platform (libm's differ). Overflow, zeros, infinities and NaN as in C's exp and
/// log.
double exponential(double x);
double logarithm(double x);

/// Returns `base` to the power `exponent`. Whole exponents up to 64 are products. Other powers are
/// exp(exponent ln base), with a relative error of about |exponent ln base| times that of a rounding; NaN for
/// a negative base.
double power(double base, double exponent);

}  // namespace plumb
