#include "app/output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "engine/scene/error.h"

namespace plumb::app {
namespace {

[[noreturn]] void fail() {
  if (errno == EPIPE) throw OutputClosed();
  throw Error(Error::Kind::Io, "stdout", "", "", std::strerror(errno));
}

}  // namespace

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) fail();
}

void flush() {
  if (std::fflush(stdout) != 0) fail();
}

}  // namespace plumb::app
