// Debian's C++ runtime for WebAssembly cannot unwind: without `catch` a throw is a call of __cxa_throw. That
// passes the message to JavaScript, which throws an exception of its own and never returns to the module. The
// module's memory may be half-changed, so the page starts a fresh one and restores the last saved state.
#include <cstdlib>
#include <exception>
#include <typeinfo>

#include "engine/scene/error.h"

extern "C" {

/// Does not return.
__attribute__((import_module("plumb"), import_name("fail"))) void plumb_fail(const char* sentence);

void* __cxa_allocate_exception(std::size_t size) throw() { return std::malloc(size); }

[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*)(void*)) {
  // For other types only the name is known, not the offset of their std::exception.
  const bool known = *type == typeid(plumb::Error);
  plumb_fail(known ? static_cast<const plumb::Error*>(thrown)->what() : type->name());
  std::abort();
}
}
