#pragma once

#include <span>
#include <string>

#include "harness/result.h"

namespace plumb::harness {

/// Returns results as JUnit's XML, which CI systems read: a suite a case, a test an engine. A run that is not
/// as expected is a failure, with what missed and by how much; a skipped one is skipped; misses that fail
/// nothing stand in the test's output.
std::string junit(std::span<const Result> results);

}  // namespace plumb::harness
