#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumb {

/// Returns the candidate that `name` most likely stands for: the one with the fewest insertions, deletions,
/// replacements and transpositions, ignoring case. Empty if none is near.
std::string nearest(std::string_view name, std::span<const std::string> candidates);

/// Returns "; did you mean 'x'?", to be appended to a problem. When no candidate is near, lists all of them
/// if they are few; otherwise returns nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace plumb
