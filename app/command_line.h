#pragma once

#include <string>
#include <vector>

namespace plumb::app {

/// A program and its arguments, parted at spaces; quotes, single or double, hold spaces together. Throws
/// `UsageError` for one that does not end.
std::vector<std::string> split_command(const std::string& text);

}  // namespace plumb::app
