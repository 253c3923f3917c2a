#include "engine/core/text.h"

#include <charconv>
#include <cmath>
#include <system_error>

#ifndef __cpp_lib_to_chars
#include <clocale>
#include <cstdlib>
#endif

namespace plumb {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// Returns true if the character of `length` bytes at the start of `text` is a control character.
bool is_control(std::string_view text, std::size_t length) {
  if (length == 1) return byte_at(text, 0) < 0x20 || byte_at(text, 0) == 0x7F;
  return length == 2 && byte_at(text, 0) == 0xC2 && byte_at(text, 1) < 0xA0;
}

void append_escaped(std::string& out, unsigned byte) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  out += "\\x";
  out += kDigits[byte >> 4];
  out += kDigits[byte & 15];
}

}  // namespace

std::size_t decimal_length(std::string_view text) {
  const auto digits_from = [&](std::size_t at) {
    while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
    return at;
  };
  std::size_t end = digits_from(0);
  std::size_t digits = end;
  if (end < text.size() && text[end] == '.') {
    const std::size_t after = digits_from(end + 1);
    digits += after - end - 1;
    end = after;
  }
  if (digits == 0) return 0;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    std::size_t first = end + 1;
    if (first < text.size() && (text[first] == '+' || text[first] == '-')) ++first;
    const std::size_t after = digits_from(first);
    if (after > first) end = after;
  }
  return end;
}

std::optional<double> read_decimal(std::string_view decimal) {
  double value = 0;
#ifdef __cpp_lib_to_chars
  const auto result = std::from_chars(decimal.data(), decimal.data() + decimal.size(), value);
  if (result.ec != std::errc{}) return std::nullopt;
#else
  // Some libraries, like LLVM's before 20, write floating-point numbers but read none: use strtod, with the
  // locale's decimal point. It sets errno for subnormal numbers as well as for those out of range, so the
  // value is tested instead.
  std::string text(decimal);
  const std::size_t point = text.find('.');
  if (point != std::string::npos) text.replace(point, 1, std::localeconv()->decimal_point);
  value = std::strtod(text.c_str(), nullptr);
  const bool zero =
      decimal.substr(0, decimal.find_first_of("eE")).find_first_of("123456789") == std::string_view::npos;
  if (!std::isfinite(value) || (value == 0 && !zero)) return std::nullopt;
#endif
  return value;
}

std::size_t utf8_length(std::string_view text) {
  if (text.empty()) return 0;
  const unsigned lead = byte_at(text, 0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte_at(text, i) & 0xC0) != 0x80) return 0;
  }
  // Unicode, table 3-7: the second byte excludes overlong forms, surrogates and code points beyond U+10FFFF.
  const unsigned second = byte_at(text, 1);
  const bool excluded = (lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
                        (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F);
  return excluded ? 0 : length;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

bool has_control_character(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (is_control(text, length)) return true;
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return false;
}

std::string printable(std::string_view text, std::size_t limit) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const std::size_t taken = length == 0 ? 1 : length;
    if (out.size() + taken > limit) return out + "...";
    if (length == 0 || is_control(text, length)) {
      for (std::size_t i = 0; i < taken; ++i) append_escaped(out, byte_at(text, i));
    } else {
      out += text.substr(0, taken);
    }
    text.remove_prefix(taken);
  }
  return out;
}

std::string quoted(std::string_view text) { return "'" + printable(text) + "'"; }

}  // namespace plumb
