#pragma once

#include <stdexcept>
#include <string>

namespace plumb::app {

/// Thrown for an invalid command line. `what()` is one line, with advice.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses a number as people write it: "0.01", "1e-3" or "1/240". Throws `UsageError` that names `option`.
double parse_number(const std::string& option, const std::string& text);

/// Parses a number that must be greater than zero, in the same way.
double parse_positive(const std::string& option, const std::string& text);

/// Returns the error in the name of a file or folder; empty if there is none. For checks of options.
std::string problem_with_path(const std::string& text);

}  // namespace plumb::app
