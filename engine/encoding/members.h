#pragma once

#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

#include "engine/geometry/aabb.h"
#include "engine/geometry/convex.h"
#include "engine/math/vec2.h"

/// Member lists of structs, defined once for all code that writes or reads them.
namespace plumb {

/// `Members<T>::with(value, act)` calls `act` with all members of `value`, in their order, and returns its
/// result. The lists are structured bindings, which must name every member: a list that lacks a new member
/// does not compile. `kNames` has the members' names, separated by commas.
template <class T>
struct Members;

template <class T>
concept HasMembers = requires {
  Members<T>::kNames;
};

#define PLUMB_MEMBERS(Struct, ...)                                                               \
  template <>                                                                                    \
  struct Members<Struct> {                                                                       \
    [[maybe_unused]] static constexpr std::string_view kStruct = #Struct, kNames = #__VA_ARGS__; \
    static constexpr auto with(auto& it, const auto& act) {                                      \
      auto& [__VA_ARGS__] = it;                                                                  \
      return act(__VA_ARGS__);                                                                   \
    }                                                                                            \
  };

#define PLUMB_REAL_MEMBERS(Struct, ...)                                                          \
  template <class Real>                                                                          \
  struct Members<Struct<Real>> {                                                                 \
    [[maybe_unused]] static constexpr std::string_view kStruct = #Struct, kNames = #__VA_ARGS__; \
    static constexpr auto with(auto& it, const auto& act) {                                      \
      auto& [__VA_ARGS__] = it;                                                                  \
      return act(__VA_ARGS__);                                                                   \
    }                                                                                            \
  };

PLUMB_REAL_MEMBERS(Vec2, x, y)
PLUMB_REAL_MEMBERS(Rotation, c, s)
PLUMB_REAL_MEMBERS(Aabb, lower, upper)
PLUMB_REAL_MEMBERS(Corner, point, normal)

/// Number of values of an enumeration, which are 0, 1, ... Specialise it for each enumeration that is
/// written.
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
    const auto sum = []<class... Each>(Each&...) {
      constexpr bool kKnown = ((packed_size<Each>() > 0) && ...);
      constexpr std::size_t kSize = kKnown ? (packed_size<Each>() + ... + 0) : 0;
      return std::integral_constant<std::size_t, kSize>{};
    };
    return decltype(Members<T>::with(std::declval<T&>(), sum))::value;
  } else {
    return 0;
  }
}

template <class T>
concept Packed = packed_size<T>()
> 0;

}  // namespace plumb
