#pragma once

#include <stdexcept>
#include <string_view>

namespace plumb::app {

/// Thrown if stdout was closed by its reader: the program ends quietly.
class OutputClosed : public std::runtime_error {
 public:
  OutputClosed() : std::runtime_error("stdout was closed") {}
};

/// Opens stdin, stdout and stderr if they are closed; call it first. Otherwise the next opened file would get
/// such a number, and results files could receive the output meant for stdout.
void keep_standard_files();

/// Writes data to stdout. Throws `OutputClosed`, or `Error` (Io) if the medium is full.
void print(std::string_view text);

/// Writes `text` to stderr, in a line that begins with "plumb: ". Control characters, which file names and
/// arguments may contain, are written as \xNN. If stderr cannot be written the line is lost, but the run
/// continues.
void notice(std::string_view text);

/// Writes `text` to stderr unchanged; lost if that cannot be written.
void write_error(std::string_view text);

/// Flushes stdout. Throws as `print`.
void flush();

}  // namespace plumb::app
