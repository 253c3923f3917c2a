// Debian's C++ runtime for WebAssembly cannot unwind: without `catch` a throw is a call of __cxa_throw. That
// hands the sentence to JavaScript, which throws in its turn and leaves the module for good: its memory may
// be half-changed, so the page starts a fresh one and restores the last state that it saved.
#include <cstdlib>
#include <exception>
#include <typeinfo>

#include "engine/scene/error.h"

extern "C" {

/// Does not return.
__attribute__((import_module("plumb"), import_name("fail"))) void plumb_fail(const char* sentence);

void* __cxa_allocate_exception(std::size_t size) throw() { return std::malloc(size); }

[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*)(void*)) {
  // Of other types only the name is known: where their std::exception lies is not.
  const bool known = *type == typeid(plumb::Error);
  plumb_fail(known ? static_cast<const plumb::Error*>(thrown)->what() : type->name());
  std::abort();
}
}
