#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario.h"

/// Case files: a scene with expectations, as JSON. The format is in docs/cases.md.
namespace plumb::harness::case_file {

/// One case as read from its file.
struct CaseFile {
  std::string name, summary;
  scenarios::Problem problem;
};

/// Reads a case file and the files that it refers to. Throws `Error`: Io for a file that cannot be read,
/// otherwise with the file, the member and the value.
CaseFile read_case(const std::string& path);

/// Returns true if the file at `path` holds a JSON object with the member "plumb_case". False if it cannot be
/// read.
bool is_case(const std::string& path);

/// Returns the case files directly in a folder, by name; empty if there are none, or if the folder does not
/// exist.
std::vector<std::string> cases_in(const std::string& folder);

/// Returns a case file as an instance, which commands accept like a scenario. The data that it refers to is
/// kept until the program ends. Throws as `read_case`.
scenarios::Instance case_instance(const std::string& path);

}  // namespace plumb::harness::case_file
