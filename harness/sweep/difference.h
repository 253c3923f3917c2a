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
};

std::string_view name_of(Verdict verdict);

/// Below this a rank test says little.
inline constexpr std::size_t kEnough = 9;
/// The chance that any cost of a comparison is called better or worse although nothing changed.
inline constexpr double kChance = 0.05;

/// A figure of a run that is not the same as before, bit for bit.
struct MetricChange {
  const MetricField* metric = nullptr;
  std::optional<double> before, after;

  bool better() const { return before && after ? *after < *before : after.has_value(); }
};

/// One run, as two sets of results have it.
struct Difference {
  std::string label, engine, settings;
  std::optional<Status> before, after;  ///< absent: not among these results
  std::vector<MetricChange> errors{};
  Verdict cost = Verdict::Unknown;
  double cost_before = 0, cost_after = 0;  ///< ns a step, medians
  double chance = 1;                       ///< of the rank test, before it is held against all others
  std::size_t repetitions = 0;             ///< the smaller number of the two
};

/// Runs that were asked for the same, in the order of `before`, then what only `after` has. Costs by a rank
/// test of the repetitions, at `kChance` over all of them together (Holm 1979).
std::vector<Difference> differences(std::span<const Result> before, std::span<const Result> after);

/// Whether anything is worse: an error, a cost, or a run that was ok and is not any more.
bool any_worse(std::span<const Difference> rows);

/// What changed, worse first, and how many are of each kind.
std::string difference_table(std::span<const Difference> rows, const Style& style);
std::string difference_json(std::span<const Difference> rows);
std::string difference_csv(std::span<const Difference> rows);

}  // namespace plumb::harness::sweep
