#pragma once

#include <functional>
#include <string>

namespace plumb::harness::thresholds {

/// Where a critical value is looked for.
struct SearchRange {
  double low = 0, high = 1;
  bool logarithmic = false;  ///< halves ratios instead of differences; then low > 0
  bool holds_below = true;   ///< which side of the critical value holds
  double resolution = 1e-3;  ///< width of the last bracket relative to its middle
};

/// What one value gave.
struct Answer {
  bool holds = false;
  std::string why{};  ///< what broke, as a short sentence
};

/// How a search ended.
enum class Ending {
  Found,    ///< one crossing, and what was sampled beside it agrees
  Always,   ///< held over the whole range
  Never,    ///< held nowhere in the range
  Unclear,  ///< the answer changes more than once
};

/// A search's result. `low` and `high`: the bracket; where it is unclear, from the first value to the last
/// between which answers are mixed; else the range.
struct Crossing {
  Ending ending = Ending::Never;
  double value = 0;  ///< the middle of the bracket that bisection ended with; NaN where there is none
  double low = 0, high = 0;
  int runs = 0;
  std::string reason{};  ///< what breaks at the nearest value that does not hold, or what contradicts what
};

/// Finds where `ask` changes from true to false: seven values over the range, bisection where the first
/// change from the holding side is, then values at 3, 10 and 30 times the resolution on both sides. At most
/// `kMostRuns` questions, whatever the answers. Throws what `ask` throws.
Crossing find_crossing(const SearchRange& range, const std::function<Answer(double)>& ask);

inline constexpr int kMostRuns = 80;

}  // namespace plumb::harness::thresholds
