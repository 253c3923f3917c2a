#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>

#include "engine/math/vec2.h"

namespace plumb::fuzz {

/// Choices and numbers from the bytes that a fuzzer made, zeros once they are used up: the same bytes make
/// the same choices everywhere.
class ByteSource {
 public:
  explicit ByteSource(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool empty() const { return bytes_.empty(); }
  std::span<const std::uint8_t> rest() const { return bytes_; }

  /// Says if `number` is to give numbers far outside of the range asked for, too.
  void set_extreme(bool on) { extreme_ = on; }
  bool extreme() const { return extreme_; }

  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
  }
  bool flag() { return byte() % 2 == 1; }
  int below(int count) { return byte() % count; }
  std::uint16_t word() {
    const int low = byte();
    return static_cast<std::uint16_t>(low + 256 * byte());
  }
  std::span<const std::uint8_t> take(std::size_t count) {
    const auto front = bytes_.first(std::min(count, bytes_.size()));
    bytes_ = bytes_.subspan(front.size());
    return front;
  }

  /// From `lower` to `upper`; in extreme runs now and then any number at all.
  double number(double lower, double upper) {
    const int low = byte();
    if (extreme_ && low >= 192) return kExtremes[low % std::size(kExtremes)];
    return lower + (upper - lower) * (256 * byte() + low) / 65535;
  }
  Vec2d vector(double reach) {
    const double x = number(-reach, reach);
    return {x, number(-reach, reach)};
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kExtremes[] = {0,
                                         -0.0,
                                         1e-12,
                                         -1e-12,
                                         1e-6,
                                         1e-3,
                                         1e3,
                                         1e6,
                                         -1e6,
                                         1e12,
                                         -1e12,
                                         1e13,
                                         1e30,
                                         -1e300,
                                         5e-324,
                                         1e-38,
                                         kInfinity,
                                         -kInfinity,
                                         std::numeric_limits<double>::quiet_NaN()};

  std::span<const std::uint8_t> bytes_;
  bool extreme_ = false;
};

}  // namespace plumb::fuzz
