#pragma once

#include <fstream>
#include <istream>
#include <string>

namespace plumb::harness {

/// Opens a file to be read piece by piece, however large. Throws `Error` (Io) as `read_text` does.
std::ifstream open_text(const std::string& path, const std::string& advice = "");

/// Reads a whole file. Throws `Error` (Io) if it does not exist, is a folder or has more than 1 GiB; `advice`
/// is appended to the message for the first two.
std::string read_text(const std::string& path, const std::string& advice = "");
/// Reads an open stream in the same way; errors name `subject`.
std::string read_text(std::istream& in, const std::string& subject);

/// Creates a folder and its parents, unless they exist. Throws `Error` (Io) that says why it cannot.
void make_folder(const std::string& folder, const char* advice = "choose another with --out");

/// Writes a file whole or not at all; writes directly to anything else, like a pipe or a device. Throws
/// `Error` (Io).
void write_whole(const std::string& path, const std::string& text);

}  // namespace plumb::harness
