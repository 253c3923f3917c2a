#pragma once

#include <string>
#include <vector>

namespace plumb::app {

/// Whether the names given to `compare` mean two sets of results: each is a folder that holds a
/// results.jsonl, or a file that ends in ".jsonl". Throws `UsageError` where that is not clear: only one of
/// them is, or a folder bears a scenario's name.
bool mean_results(const std::vector<std::string>& names);

/// `compare OLD NEW`: prints what is better, worse or cannot be told from noise.
int compare_results(const std::string& before, const std::string& after, const std::string& format);

}  // namespace plumb::app
