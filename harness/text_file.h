#pragma once

#include <istream>
#include <string>

namespace plumb::harness {

/// All of a file. Throws `Error` (Io) for one that is not there, is a folder or does not end (more than
/// 1 GiB); `advice` follows what is said of the first two.
std::string read_text(const std::string& path, const std::string& advice = "");
/// Likewise of what is open already; `subject` is what errors name.
std::string read_text(std::istream& in, const std::string& subject);

/// Writes a file so that it is there whole or not at all; what is no file, like a pipe or a device, is
/// written to. Throws `Error` (Io).
void write_whole(const std::string& path, const std::string& text);

}  // namespace plumb::harness
