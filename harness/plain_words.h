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

/// Returns a line per engine: the number of scenes that it ran, in how many of them it was nearest to the
/// truth, and in how many it missed bounds of its method. Then lists the scenes whose truth is suspect, if
/// any.
std::string conclusion(std::span<const Result> results, const Style& style);

/// Returns the labels of scenes in which the truth itself may be wrong: engines of at least two makers ran,
/// all agree with each other, and each misses the exact truth without a declared limit.
std::vector<std::string> suspect_truths(std::span<const Result> results);

}  // namespace plumb::harness
