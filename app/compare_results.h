#pragma once

#include <string>
#include <vector>

namespace plumb::app {

/// Returns true if the names given to `compare` are two sets of results: folders with a results.jsonl, or
/// files that end in ".jsonl". Throws `UsageError` if it is ambiguous: only one of them is, or a folder has a
/// scenario's name.
bool mean_results(const std::vector<std::string>& names);

/// Runs `compare OLD NEW`: prints the differences that are better, worse or hidden by noise.
int compare_results(const std::string& before, const std::string& after, const std::string& format);

}  // namespace plumb::app
