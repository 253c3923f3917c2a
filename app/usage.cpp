#include "app/usage.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/output.h"

namespace plumb::app {
namespace {

bool parse_decimal(std::string_view text, double& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end && std::isfinite(value);
}

}  // namespace

double parse_number(const std::string& option, const std::string& text) {
  const std::size_t slash = text.find('/');
  double value = 0, below = 1;
  const bool good =
      parse_decimal(std::string_view(text).substr(0, slash), value) &&
      (slash == std::string::npos || parse_decimal(std::string_view(text).substr(slash + 1), below));
  if (!good || !std::isfinite(value / below))
    throw UsageError(fmt::format("{} is '{}': give a finite number, like 0.01 or 1/240", option, text));
  return value / below;
}

double parse_positive(const std::string& option, const std::string& text) {
  const double value = parse_number(option, text);
  if (!(value > 0))
    throw UsageError(fmt::format("{} is '{}': give a number above 0, like 0.01 or 1/240", option, text));
  return value;
}

std::function<std::string(const std::string&)> whole_number(std::int64_t lowest, std::int64_t highest) {
  return [=](const std::string& text) -> std::string {
    std::int64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc{} && stop == end && value >= lowest && value <= highest) return "";
    return fmt::format("'{}' is not a whole number from {} to {}", text, lowest, highest);
  };
}

int say(const CLI::App& app, const CLI::Success& success) {
  std::ostringstream out, error;
  const int code = app.exit(success, out, error);
  print(out.str());
  flush();
  return code;
}

void refuse_empty_values(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_lnames().empty() || option->get_items_expected_max() == 0 || option->count() == 0)
      continue;
    for (const std::string& value : option->results())
      if (value.empty())
        throw UsageError(fmt::format("--{} is empty: give a value, or omit the option; see `plumb {} --help`",
                                     option->get_lnames().front(), command.get_name()));
  }
}

std::string problem_with_path(const std::string& text) {
  return text.empty() ? "the name is empty; give a file or folder, or omit the option" : "";
}

}  // namespace plumb::app
