#pragma once

#include <span>

namespace plumb::harness::sweep {

/// Computes the two-sided Wilcoxon-Mann-Whitney test. Returns the probability that two samples of one
/// distribution are ranked at least as unevenly as `a` and `b`. The test is exact, with ties at their middle
/// ranks. Consider all divisions of the combined ranking into two groups of these sizes: the result is the
/// fraction of them whose rank sum is at least as far from the expected one. Only the first `kMostRanked`
/// values of each sample count. Returns 1 if a sample is empty.
double rank_test(std::span<const double> a, std::span<const double> b);

inline constexpr std::size_t kMostRanked = 50;

}  // namespace plumb::harness::sweep
