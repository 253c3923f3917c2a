#pragma once

#include <string_view>
#include <vector>

#include "scenarios/truth/parts.h"

namespace plumb::scenarios::truth {

/// Returns smooth discs that meet in free space within two seconds. No contact falls on a step of 1/60 or
/// 1/240 s. The variants: "head_on_" and the ratio of masses (1, 10, 1000, 1e6), "oblique", "restitution_0",
/// "restitution_half" and "cradle".
std::vector<Body> colliding_discs(std::string_view variant);

}  // namespace plumb::scenarios::truth
