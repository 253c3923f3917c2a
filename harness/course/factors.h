#pragma once

#include <string>

/// Names the factors by which a learner's quantity may be wrong.
namespace plumb::course {

/// Returns a factor as text: as dt or 1/dt if it equals one of these, which is more informative than a
/// number.
std::string factor_text(double factor, double dt);

/// Returns the plain number that a fitted factor stands for: dt, a whole number, degrees in a radian, or the
/// inverse of one of these; otherwise the factor.
double plain_factor(double factor, double dt);

}  // namespace plumb::course
