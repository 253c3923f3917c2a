#pragma once

#include <functional>
#include <string>

namespace plumb::harness::thresholds {

/// Range and resolution of a search for a critical value.
struct SearchRange {
  double low = 0, high = 1;
  bool logarithmic = false;  ///< bisects on a logarithmic scale; requires low > 0
  bool holds_below = true;   ///< true if the scene holds below the critical value
  double resolution = 1e-3;  ///< width of the last bracket, as a fraction of its middle
};

/// Outcome of a run at one value.
struct Answer {
  bool holds = false;
  std::string why{};  ///< description of the failure, a short sentence
};

/// Ending of a search.
enum class Ending {
  Found,    ///< one crossing, and the samples beside it agree
  Always,   ///< holds over the whole range
  Never,    ///< holds nowhere in the range
  Unclear,  ///< the answer changes more than once
};

/// A search's result. `low` and `high` are the bracket; if the answer is unclear, the first and last value
/// between which answers are mixed; otherwise the range.
struct Crossing {
  Ending ending = Ending::Never;
  double value = 0;  ///< middle of the last bracket of the bisection; NaN if there is none
  double low = 0, high = 0;
  int runs = 0;
  std::string reason{};  ///< failure at the nearest value that does not hold, or the contradicting answers
};

/// Finds the value at which `ask` changes from true to false. Asks seven values over the range, bisects the
/// first change from the holding side, then asks at 3, 10 and 30 resolutions on both sides. Asks at most
/// `kMostRuns` times, whatever the answers. Throws what `ask` throws.
Crossing find_crossing(const SearchRange& range, const std::function<Answer(double)>& ask);

inline constexpr int kMostRuns = 80;

}  // namespace plumb::harness::thresholds
