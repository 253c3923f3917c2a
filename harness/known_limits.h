#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumb::harness {

/// Bounds that an engine is known to miss, and why. Declared for the default settings at dt = 1/60. In each
/// pattern '*' matches anything and '|' separates alternatives. Every check that the patterns cover must miss
/// its bound.
struct KnownLimit {
  std::string_view engine;    ///< "box2d", "bullet*"
  std::string_view instance;  ///< labels: "pendulum_chain[20]|pendulum_chain[100]"
  std::string_view check;     ///< names of checks
  std::string_view reason;
  bool elsewhere_only = false;  ///< for settings other than the default ones
};

/// Returns all known limits; they are declared nowhere else.
std::span<const KnownLimit> known_limits();

/// Returns the first limit that covers this check at the default settings (`defaults`) or at others; null if
/// none does.
const KnownLimit* find_known_limit(std::span<const KnownLimit> limits, std::string_view engine,
                                   std::string_view instance, std::string_view check, bool defaults);

/// Returns true if `text` matches one of the alternatives in `pattern`.
bool matches(std::string_view pattern, std::string_view text);

}  // namespace plumb::harness
