#include "app/usage.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

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

std::string problem_with_path(const std::string& text) {
  return text.empty() ? "the name is empty; give a file or folder, or omit the option" : "";
}

}  // namespace plumb::app
