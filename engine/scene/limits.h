#pragma once

#include <string>

namespace plumb {

/// Allowed numbers of a field.
enum class Limits { Any, NonNegative, Positive, ZeroToOne, NotZero };

/// Returns "must be a positive number of kg".
std::string describe(Limits limits, const std::string& unit);

bool within(Limits limits, double value);

}  // namespace plumb
