#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/core/text.h"
#include "engine/encoding/encoding.h"

/// Every number of a definition, one after another: what definitions consist of is said by `Members`, whose
/// lists do not compile when one is missing.
namespace plumb::bad_input {

/// Names a number's place ("motor.max_force", "points[1].x") and the member that it belongs to
/// ("Motor.max_force").
struct FieldPlace {
  std::string path, key;
};

/// The names in "a, b, c".
inline std::vector<std::string> split_names(std::string_view list) {
  std::vector<std::string> names(1);
  for (const char c : list) {
    if (c == ',') {
      names.emplace_back();
    } else if (c != ' ') {
      names.back() += c;
    }
  }
  return names;
}

/// The last member that a path names: "max_force", "points".
inline std::string last_name(std::string path) {
  if (path.ends_with(".x") || path.ends_with(".y")) path.resize(path.size() - 2);
  if (path.ends_with("]")) path.resize(path.rfind('['));
  return path.substr(path.rfind('.') + 1);
}

/// Calls visit(place, value) for each double, int and enumeration in `value`. Options have to hold something
/// and lists must not be empty: what is in them would be missed.
template <class T, class Visit>
void visit_fields(T& value, const FieldPlace& at, Visit&& visit) {
  if constexpr (std::is_same_v<T, double> || std::is_same_v<T, int> || std::is_enum_v<T>) {
    visit(at, value);
  } else if constexpr (std::is_integral_v<T> || std::is_same_v<T, std::string>) {
    // Switches, bit patterns and texts: no value of theirs is out of a range.
  } else if constexpr (std::is_same_v<T, Vec2d>) {
    visit(FieldPlace{at.path + ".x", at.key}, value.x);
    visit(FieldPlace{at.path + ".y", at.key}, value.y);
  } else if constexpr (OptionTraits<T>::value) {
    if (!value) ADD_FAILURE() << at.path << " is absent in the sample";
    if (value) visit_fields(*value, at, visit);
  } else if constexpr (ListTraits<T>::value) {
    if (value.empty()) ADD_FAILURE() << at.path << " is empty in the sample";
    for (std::size_t i = 0; i < value.size(); ++i)
      visit_fields(value[i], {at.path + "[" + std::to_string(i) + "]", at.key}, visit);
  } else if constexpr (VariantTraits<T>::value) {
    std::visit([&](auto& held) { visit_fields(held, at, visit); }, value);
  } else {
    const std::vector<std::string> names = split_names(Members<T>::kNames);
    const std::string stem = at.path.empty() ? "" : at.path + ".";
    std::size_t next = 0;
    const auto each = [&](auto& member) {
      const std::string& name = names[next++];
      visit_fields(member, {stem + name, std::string(Members<T>::kStruct) + "." + name}, visit);
    };
    Members<T>::with(value, [&](auto&... members) { (each(members), ...); });
  }
}

/// Allowed values of a number.
struct Rule {
  double lowest = 0, highest = 0;
  double least = 0;       ///< in size
  bool infinite = false;  ///< or no bound at all
  bool zero = false;      ///< or 0, whatever is least

  bool accepts(double value) const {
    if ((infinite && std::isinf(value)) || (zero && value == 0)) return true;
    return value >= lowest && value <= highest && std::abs(value) >= least;
  }
};

inline std::vector<double> bad_numbers() {
  using Limits = std::numeric_limits<double>;
  return {Limits::quiet_NaN(),
          Limits::infinity(),
          -Limits::infinity(),
          Limits::max(),
          Limits::lowest(),
          1e300,
          -1e300,
          1.01e100,
          -2e15,
          2e15,
          -1.001e12,
          1.001e12,
          Limits::denorm_min(),
          -Limits::denorm_min(),
          Limits::min(),
          1e-101,
          1e-30,
          -1e-13,
          0.0,
          -0.0,
          -1.0,
          1.0000001,
          5.0,
          1001.0,
          255.0,
          -2147483648.0,
          2147483647.0};
}

/// Returns true if a field of type T can hold the number at all.
template <class T>
bool can_hold(double value) {
  if constexpr (std::is_same_v<T, double>) {
    return true;
  } else if constexpr (std::is_enum_v<T>) {
    return can_hold<std::underlying_type_t<T>>(value);
  } else {
    return value == std::floor(value) && value >= static_cast<double>(std::numeric_limits<T>::min()) &&
           value <= static_cast<double>(std::numeric_limits<T>::max());
  }
}

/// As errors write it.
template <class T>
std::string text_of(double value) {
  if constexpr (std::is_same_v<T, double>) {
    return shortest(value);
  } else {
    return std::to_string(static_cast<long long>(value));
  }
}

}  // namespace plumb::bad_input
