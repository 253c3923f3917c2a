#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/fuzz/support/byte_source.h"

namespace plumb::fuzz {

/// Returns the place, from `at` on, of the next number that is small and not 0: of 8 bytes it could be the
/// length of a list, of 4 an index. Returns `at` if there is none.
template <class Number>
std::size_t next_small(const std::vector<std::byte>& bytes, std::size_t at) {
  for (std::size_t i = 0; i + sizeof(Number) <= bytes.size(); ++i) {
    const std::size_t from = (at + i) % (bytes.size() - sizeof(Number) + 1);
    Number number = 0;
    std::memcpy(&number, bytes.data() + from, sizeof(number));
    if (number > 0 && number < 64) return from;
  }
  return at;
}

/// Changes bytes in up to four places, as `in` says: single ones, numbers, blocks. Few, so that not all of it
/// is refused by the first check that there is.
inline void patch(std::vector<std::byte>& bytes, ByteSource& in) {
  const auto overwrite = [&](std::size_t at, const auto& value) {
    if (at + sizeof(value) <= bytes.size()) std::memcpy(bytes.data() + at, &value, sizeof(value));
  };
  for (int left = 1 + in.below(4); left > 0 && !in.empty() && !bytes.empty(); --left) {
    const int how = in.below(8);
    const std::size_t at = in.word() % bytes.size();
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (how) {
      case 0:
        bytes[at] = std::byte{in.byte()};
        break;
      case 1:
        bytes[at] ^= std::byte{static_cast<unsigned char>(1u << in.below(8))};
        break;
      case 2: {
        // Small numbers, indices that are none, and lengths that overflow when they are multiplied.
        static constexpr int kPowers[] = {31, 32, 56, 59, 60, 61, 62, 63};
        const int number = in.byte();
        static constexpr std::int32_t kNone[] = {-1, -2, 1000, 1'000'000,
                                                 std::numeric_limits<std::int32_t>::max()};
        if (number < 96) {
          overwrite(at, static_cast<std::int32_t>(number) - 2);
        } else if (number < 192) {
          overwrite(next_small<std::uint32_t>(bytes, at), kNone[number % 5]);
        } else {
          overwrite(next_small<std::uint64_t>(bytes, at), std::uint64_t{1} << kPowers[number % 8]);
        }
        break;
      }
      case 3:
        overwrite(at, in.number(-10, 10));
        break;
      case 4:
        overwrite(at, static_cast<float>(in.number(-10, 10)));
        break;
      case 5: {
        const std::size_t to = in.word() % bytes.size(), most = bytes.size() - std::max(at, to);
        std::memmove(bytes.data() + to, bytes.data() + at, std::min<std::size_t>(in.byte(), most));
        break;
      }
      case 6:
        bytes.erase(from,
                    from + static_cast<std::ptrdiff_t>(std::min<std::size_t>(in.byte(), bytes.size() - at)));
        break;
      default:
        bytes.insert(from, 1 + in.byte() % 16u, std::byte{in.byte()});
    }
  }
}

}  // namespace plumb::fuzz
