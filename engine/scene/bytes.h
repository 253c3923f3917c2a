#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/math/vec2.h"
#include "engine/scene/error.h"

namespace plumb {

/// Whether every byte of a T belongs to its value, so that a copy of its bytes carries nothing
/// indeterminate. The language knows it of integers and of structs of integers; of a struct with floats its
/// author says so, beside the struct:
///
///     template <>
///     inline constexpr bool kWholeBytes<Arm> = members_fill<Arm, float, float, int>();
///
/// A struct with padding is written field by field instead.
template <class T>
inline constexpr bool kWholeBytes =
    std::has_unique_object_representations_v<T> || std::is_same_v<T, float> || std::is_same_v<T, double>;

/// Whether `Members`, all the members of `T` in their order, leave no room for padding.
template <class T, class... Members>
consteval bool members_fill() {
  return std::is_trivially_copyable_v<T> && (kWholeBytes<Members> && ...) &&
         sizeof(T) == (sizeof(Members) + ... + 0);
}

template <class Real>
inline constexpr bool kWholeBytes<Vec2<Real>> = members_fill<Vec2<Real>, Real, Real>();
template <class Real>
inline constexpr bool kWholeBytes<Rotation<Real>> = members_fill<Rotation<Real>, Real, Real>();

/// What may be written as the bytes it lies in.
template <class T>
concept Bytewise = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && kWholeBytes<T>;

/// Appends values to a buffer, in the machine's own byte order.
class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::byte>& out) : out_(out) {}

  template <Bytewise T>
  void value(const T& value) {
    append(&value, sizeof(T));
  }

  /// The number of elements (64 bits), then the elements.
  template <Bytewise T>
  void values(std::span<const T> values) {
    value(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size_bytes());
  }
  template <Bytewise T>
  void values(const std::vector<T>& all) {
    values(std::span<const T>(all));
  }

  void text(const std::string& text) { values(std::span<const char>(text)); }

 private:
  void append(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t end = out_.size();
    out_.resize(end + size);
    std::memcpy(out_.data() + end, data, size);
  }

  std::vector<std::byte>& out_;
};

/// Takes values from the front of a buffer, in the order in which they were written. Throws
/// Error (Value, subject "snapshot") when the buffer ends early or holds what no writer writes; nothing is
/// allocated for a count that the buffer cannot hold.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> in) : in_(in) {}

  template <Bytewise T>
  T value(const char* field) {
    // A bool of other bits than these is undefined behaviour.
    if constexpr (std::is_same_v<T, bool>) {
      const auto bits = value<std::uint8_t>(field);
      require(bits <= 1, field, "is neither true nor false");
      return bits == 1;
    } else {
      T result;
      std::memcpy(&result, take(sizeof(T), field), sizeof(T));
      return result;
    }
  }

  /// Replaces what `out` holds; its capacity is kept.
  template <Bytewise T>
  void values(std::vector<T>& out, const char* field) {
    static_assert(!std::is_same_v<T, bool>);
    const auto count = value<std::uint64_t>(field);
    require(count <= in_.size() / sizeof(T), field, "is cut off");
    const std::size_t size = static_cast<std::size_t>(count) * sizeof(T);
    out.resize(static_cast<std::size_t>(count));
    const std::byte* from = take(size, field);
    if (size > 0) std::memcpy(out.data(), from, size);
  }

  std::string text(const char* field) {
    const auto count = value<std::uint64_t>(field);
    require(count <= in_.size(), field, "is cut off");
    const std::size_t size = static_cast<std::size_t>(count);
    const std::byte* from = take(size, field);
    return std::string(reinterpret_cast<const char*>(from), size);
  }

  /// What has not been read.
  std::span<const std::byte> rest() const { return in_; }

  /// Throws unless `holds`; `problem` ends the sentence that begins with `field`.
  static void require(bool holds, const char* field, const char* problem) {
    if (!holds) throw Error(Error::Kind::Value, "snapshot", field, "", problem);
  }

 private:
  const std::byte* take(std::size_t size, const char* field) {
    require(size <= in_.size(), field, "is cut off");
    const std::byte* from = in_.data();
    in_ = in_.subspan(size);
    return from;
  }

  std::span<const std::byte> in_;
};

}  // namespace plumb
