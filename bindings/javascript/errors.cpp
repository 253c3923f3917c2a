#include <cstdlib>
#include <typeinfo>

#include "bindings/javascript/buffer.h"
#include "engine/scene/error.h"

extern "C" {

/// Throws in JavaScript, and does not return.
PLUMB_IMPORT("fail")
void js_fail(int kind, const char* sentence, const char* subject, const char* field, const char* value);

void* __cxa_allocate_exception(std::size_t size) throw() { return std::malloc(size); }

// Debian's C++ runtime for WebAssembly cannot unwind: no `catch` runs, so nothing adds to the message on the
// way out.
[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*)(void*)) {
  if (*type == typeid(plumb::Error)) {
    const auto& error = *static_cast<const plumb::Error*>(thrown);
    js_fail(static_cast<int>(error.kind()), error.what(), error.subject().c_str(), error.field().c_str(),
            error.value().c_str());
  } else {
    js_fail(-1, type->name(), "", "", "");
  }
  std::abort();
}

// There is one thread, and it never ends.
int __cxa_thread_atexit(void (*)(void*), void*, void*) throw() { return 0; }
}
