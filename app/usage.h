#pragma once

#include <stdexcept>
#include <string>

namespace plumb::app {

/// The command line asks for something that there is not. `what()` is one line, with what to do about it.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A number as people give it: "0.01", "1e-3" or "1/240". Throws `UsageError` that names `option`.
double parse_number(const std::string& option, const std::string& text);

/// Likewise, and more than zero.
double parse_positive(const std::string& option, const std::string& text);

/// What is wrong with the name of a file or folder; empty when nothing is. For options' checks.
std::string problem_with_path(const std::string& text);

}  // namespace plumb::app
