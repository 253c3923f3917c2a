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

/// True if every byte of a T belongs to its value, so that copying its bytes gives a defined result. The
/// language guarantees this for integers and structs of integers. A struct with floats declares it beside its
/// definition:
///
///     template <>
///     inline constexpr bool kWholeBytes<Arm> = members_fill<Arm, float, float, int>();
///
/// A struct with padding is written field by field instead.
template <class T>
inline constexpr bool kWholeBytes =
    std::has_unique_object_representations_v<T> || std::is_same_v<T, float> || std::is_same_v<T, double>;

/// Returns true if `Members`, all members of `T` in order, leave no padding.
template <class T, class... Members>
consteval bool members_fill() {
  return std::is_trivially_copyable_v<T> && (kWholeBytes<Members> && ...) &&
         sizeof(T) == (sizeof(Members) + ... + 0);
}

template <class Real>
inline constexpr bool kWholeBytes<Vec2<Real>> = members_fill<Vec2<Real>, Real, Real>();
template <class Real>
inline constexpr bool kWholeBytes<Rotation<Real>> = members_fill<Rotation<Real>, Real, Real>();

/// Types that may be written as their bytes.
template <class T>
concept Bytewise = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && kWholeBytes<T>;

/// Appends values to a buffer, in native byte order.
class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::byte>& out) : out_(out) {}

  template <Bytewise T>
  void value(const T& value) {
    append(&value, sizeof(T));
  }

  /// Appends the number of elements (64 bits), then the elements.
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

/// Reads values from the front of a buffer, in the order of writing. Throws Error (Value, subject "snapshot")
/// when the buffer ends early or holds data that no writer produces. Allocates nothing for a count that
/// exceeds the buffer.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> in) : in_(in) {}

  template <Bytewise T>
  T value(const char* field) {
    // A bool with other bits is undefined behaviour.
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

  /// Replaces the contents of `out`; its capacity is kept.
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

  /// Returns the unread part.
  std::span<const std::byte> rest() const { return in_; }

  /// Throws unless `holds` is true; `problem` completes the sentence that begins with `field`.
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
