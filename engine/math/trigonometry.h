#pragma once

#include "engine/math/vec2.h"

namespace plumb {

/// Returns the rotation by `angle`, in rad: cosine and sine to about 1 unit in the last place at any finite
/// angle. They have the same bits on every platform (libm's differ by CPU). NaN for an angle that is not
/// finite. Exists for float and double.
template <class Real>
Rotation<Real> rotation_of(Real angle);

template <>
Rotation<float> rotation_of(float angle);
template <>
Rotation<double> rotation_of(double angle);

}  // namespace plumb
