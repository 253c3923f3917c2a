#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace CLI {
class App;
class Success;
}  // namespace CLI

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

/// Returns a check of an option that takes a whole number, for `CLI::Option::check`. The number is compared
/// digit by digit as it is written, because conversions of the library limit large ones without an error.
std::function<std::string(const std::string&)> whole_number(
    std::int64_t lowest, std::int64_t highest = std::numeric_limits<std::int64_t>::max());

/// Prints what --help or --version asks for, as all other output; returns the exit code.
int say(const CLI::App& app, const CLI::Success& success);

/// Throws `UsageError` that names the first option of `command` that was given without a value, as `--dt ""`:
/// an unset variable of a shell would otherwise pass for an omitted option.
void refuse_empty_values(const CLI::App& command);

/// Returns the error in the name of a file or folder; empty if there is none. For checks of options.
std::string problem_with_path(const std::string& text);

}  // namespace plumb::app
