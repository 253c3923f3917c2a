#include "engine/precise/integration/passage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace plumb::precise {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Independent fraction of a row below which it counts as dependent, because the branches are too close to
/// distinguish. An expected motion that passes a crossing comes closer than that.
constexpr double kDependent = 1e-7;
/// Allowed gap of a linkage at a crossing, in roundings of the scene's extent. If the gap is wider, the
/// branches do not meet: they approach each other and turn away, fast but smoothly.
constexpr double kRoundings = 16;
/// Number of samples along the expected motion.
constexpr int kPathSamples = 24;

}  // namespace

SingularityPassage::SingularityPassage(EquationsOfMotion& equations)
    : equations_(equations),
      path_(equations.dimension()),
      base_(equations.dimension()),
      expected_(equations.dimension()),
      nearest_(equations.dimension()) {}

void SingularityPassage::set_expected(const StepPolynomial& path, double start, double end,
                                      std::span<const double> y) {
  path_ = path;
  start_ = start, length_ = end - start;
  std::copy(y.begin(), y.end(), base_.begin());
}

void SingularityPassage::set_expected(double time, std::span<const double> y, std::span<const double> rate) {
  path_.set_nodes(std::array{0.0, 0.0});
  start_ = time, length_ = 1;
  std::copy(y.begin(), y.end(), base_.begin());
  for (std::size_t i = 0; i < y.size(); ++i) {
    path_.term(1)[i] = rate[i];
    path_.term(2)[i] = i % EquationsOfMotion::kPerBody < 3 ? 0.5 * rate[i + 3] : 0;
  }
}

std::span<const double> SingularityPassage::expected(double time) {
  const double s = (time - start_) / length_;
  for (std::size_t i = 0; i < base_.size(); ++i) expected_[i] = base_[i] + path_.at(s, i);
  return expected_;
}

/// Returns a measure proportional to the distance from a crossing: the weakness of rows is its square.
double SingularityPassage::strength(double time) {
  return std::sqrt(equations_.min_pivot_ratio_at(time, expected(time)));
}

/// Minimises by golden-section search, to a millionth of the interval.
double SingularityPassage::minimum_between(double low, double high) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kMaxIterations = 32;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = strength(a), at_b = strength(b);
  for (int i = 0; i < kMaxIterations; ++i) {
    if (at_a == 0 && at_b == 0) return 0.5 * (a + b);
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      a = high - kGolden * (high - low), at_a = strength(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + kGolden * (high - low), at_b = strength(b);
    }
  }
  return at_a < at_b ? a : b;
}

std::optional<SingularityPassage::Crossing> SingularityPassage::crossing(double from, double to) {
  double times[3] = {from, from, from}, values[3] = {strength(from), 0, 0};
  values[1] = values[2] = values[0];
  for (int k = 1; k <= kPathSamples; ++k) {
    times[0] = times[1], values[0] = values[1];
    times[1] = times[2], values[1] = values[2];
    times[2] = from + (to - from) * k / kPathSamples;
    values[2] = strength(times[2]);
    // A sample that is not larger than its neighbours is next to a minimum. A minimum between the first two
    // samples has only one neighbour.
    const bool low = k == 1 ? values[1] <= values[2] : values[1] <= values[2] && values[1] <= values[0];
    if (!low) continue;
    const double time = minimum_between(times[0], times[2]);
    const double weak = strength(time) * strength(time);
    if (weak > kDependent || (k == 1 && !(weak < 0.25 * values[0] * values[0]))) continue;
    const std::span<const double> state = expected(time);
    std::copy(state.begin(), state.end(), nearest_.begin());
    const double open = equations_.remaining_gap(time, nearest_, 10 * kDependent);
    const double closed = kRoundings * equations_.rounding_of_gaps();
    return Crossing{time, open <= closed};
  }
  return std::nullopt;
}

void SingularityPassage::rate(double time, std::span<const double> y, std::span<double> out) {
  constexpr int kMaxIterations = 30;
  const std::span<const double> from = expected(time);
  std::copy(from.begin(), from.end(), nearest_.begin());
  const double enough = 4 * kEpsilon * equations_.length();
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxIterations; ++i) {
    const double moved = equations_.newton_step_towards(time, y, nearest_);
    if (!(moved <= 1e10)) break;
    if (moved <= enough || (moved > 0.5 * before && moved <= 1e-10 * equations_.length())) {
      for (std::size_t k = 0; k < nearest_.size(); ++k) {
        if (k % EquationsOfMotion::kPerBody >= 3) nearest_[k] = y[k];
      }
      equations_.project_velocities(time, nearest_);
      equations_.rate_with_rows(time, nearest_, out);
      return;
    }
    before = moved;
  }
  std::fill(out.begin(), out.end(), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace plumb::precise
