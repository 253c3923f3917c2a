#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/encoding/members.h"
#include "engine/scene/error.h"

/// Serialises values as bytes, member by member: no padding, no pointers, little-endian. So equal values are
/// equal bytes on every platform. Lists and texts begin with their length (64 bits), options with a bool,
/// variants with their index (8 bits).
namespace plumb {

/// Throws Error (Value) unless `holds`: a property of the bytes on which the code that reads them relies.
/// `problem` completes the sentence that begins with `field`, a part of `subject`.
inline void require(bool holds, const char* subject, const char* field, const char* problem) {
  if (!holds) throw Error(Error::Kind::Value, subject, field, "", problem);
}

template <class T>
struct ListTraits : std::false_type {};
template <class T>
struct ListTraits<std::vector<T>> : std::true_type {};
template <class T>
struct ListTraits<std::span<T>> : std::true_type {};
template <>
struct ListTraits<std::string> : std::true_type {};

template <class T>
struct OptionTraits : std::false_type {};
template <class T>
struct OptionTraits<std::optional<T>> : std::true_type {};

template <class T>
struct VariantTraits : std::false_type {};
template <class... Each>
struct VariantTraits<std::variant<Each...>> : std::true_type {};

/// True for types of which each byte belongs to the value, and any byte is valid: lists of them are copied
/// whole.
template <class T>
inline constexpr bool kTriviallyEncoded = std::is_same_v<T, std::byte> ||
                                          (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);

/// Appends values to a buffer.
class Encoder {
 public:
  explicit Encoder(std::vector<std::byte>& out) : out_(out) {}

  template <class T>
  void put(const T& value) {
    if constexpr (Packed<T>) {
      std::byte* to = grow(packed_size<T>());
      pack(to, value);
    } else if constexpr (ListTraits<T>::value) {
      list(value);
    } else if constexpr (OptionTraits<T>::value) {
      put(value.has_value());
      if (value) put(*value);
    } else if constexpr (VariantTraits<T>::value) {
      put(static_cast<std::uint8_t>(value.index()));
      std::visit([&](const auto& held) { put(held); }, value);
    } else {
      Members<T>::with(value, [&](const auto&... each) { (put(each), ...); });
    }
  }

  std::vector<std::byte>& bytes() { return out_; }

  /// Writes to reserved memory and advances `to`.
  template <Packed T>
  static void pack(std::byte*& to, const T& value) {
    if constexpr (std::is_enum_v<T>) {
      *to++ = static_cast<std::byte>(value);
    } else if constexpr (std::is_arithmetic_v<T>) {
      std::memcpy(to, &value, sizeof(T));
      to += sizeof(T);
    } else if constexpr (std::is_bounded_array_v<T>) {
      for (const auto& each : value) pack(to, each);
    } else {
      Members<T>::with(value, [&](const auto&... each) { (pack(to, each), ...); });
    }
  }

 private:
  template <class List>
  void list(const List& all) {
    using T = std::remove_cv_t<typename List::value_type>;
    put(static_cast<std::uint64_t>(all.size()));
    if constexpr (kTriviallyEncoded<T>) {
      const std::size_t size = all.size() * sizeof(T);
      if (std::byte* to = grow(size); size > 0) std::memcpy(to, all.data(), size);
    } else if constexpr (Packed<T>) {
      std::byte* to = grow(all.size() * packed_size<T>());
      for (const T& each : all) pack(to, each);
    } else {
      for (const T& each : all) put(each);
    }
  }

  std::byte* grow(std::size_t size) {
    const std::size_t end = out_.size();
    out_.resize(end + size);
    return out_.data() + end;
  }

  std::vector<std::byte>& out_;
};

/// Reads values from the front of a buffer, in the order of writing. Throws Error (Value, `subject`) if the
/// buffer ends early or contains bytes that no encoder writes. Allocates no more than in proportion to the
/// buffer.
class Decoder {
 public:
  Decoder(std::span<const std::byte> in, const char* subject) : in_(in), subject_(subject) {}

  template <class T>
  T get(const char* field) {
    T value{};
    get(value, field);
    return value;
  }

  template <class T>
  void get(T& value, const char* field) {
    if constexpr (Packed<T>) {
      bool valid = true;
      const std::byte* from = take(packed_size<T>(), field);
      unpack(from, value, valid);
      require(valid, field, "holds what no snapshot or recording holds");
    } else if constexpr (ListTraits<T>::value) {
      list(value, field);
    } else if constexpr (OptionTraits<T>::value) {
      value.reset();
      if (get<bool>(field)) get(value.emplace(), field);
    } else if constexpr (VariantTraits<T>::value) {
      const int index = get<std::uint8_t>(field);
      require(index < static_cast<int>(std::variant_size_v<T>), field, "is of a kind that there is not");
      alternative<0>(value, index, field);
    } else {
      Members<T>::with(value, [&](auto&... each) { (get(each, field), ...); });
    }
  }

  /// Returns the unread rest. The caller may read from its front.
  std::span<const std::byte>& rest() { return in_; }

  void require(bool holds, const char* field, const char* problem) const {
    plumb::require(holds, subject_, field, problem);
  }

 private:
  template <class List>
  void list(List& all, const char* field) {
    using T = typename List::value_type;
    const std::uint64_t count = get<std::uint64_t>(field);
    all.clear();
    if constexpr (Packed<T>) {
      require(count <= in_.size() / packed_size<T>(), field, "is cut off");
      const std::byte* from = take(static_cast<std::size_t>(count) * packed_size<T>(), field);
      all.resize(static_cast<std::size_t>(count));
      if constexpr (kTriviallyEncoded<T>) {
        if (count > 0) std::memcpy(all.data(), from, all.size() * sizeof(T));
      } else {
        bool valid = true;
        for (T& each : all) unpack(from, each, valid);
        require(valid, field, "holds what no snapshot or recording holds");
      }
    } else {
      // Each element has at least one byte.
      require(count <= in_.size(), field, "is cut off");
      for (std::uint64_t i = 0; i < count; ++i) get(all.emplace_back(), field);
    }
  }

  template <std::size_t kIndex, class Variant>
  void alternative(Variant& value, int index, const char* field) {
    if constexpr (kIndex < std::variant_size_v<Variant>) {
      if (index == static_cast<int>(kIndex)) return get(value.template emplace<kIndex>(), field);
      alternative<kIndex + 1>(value, index, field);
    }
  }

  const std::byte* take(std::size_t size, const char* field) {
    require(size <= in_.size(), field, "is cut off");
    const std::byte* from = in_.data();
    in_ = in_.subspan(size);
    return from;
  }

  // Checks bits first: a bool or an enumeration with an invalid value would be undefined behaviour.
  template <class T>
  static void unpack(const std::byte*& from, T& value, bool& valid) {
    if constexpr (std::is_same_v<T, bool> || std::is_enum_v<T>) {
      constexpr int kValues = std::is_same_v<T, bool> ? 2 : kEnumerators<T>;
      const int bits = std::to_integer<int>(*from++);
      valid &= bits < kValues;
      value = static_cast<T>(bits < kValues ? bits : 0);
    } else if constexpr (std::is_arithmetic_v<T>) {
      std::memcpy(&value, from, sizeof(T));
      from += sizeof(T);
    } else if constexpr (std::is_bounded_array_v<T>) {
      for (auto& each : value) unpack(from, each, valid);
    } else {
      Members<T>::with(value, [&](auto&... each) { (unpack(from, each, valid), ...); });
    }
  }

  std::span<const std::byte> in_;
  const char* subject_;
};

}  // namespace plumb
