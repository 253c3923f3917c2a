#pragma once

#include <cstdio>
#include <cstdlib>

namespace plumb::fuzz {

/// A finding, unless `holds`: says what does not and ends the program, which keeps the input.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// A finding with what was going on.
[[noreturn]] inline void fail(const char* what, const char* detail) {
  std::fprintf(stderr, "does not hold: %s: %s\n", what, detail);
  std::abort();
}

}  // namespace plumb::fuzz
