#include "harness/reality/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace plumb::harness::reality {
namespace {

constexpr int kBootstraps = 1000;
/// Quantiles between which 95 % of the samples lie.
constexpr double kLow = 0.025, kHigh = 0.975;

std::size_t below(std::mt19937_64& random, std::size_t count) { return random() % count; }

}  // namespace

Halves halves_of(std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 random(seed);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[below(random, i)]);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(count / 2);
  Halves out{{order.begin(), middle}, {middle, order.end()}};
  std::sort(out.train.begin(), out.train.end());
  std::sort(out.test.begin(), out.test.end());
  return out;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), below, values.end());
  const double low = *below;
  if (below + 1 == values.end()) return low;
  const double high = *std::min_element(below + 1, values.end());
  return low + (place - std::floor(place)) * (high - low);
}

double middle_mean(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto quarter = static_cast<std::ptrdiff_t>(values.size() / 4);
  std::nth_element(values.begin(), values.begin() + quarter, values.end());
  std::nth_element(values.begin() + quarter, values.end() - quarter - 1, values.end());
  const double sum = std::accumulate(values.begin() + quarter, values.end() - quarter, 0.0);
  return sum / static_cast<double>(values.end() - values.begin() - 2 * quarter);
}

Estimate interval_of(double value, const std::vector<double>& found) {
  return {value, quantile(found, kLow), quantile(found, kHigh)};
}

Estimate ratio(std::span<const double> values, std::span<const double> others, double share,
               std::uint64_t seed) {
  const auto quotient = [share](std::vector<double> some, std::vector<double> all) {
    return quantile(std::move(some), share) / quantile(std::move(all), share);
  };
  std::vector<double> drawn(values.size()), drawn_others(values.size()), found;
  std::mt19937_64 random(seed);
  for (int i = 0; i < kBootstraps && !values.empty(); ++i) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::size_t pair = below(random, values.size());
      drawn[k] = values[pair], drawn_others[k] = others[pair];
    }
    found.push_back(quotient(drawn, drawn_others));
  }
  return interval_of(quotient({values.begin(), values.end()}, {others.begin(), others.end()}), found);
}

std::vector<std::size_t> resample(std::size_t count, std::uint64_t seed, std::uint64_t number) {
  std::seed_seq sequence{seed, number};
  std::mt19937_64 random(sequence);
  std::vector<std::size_t> out(count);
  for (std::size_t& index : out) index = below(random, count);
  return out;
}

Estimate estimate(std::span<const double> values, double share, std::uint64_t seed) {
  std::vector<double> drawn(values.size()), found;
  std::mt19937_64 random(seed);
  for (int i = 0; i < kBootstraps && !values.empty(); ++i) {
    for (double& value : drawn) value = values[below(random, values.size())];
    found.push_back(quantile(drawn, share));
  }
  return interval_of(quantile({values.begin(), values.end()}, share), found);
}

}  // namespace plumb::harness::reality
