#include "engine/precise/event_search/zero_crossing.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace plumb::precise {
namespace {

class MonitoredFunctions {
 public:
  MonitoredFunctions(const std::function<void(double, std::span<double>)>& evaluate,
                     std::span<const double> tolerance)
      : evaluate_(evaluate), tolerance_(tolerance), scratch_(tolerance.size()) {}

  /// Returns the values with the tolerance added: an event is where one is negative.
  std::vector<double> at(double time) {
    evaluate_(time, scratch_);
    std::vector<double> values = scratch_;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += tolerance_[i];
    return values;
  }
  double at(double time, std::size_t index) {
    evaluate_(time, scratch_);
    return scratch_[index] + tolerance_[index];
  }

  /// Returns the root of a function that is not negative at `low` and negative at `high`: the end of the
  /// final bracket at which the function is negative.
  double locate(std::size_t index, double low, double f_low, double high, double f_high) {
    assert(low <= high && f_low >= 0 && f_high < 0);
    int side = 0;
    for (int i = 0; i < 100; ++i) {
      double next = f_low > f_high ? low + (high - low) * (f_low / (f_low - f_high)) : 0.5 * (low + high);
      if (i % 4 == 3) next = 0.5 * (low + high);
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (!(next > low && next < high)) break;
      const double f = at(next, index);
      if (f < 0) {
        high = next;
        f_high = f;
        if (side == -1) f_low *= 0.5;
        side = -1;
      } else {
        low = next;
        f_low = f;
        if (side == 1) f_high *= 0.5;
        side = 1;
      }
    }
    return high;
  }

 private:
  const std::function<void(double, std::span<double>)>& evaluate_;
  std::span<const double> tolerance_;
  std::vector<double> scratch_;
};

struct Sample {
  double time = 0;
  std::vector<double> values;
};

/// Returns the time of the minimum of the parabola through three samples, if it lies between them and is at
/// most a third of each of them.
std::optional<double> interior_minimum(const Sample& a, const Sample& b, const Sample& c, std::size_t i) {
  const double fa = a.values[i], fb = b.values[i], fc = c.values[i];
  if (fb < 0) return std::nullopt;
  const double h = 0.5 * (c.time - a.time), slope = (fc - fa) / (2 * h), curve = (fa - 2 * fb + fc) / (h * h);
  if (!(curve > 0)) return std::nullopt;
  const double lowest = fb - 0.5 * slope * slope / curve;
  const double time = b.time - slope / curve;
  if (!(time > a.time && time < c.time) || lowest > std::min({fa, fb, fc}) / 3) return std::nullopt;
  return time;
}

}  // namespace

std::optional<ZeroCrossing> first_zero_crossing(
    const std::function<void(double, std::span<double>)>& evaluate, std::span<const double> tolerance,
    double start, double end, int samples) {
  if (tolerance.empty()) return std::nullopt;
  assert(start <= end && samples > 0);
  MonitoredFunctions functions(evaluate, tolerance);
  std::vector<Sample> known{{start, functions.at(start)}};
  std::optional<ZeroCrossing> first;
  const auto check_interval = [&](const Sample& low, const Sample& high) {
    for (std::size_t i = 0; i < tolerance.size(); ++i) {
      if (!(high.values[i] < 0)) continue;
      const double from = std::max(low.values[i], 0.0);
      const double time = functions.locate(i, low.time, from, high.time, high.values[i]);
      if (!first || time < first->time) first = ZeroCrossing{time, i};
    }
  };
  for (int s = 1; s <= samples && !first; ++s) {
    const double time = s == samples ? end : start + (end - start) * s / samples;
    known.push_back({time, functions.at(time)});
    const std::size_t n = known.size();
    if (n >= 3) {
      for (std::size_t i = 0; i < tolerance.size(); ++i) {
        const auto lowest = interior_minimum(known[n - 3], known[n - 2], known[n - 1], i);
        if (!lowest) continue;
        const Sample there{*lowest, functions.at(*lowest)};
        check_interval(*lowest < known[n - 2].time ? known[n - 3] : known[n - 2], there);
      }
    }
    check_interval(known[n - 2], known[n - 1]);
  }
  return first;
}

}  // namespace plumb::precise
