#include "harness/known_limits.h"

#include <array>

namespace plumb::harness {
namespace {

constexpr std::array<KnownLimit, 0> kLimits{};

bool matches_one(std::string_view pattern, std::string_view text) {
  if (pattern.empty()) return text.empty();
  if (pattern.front() != '*') {
    return !text.empty() && text.front() == pattern.front() && matches_one(pattern.substr(1), text.substr(1));
  }
  for (std::size_t skip = 0; skip <= text.size(); ++skip)
    if (matches_one(pattern.substr(1), text.substr(skip))) return true;
  return false;
}

}  // namespace

std::span<const KnownLimit> known_limits() { return kLimits; }

bool matches(std::string_view pattern, std::string_view text) {
  while (true) {
    const std::size_t bar = pattern.find('|');
    if (matches_one(pattern.substr(0, bar), text)) return true;
    if (bar == std::string_view::npos) return false;
    pattern.remove_prefix(bar + 1);
  }
}

const KnownLimit* find_known_limit(std::span<const KnownLimit> limits, std::string_view engine,
                                   std::string_view instance, std::string_view check) {
  for (const KnownLimit& limit : limits)
    if (matches(limit.engine, engine) && matches(limit.instance, instance) && matches(limit.check, check))
      return &limit;
  return nullptr;
}

}  // namespace plumb::harness
