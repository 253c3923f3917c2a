#pragma once

#include <span>
#include <string>

#include "harness/result.h"

namespace plumb::harness {

/// Returns results as JUnit XML, which CI systems read: a suite per case, a test per engine. An unexpected
/// run is a failure, with its misses; a skipped run is skipped; misses that are not failures are part of the
/// test's output.
std::string junit(std::span<const Result> results);

}  // namespace plumb::harness
