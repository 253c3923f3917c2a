#pragma once

#include <string>
#include <vector>

namespace plumb::app {

/// Splits a command into a program and its arguments at spaces; single or double quotes protect spaces.
/// Throws `UsageError` for an unterminated quote.
std::vector<std::string> split_command(const std::string& text);

}  // namespace plumb::app
