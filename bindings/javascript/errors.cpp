#include <cstdlib>
#include <string>
#include <typeinfo>

#include "bindings/javascript/buffer.h"
#include "engine/scene/error.h"

extern "C" {

/// Throws in JavaScript, and does not return.
PLUMB_IMPORT("fail")
void js_fail(int kind, const char* sentence, const char* subject, const char* field, const char* value);

void* __cxa_allocate_exception(std::size_t size) throw() { return std::malloc(size); }

// Debian's C++ runtime for WebAssembly cannot unwind: no `catch` runs, so nothing adds to the message on the
// way out, and nothing destroys the exception. Its texts are kept until the next one instead.
[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*)(void*)) {
  if (*type == typeid(plumb::Error)) {
    auto& error = *static_cast<plumb::Error*>(thrown);
    static std::string sentence, subject, field, value;
    const int kind = static_cast<int>(error.kind());
    sentence = error.what(), subject = error.subject(), field = error.field(), value = error.value();
    error.~Error();  // by name: in WebAssembly the function that is passed has another signature
    std::free(thrown);
    js_fail(kind, sentence.c_str(), subject.c_str(), field.c_str(), value.c_str());
  } else {
    js_fail(-1, type->name(), "", "", "");
  }
  std::abort();
}

// There is one thread, and it never ends.
int __cxa_thread_atexit(void (*)(void*), void*, void*) throw() { return 0; }
}
