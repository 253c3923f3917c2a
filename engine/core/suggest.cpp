#include "engine/core/suggest.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "engine/core/text.h"

namespace plumb {
namespace {

/// Limit of the length of compared names: longer names are never typing errors of each other.
constexpr std::size_t kMaxNameLength = 200;

/// Maximum number of names to list in a sentence.
constexpr std::size_t kMaxListed = 12;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool same(char a, char b) { return lower(a) == lower(b); }

/// Returns the distance of optimal string alignment: Levenshtein's, with transpositions of neighbours.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1])) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

/// Returns true if at most a third of the letters are wrong, and fewer than all of the shorter name.
bool is_near(std::size_t wrong, std::size_t shorter, std::size_t longer) {
  return wrong < shorter && wrong <= (longer + 2) / 3;
}

}  // namespace

std::string nearest(std::string_view name, std::span<const std::string> candidates) {
  const std::string* best = nullptr;
  std::size_t fewest = 0;
  for (const std::string& candidate : candidates) {
    const auto [shorter, longer] = std::minmax({name.size(), candidate.size()});  // by value
    if (longer > kMaxNameLength || !is_near(longer - shorter, shorter, longer)) continue;
    const std::size_t wrong = distance(name, candidate);
    if (!is_near(wrong, shorter, longer) || (best != nullptr && wrong >= fewest)) continue;
    best = &candidate;
    fewest = wrong;
  }
  return best == nullptr ? std::string() : *best;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> candidates) {
  const std::string meant = nearest(name, candidates);
  if (!meant.empty()) return "; did you mean " + quoted(meant) + "?";
  if (candidates.empty() || candidates.size() > kMaxListed) return "";
  std::string all;
  for (const std::string& candidate : candidates) all += (all.empty() ? "" : ", ") + candidate;
  return "; there are " + all;
}

}  // namespace plumb
