#include <algorithm>
#include <cstring>
#include <exception>
#include <new>

#include "bindings/c/handle.h"

namespace plumb::c {
namespace {

/// Error of a thread. Texts that do not fit are cut: no memory is needed to report that memory ran out.
struct Kept {
  plumb_status status = PLUMB_OK;
  int line = 0;
  char message[1024] = "", subject[256] = "", field[64] = "", value[128] = "";
};
thread_local Kept kept;

template <std::size_t kSize>
void copy(char (&to)[kSize], const char* from) {
  const std::size_t size = std::min(std::strlen(from), kSize - 1);
  std::memcpy(to, from, size);
  to[size] = '\0';
}

plumb_status keep(plumb_status status, const char* message) {
  kept = {};
  kept.status = status;
  copy(kept.message, message);
  return status;
}

plumb_status status_of(Error::Kind kind) {
  switch (kind) {
    case Error::Kind::Syntax:
      return PLUMB_SYNTAX;
    case Error::Kind::Value:
      return PLUMB_VALUE;
    case Error::Kind::Name:
      return PLUMB_NAME;
    case Error::Kind::Unsupported:
      return PLUMB_UNSUPPORTED;
    case Error::Kind::Run:
      return PLUMB_RUN;
    case Error::Kind::Io:
      return PLUMB_IO;
  }
  return PLUMB_INTERNAL;
}

}  // namespace

plumb_status keep_error() noexcept {
  try {
    throw;
  } catch (const Error& error) {
    keep(status_of(error.kind()), error.what());
    copy(kept.subject, error.subject().c_str());
    copy(kept.field, error.field().c_str());
    copy(kept.value, error.value().c_str());
    kept.line = error.line();
    return kept.status;
  } catch (const std::bad_alloc&) {
    return keep(PLUMB_MEMORY, "memory ran out");
  } catch (const std::exception& error) {
    return keep(PLUMB_INTERNAL, error.what());
  } catch (...) {
    return keep(PLUMB_INTERNAL, "an exception of an unknown type");
  }
}

std::size_t fill_bytes(const std::vector<std::byte>& bytes, void* to, std::size_t capacity) {
  if (capacity >= bytes.size() && !bytes.empty())
    std::memcpy(&require(static_cast<std::byte*>(to), "out"), bytes.data(), bytes.size());
  return bytes.size();
}

}  // namespace plumb::c

using plumb::c::kept;

plumb_error plumb_last_error(void) {
  return {kept.status, kept.message, kept.subject, kept.field, kept.value, kept.line};
}
void plumb_clear_error(void) { kept = {}; }
const char* plumb_version(void) { return PLUMB_VERSION; }
