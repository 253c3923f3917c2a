#pragma once

#include <span>

namespace plumb::harness::sweep {

/// The two-sided Wilcoxon-Mann-Whitney test: how likely two samples that come from one distribution stand as
/// unevenly in their common order as `a` and `b` do, or more so. Exact, with ties at their middle ranks: the
/// share of all divisions of the common order into two such groups whose rank sum is at least as far from the
/// middle. Of longer samples the first `kMostRanked` take part. 1 where one is empty.
double rank_test(std::span<const double> a, std::span<const double> b);

inline constexpr std::size_t kMostRanked = 50;

}  // namespace plumb::harness::sweep
