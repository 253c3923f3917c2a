#pragma once

#include <mutex>

// C++ libraries of platforms without threads, as WebAssembly's for browsers, have no std::mutex.
#if defined(_LIBCPP_HAS_NO_THREADS) || (defined(_LIBCPP_HAS_THREADS) && !_LIBCPP_HAS_THREADS)
#define PLUMB_NO_THREADS
#endif

namespace plumb {

#ifdef PLUMB_NO_THREADS
/// Does nothing: there is one thread.
struct Mutex {};
struct MutexLock {
  explicit MutexLock(Mutex&) {}
};
#else
using Mutex = std::mutex;
using MutexLock = std::lock_guard<std::mutex>;
#endif

}  // namespace plumb
