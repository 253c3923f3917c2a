#pragma once

#include <stdexcept>
#include <string_view>

namespace plumb::app {

/// Nobody reads stdout any more: the program ends quietly.
class OutputClosed : public std::runtime_error {
 public:
  OutputClosed() : std::runtime_error("stdout was closed") {}
};

/// To be called first. Where stdin, stdout or stderr are closed, the next file that is opened would get their
/// numbers, and results what is meant for stdout.
void keep_standard_files();

/// Writes data to stdout. Throws `OutputClosed`, or `Error` (Io) when the medium is full.
void print(std::string_view text);

/// Tells the user `text` on stderr, in a line that begins with "plumb: ". Control characters, which names of
/// files and arguments may hold, are written as \xNN. Where stderr cannot be written the line is lost: a run
/// that has data to give does not end for that.
void notice(std::string_view text);

/// Writes `text` to stderr as it stands; lost where that cannot be written.
void write_error(std::string_view text);

/// Hands over what is buffered. Throws as `print`.
void flush();

}  // namespace plumb::app
