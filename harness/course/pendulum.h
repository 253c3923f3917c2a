#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/course/lab.h"

/// Measures the period of a pendulum.
namespace plumb::course {

/// Returns the mean period between zero crossings, s; none if there are fewer than three.
std::optional<double> period_of(const std::vector<double>& zeros);

/// Returns the stiffness, N/m, of joints that give way as springs do, in proportion to the weight that hangs
/// on them; none if a joint gives way by the same distance under any weight, as one that is solved for does.
/// `hinge` selects a hinge instead of a stick.
std::optional<double> stiffness_of_joints(const Lab& lab, bool hinge);

/// Returns the description of joints that are springs.
std::string spring_text(double stiffness);

/// Returns the ratio of the period of a pendulum of `amplitude`, rad, to that of a small swing: 1/agm(1,
/// cos(amplitude/2)) (Gauss).
double period_ratio(double amplitude);

/// Returns the period from the times at which `angle_of` crosses zero, interpolated linearly between samples.
template <class AngleOf>
std::optional<double> period_of(const Trace& trace, const AngleOf& angle_of) {
  std::vector<double> zeros;
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    const double a = angle_of(trace.states[k - 1]), b = angle_of(trace.states[k]);
    if ((a > 0) != (b > 0))
      zeros.push_back(trace.times[k - 1] + (trace.times[k] - trace.times[k - 1]) * a / (a - b));
  }
  return period_of(zeros);
}

}  // namespace plumb::course
