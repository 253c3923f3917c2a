#include <algorithm>
#include <cmath>

#include "engine/precise/sensitivity/sensitivities.h"

// Derivatives of the laws, as differences of fourth order.
namespace plumb::precise {
namespace {

/// Fraction of the derivative by which differences of two widths may disagree before a function counts as
/// kinked. A kink gives a disagreement of the order of one, smooth functions of the fourth power of the step.
constexpr double kKink = 1e-5;
/// Number of times that the step of a difference along a state is reduced so that it stays on one side of a
/// nearby kink.
constexpr int kReductions = 4;
constexpr double kReduction = 0.1;

}  // namespace

/// Derives a function of the scene's own laws along a direction, at `from`. Keeps the function's values in
/// `values_`. Returns one step as a fraction of the direction.
double Sensitivities::differentiate_state(const Function& function, const Point& from, const Direction& along,
                                          std::span<double> out, double step) {
  std::fill(out.begin(), out.end(), 0.0);
  const double size = std::max(norm(along.state), std::abs(along.time) / time_scale_);
  if (!(size > 0)) return 0;
  const double width = step / size;
  at_.resize(along.state.size());
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const double share = Variation::kOffsets[k] * width;
    for (std::size_t i = 0; i < at_.size(); ++i) at_[i] = from.y[i] + share * along.state[i];
    values_[k].resize(out.size());
    function(*own_, from.time + share * along.time, at_, values_[k]);
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = (values_[0][i] - values_[3][i] + 8 * (values_[2][i] - values_[1][i])) / (12 * width);
  return width;
}

/// Derives a function by a parameter, at `from`.
void Sensitivities::differentiate_parameter(std::size_t parameter, const Function& function,
                                            const Point& from, std::span<double> out) {
  for (std::size_t k = 0; k < values_.size(); ++k) {
    values_[k].resize(out.size());
    function(*perturbed_[parameter][k], from.time, from.y, values_[k]);
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = (values_[0][i] - values_[3][i] + 8 * (values_[2][i] - values_[1][i])) / (12 * steps_[parameter]);
}

/// Derives a function along a direction and by a parameter together, at the current state. Returns false if
/// the function has a kink there. For a smooth function, second differences of two widths have a ratio of
/// four; at a kink they have not.
bool Sensitivities::differentiate(std::size_t parameter, const Function& function, const Direction& along,
                                  std::span<const double> scale, std::span<double> out) {
  middle_.resize(out.size());
  part_.resize(out.size());
  function(*own_, now_.time, now_.y, middle_);
  // In units of `scale`: the largest derivative, and the remainder due to a kink.
  const auto is_smooth = [&](std::span<const double> derivative, double width, double least) {
    double largest = least, kink = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double near = values_[1][i] + values_[2][i] - 2 * middle_[i];
      const double far = values_[0][i] + values_[3][i] - 2 * middle_[i];
      largest = std::max(largest, std::abs(derivative[i]) / scale[i]);
      kink = std::max(kink, std::abs(2 * near - 0.5 * far) / (width * scale[i]));
      if (!std::isfinite(derivative[i])) return false;
    }
    return kink <= kKink * largest;
  };
  std::fill(out.begin(), out.end(), 0.0);
  const double size = std::max(norm(along.state), std::abs(along.time) / time_scale_);
  if (size > 0) {
    double step = Variation::kStep;
    for (int i = 0;; ++i, step *= kReduction) {
      const double width = differentiate_state(function, present(), along, out, step);
      if (is_smooth(out, width, size)) break;
      if (i == kReductions) return false;
    }
  }
  if (initial_only_[parameter]) return true;
  differentiate_parameter(parameter, function, present(), part_);
  if (!is_smooth(part_, steps_[parameter], Variation::kStep / steps_[parameter])) return false;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += part_[i];
  return true;
}

}  // namespace plumb::precise
