#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace plumb::harness::reality {

/// A statistic of a sample, and the interval that contains 95 % of its bootstrap values.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// A random half of 0 .. count - 1, and the other half. The same on every machine for one seed.
struct Halves {
  std::vector<std::size_t> train, test;
};
Halves halves_of(std::size_t count, std::uint64_t seed);

/// Returns the quantile `share` (0..1) of `values`, interpolated linearly between two of them. NaN if there
/// are none.
double quantile(std::vector<double> values, double share);

/// Returns the mean of the middle half. It ignores outliers as the median does, and does not jump from one
/// value to the next when all values change a little. NaN if there are none.
double middle_mean(std::vector<double> values);

/// Returns a value with the interval that holds 95 % of its bootstrap values.
Estimate interval_of(double value, const std::vector<double>& found);

/// Returns the quantile with its interval, percentiles 2.5 and 97.5 of 1000 bootstrap samples. Source: Efron
/// and Tibshirani, An Introduction to the Bootstrap (1993), 13.3.
Estimate estimate(std::span<const double> values, double share, std::uint64_t seed);

/// Returns the quantile of `values` divided by that of `others`, whose elements belong together pair by pair,
/// with its interval from bootstrap samples of pairs.
Estimate ratio(std::span<const double> values, std::span<const double> others, double share,
               std::uint64_t seed);

/// Returns `count` numbers below `count`, drawn with replacement: bootstrap sample `number` of a seed.
std::vector<std::size_t> resample(std::size_t count, std::uint64_t seed, std::uint64_t number);

}  // namespace plumb::harness::reality
