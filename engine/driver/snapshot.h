#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/scene/error.h"

namespace plumb {

/// Writes values as bytes, one after another, in the machine's byte order.
class SnapshotWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t end = bytes_.size();
    bytes_.resize(end + sizeof(T));
    std::memcpy(bytes_.data() + end, &value, sizeof(T));
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads them back. Throws `Error` (Value) if the bytes end too soon.
class SnapshotReader {
 public:
  explicit SnapshotReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    if (bytes_.size() < sizeof(T)) throw Error(Error::Kind::Value, "snapshot", "", "", "it is cut short");
    T value;
    std::memcpy(static_cast<void*>(&value), bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }

  /// Reads the number of elements that follow, of at least `size` bytes each.
  std::size_t count(std::size_t size) {
    const auto number = get<std::uint64_t>();
    if (number > bytes_.size() / size) throw Error(Error::Kind::Value, "snapshot", "", "", "it is cut short");
    return static_cast<std::size_t>(number);
  }

  void expect(bool fits) const {
    if (!fits)
      throw Error(Error::Kind::Value, "snapshot", "", "", "it is of another scene or other settings");
  }
  void expect_end() const { expect(bytes_.empty()); }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace plumb
