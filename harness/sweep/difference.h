#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/metrics.h"
#include "harness/result.h"
#include "harness/style.h"

namespace plumb::harness::sweep {

enum class Verdict {
  Better,
  Worse,
  CannotTell,  ///< the noise hides it
  TooFew,      ///< fewer than `kEnough` repetitions
  Unknown,     ///< not measured on both sides
  Elsewhere,   ///< measured on different kinds of machine
};

std::string_view name_of(Verdict verdict);

/// Least number of repetitions; with fewer, a rank test has little power.
inline constexpr std::size_t kEnough = 9;
/// Probability that any cost of a comparison is called better or worse although nothing changed.
inline constexpr double kChance = 0.05;

/// A figure of a run that differs from before, bit for bit.
struct MetricChange {
  const MetricField* metric = nullptr;
  std::optional<double> before, after;

  bool better() const { return before && after ? *after < *before : after.has_value(); }
};

/// One run in both sets of results.
struct Difference {
  std::string label, engine, settings;
  std::optional<Status> before, after;  ///< absent: not in these results
  std::vector<MetricChange> errors{};
  Verdict cost = Verdict::Unknown;
  double cost_before = 0, cost_after = 0;  ///< ns a step, medians
  double chance = 1;            ///< p-value of the rank test, before the correction for multiple tests
  std::size_t repetitions = 0;  ///< the smaller number of repetitions of the two
};

/// Compares runs with the same requested settings, in the order of `before`, then those only in `after`.
/// Costs are compared by a rank test of the repetitions, with family-wise chance `kChance` over all of them
/// (Holm 1979).
std::vector<Difference> differences(std::span<const Result> before, std::span<const Result> after);

/// Returns true if anything is worse: an error, a cost, or a run that was ok before and is not now.
bool any_worse(std::span<const Difference> rows);

/// Returns true if every run is in both, ended alike, and has the same bits in every error.
bool all_same(std::span<const Difference> rows);

/// Formats the changes, worse first, with the number of each kind.
std::string difference_table(std::span<const Difference> rows, const Style& style);
std::string difference_json(std::span<const Difference> rows);
std::string difference_csv(std::span<const Difference> rows);

}  // namespace plumb::harness::sweep
