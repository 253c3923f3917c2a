#include <array>
#include <cmath>

#include "bindings/javascript/buffer.h"
#include "engine/core/text.h"

extern "C" {
/// Writes a number as JavaScript does, in place of engine/core/shortest.cpp, and returns its length: the
/// tables of the C++ library would be a seventh of the package.
PLUMB_IMPORT("shortest") std::size_t js_shortest(double value, char* to);
}

std::string plumb::shortest(double value) {
  if (value == 0 && std::signbit(value)) return "-0.0";
  std::array<char, 32> text{};  // JavaScript needs 24 at most
  return {text.data(), js_shortest(value, text.data())};
}
