#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario.h"

/// Case files: a scene with what is expected of it, as JSON. The format is in docs/cases.md.
namespace plumb::harness::case_file {

/// One case, as its file says it.
struct CaseFile {
  std::string name, summary;
  scenarios::Problem problem;
};

/// Reads a case file and what it refers to. Throws `Error`: Io for a file that cannot be read, and otherwise
/// with the file, the member and the value.
CaseFile read_case(const std::string& path);

/// Returns true if the file at `path` holds a JSON object with the member "plumb_case". False if it cannot be
/// read.
bool is_case(const std::string& path);

/// Returns the case files directly in a folder, by name; empty if there are none, or no such folder.
std::vector<std::string> cases_in(const std::string& folder);

/// Returns a case file as an instance that scenarios' commands take. What it refers to lives as long as the
/// program. Throws as `read_case`.
scenarios::Instance case_instance(const std::string& path);

}  // namespace plumb::harness::case_file
