#include "harness/sweep/rank_test.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace plumb::harness::sweep {
namespace {

// Returns twice the rank of each value among all, so that middle ranks are integers.
std::vector<int> doubled_ranks(std::span<const double> a, std::span<const double> b) {
  std::vector<double> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  std::vector<double> sorted = all;
  std::sort(sorted.begin(), sorted.end());
  std::vector<int> ranks;
  for (const double value : all) {
    const auto [low, high] = std::equal_range(sorted.begin(), sorted.end(), value);
    ranks.push_back(static_cast<int>((low - sorted.begin()) + (high - sorted.begin()) + 1));
  }
  return ranks;
}

}  // namespace

double rank_test(std::span<const double> a, std::span<const double> b) {
  a = a.first(std::min(a.size(), kMostRanked));
  b = b.first(std::min(b.size(), kMostRanked));
  if (a.empty() || b.empty()) return 1;
  const std::vector<int> ranks = doubled_ranks(a, b);
  int total = 0, observed = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    total += ranks[i];
    if (i < a.size()) observed += ranks[i];
  }
  // ways[k][s]: number of choices of k of the values seen so far whose doubled ranks sum to s.
  const auto width = static_cast<std::size_t>(total) + 1;
  std::vector<double> ways((a.size() + 1) * width, 0.0);
  ways[0] = 1;
  std::size_t seen = 0;
  for (const int rank : ranks) {
    ++seen;
    for (std::size_t k = std::min(seen, a.size()); k >= 1; --k)
      for (std::size_t s = width - 1; s >= static_cast<std::size_t>(rank); --s)
        ways[k * width + s] += ways[(k - 1) * width + s - static_cast<std::size_t>(rank)];
  }
  // Compares distances from the expected sum, multiplied by the number of values so that they are integers.
  const long count = static_cast<long>(ranks.size());
  const long expected = static_cast<long>(total) * static_cast<long>(a.size());
  const long distance = std::labs(static_cast<long>(observed) * count - expected);
  double as_far = 0, all = 0;
  for (std::size_t s = 0; s < width; ++s) {
    const double number = ways[a.size() * width + s];
    all += number;
    if (std::labs(static_cast<long>(s) * count - expected) >= distance) as_far += number;
  }
  return as_far / all;
}

}  // namespace plumb::harness::sweep
