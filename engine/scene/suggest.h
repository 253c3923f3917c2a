#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumb {

/// The candidate that `name` was most likely meant to be: the fewest insertions, deletions, replacements and
/// swaps of neighbours away, upper and lower case alike. Empty when nothing is near.
std::string nearest(std::string_view name, std::span<const std::string> candidates);

/// "; did you mean 'x'?", to be appended to a problem; when nothing is near, all of them if they are few,
/// else nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace plumb
