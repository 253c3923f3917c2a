#include "app/output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb::app {
namespace {

[[noreturn]] void fail() {
  if (errno == EPIPE) throw OutputClosed();
  throw Error(Error::Kind::Io, "stdout", "", "", std::strerror(errno));
}

}  // namespace

void keep_standard_files() {
  for (int file = open("/dev/null", O_RDWR); file >= 0; file = open("/dev/null", O_RDWR)) {
    if (file > STDERR_FILENO) {
      close(file);
      return;
    }
    // Open for the opposite direction, so that any read or write there fails with an error.
    const int wrong = open("/dev/null", file == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    dup2(wrong, file);
    close(wrong);
  }
}

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) fail();
}

void notice(std::string_view text) { write_error("plumb: " + printable(text, std::string::npos) + "\n"); }

void write_error(std::string_view text) {
  // Not fmt::print, which throws.
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void flush() {
  if (std::fflush(stdout) != 0) fail();
}

}  // namespace plumb::app
