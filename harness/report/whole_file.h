#pragma once

#include <string>

namespace plumb::harness::report {

/// Writes a file so that it is there whole or not at all. Throws `Error` (Io).
void write_whole(const std::string& path, const std::string& text);

}  // namespace plumb::harness::report
