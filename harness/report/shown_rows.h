#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "harness/result.h"

/// Choice of the runs that a page has room for. A page of every run of a large sweep would be larger than a
/// browser opens at once; curves look the same with fewer points.
namespace plumb::harness::report {

/// Returns the largest c for which the sum of min(count, c) over `counts` is at most `room`, but at least
/// `least`. So large groups get the space that small ones leave.
std::size_t fair_share(std::vector<std::size_t> counts, std::size_t room, std::size_t least);

/// Returns the indices of the rows to show, in order, at most `most` of each engine. In this order of
/// importance: rows for which `kept` is true; the most accurate row; then in turns the front of error and
/// cost, the longest series that differs in dt alone, and each kind of failure and of missed check (each
/// evenly spread); then the rest, evenly spread.
std::vector<std::size_t> shown_rows(std::span<const Result> scene, const MetricField& metric,
                                    const std::vector<bool>& kept, std::size_t most);

}  // namespace plumb::harness::report
