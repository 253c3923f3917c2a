#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/geometry/aabb.h"
#include "engine/geometry/convex.h"
#include "engine/math/vec2.h"

/// Member lists of structs, defined once for all code that writes or reads them.
namespace plumb {

/// `Members<T>::of(value)` is a tuple of references to all members of `value`, in their order. The lists are
/// structured bindings, which must name every member: a list that misses a new one does not compile. `kNames`
/// has their names, separated by commas.
template <class T>
struct Members;

template <class T>
concept HasMembers = requires(T& value) {
  Members<T>::of(value);
};

#define PLUMB_MEMBERS(Struct, ...)                                                               \
  template <>                                                                                    \
  struct Members<Struct> {                                                                       \
    [[maybe_unused]] static constexpr std::string_view kStruct = #Struct, kNames = #__VA_ARGS__; \
    static constexpr auto of(auto& it) {                                                         \
      auto& [__VA_ARGS__] = it;                                                                  \
      return std::tie(__VA_ARGS__);                                                              \
    }                                                                                            \
  };

#define PLUMB_REAL_MEMBERS(Struct, ...)                                                          \
  template <class Real>                                                                          \
  struct Members<Struct<Real>> {                                                                 \
    [[maybe_unused]] static constexpr std::string_view kStruct = #Struct, kNames = #__VA_ARGS__; \
    static constexpr auto of(auto& it) {                                                         \
      auto& [__VA_ARGS__] = it;                                                                  \
      return std::tie(__VA_ARGS__);                                                              \
    }                                                                                            \
  };

PLUMB_REAL_MEMBERS(Vec2, x, y)
PLUMB_REAL_MEMBERS(Rotation, c, s)
PLUMB_REAL_MEMBERS(Aabb, lower, upper)
PLUMB_REAL_MEMBERS(Corner, point, normal)

/// Number of values of an enumeration, which are 0, 1, ... To be specialised for each that is written.
template <class Enum>
inline constexpr int kEnumerators = 0;
template <>
inline constexpr int kEnumerators<std::byte> = 256;

/// Returns the size in bytes of a T that is written member by member, without padding; 0 if it depends on the
/// value.
template <class T>
consteval std::size_t packed_size() {
  if constexpr (std::is_arithmetic_v<T>) {
    return sizeof(T);
  } else if constexpr (std::is_enum_v<T>) {
    static_assert(kEnumerators<T> > 0 && kEnumerators<T> <= 256);
    return 1;
  } else if constexpr (std::is_bounded_array_v<T>) {
    return std::extent_v<T> * packed_size<std::remove_extent_t<T>>();
  } else if constexpr (HasMembers<T>) {
    return []<class... Each>(std::type_identity<std::tuple<Each&...>>) {
      const bool known = ((packed_size<Each>() > 0) && ...);
      return known ? (packed_size<Each>() + ... + 0) : std::size_t{0};
    }(std::type_identity<decltype(Members<T>::of(std::declval<T&>()))>{});
  } else {
    return 0;
  }
}

template <class T>
concept Packed = packed_size<T>()
> 0;

}  // namespace plumb
