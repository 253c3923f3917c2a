#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/encoding/encoding.h"

namespace plumb {

/// Writes the state of a run, one value after another.
class SnapshotWriter {
 public:
  template <class T>
  void put(const T& value) {
    Encoder(bytes_).put(value);
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads it back. Throws `Error` (Value) if the bytes end too soon or contain an impossible value.
class SnapshotReader {
 public:
  explicit SnapshotReader(std::span<const std::byte> bytes) : in_(bytes, "snapshot") {}

  template <class T>
  T get() {
    return in_.get<T>("state");
  }

  /// Reads the number of elements that follow, of at least `size` bytes each.
  std::size_t count(std::size_t size) {
    const auto number = get<std::uint64_t>();
    in_.require(number <= rest().size() / size, "state", "is cut off");
    return static_cast<std::size_t>(number);
  }

  /// Returns what has not been read.
  std::span<const std::byte> rest() { return in_.rest(); }

  void expect(bool fits) const { in_.require(fits, "state", "is of another scene or other settings"); }
  void expect_end() { expect(rest().empty()); }

 private:
  Decoder in_;
};

}  // namespace plumb
