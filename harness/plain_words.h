#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/result.h"
#include "harness/style.h"

/// Text around the tables of a comparison, for readers who see one for the first time.
namespace plumb::harness {

/// Explains the columns of the tables.
std::string legend(const Style& style);

/// Returns a line an engine: how many scenes it ran, in how many it was nearest to the truth, how many of its
/// method's bounds it kept. Then the scenes whose truth is suspect, if any.
std::string conclusion(std::span<const Result> results, const Style& style);

/// Returns the scenes, by label, in which engines of two makers or more ran, all of them agree with each
/// other and each misses the exact truth without a declared limit: there the truth itself may be wrong.
std::vector<std::string> suspect_truths(std::span<const Result> results);

}  // namespace plumb::harness
