#pragma once

#include <string>

namespace plumb {

/// Which numbers a field takes.
enum class Limits { Any, NonNegative, Positive, ZeroToOne, NotZero };

/// "must be a positive number of kg".
std::string describe(Limits limits, const std::string& unit);

bool within(Limits limits, double value);

}  // namespace plumb
