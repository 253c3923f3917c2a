#pragma once

#include <chrono>

#include "bindings/python/conversion.h"

namespace plumb::python {

/// Lets Ctrl-C end a call of many steps that has released the interpreter's lock.
class InterruptCheck {
 public:
  /// Runs the handlers of signals that came, and throws their exception. Looks every 50 ms: another thread of
  /// Python's may keep the lock for 5 ms.
  void operator()() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return;
    last_ = now;
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace plumb::python
