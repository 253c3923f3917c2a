// A separate file, so that programs with their own number formatting can omit its tables, which take 120 kB.
#include <array>
#include <charconv>
#include <cmath>

#include "engine/core/text.h"

namespace plumb {

std::string shortest(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  // Most JSON readers parse "-0" as an integer, and integers have no negative zero.
  if (value == 0 && std::signbit(value)) return "-0.0";
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

}  // namespace plumb
