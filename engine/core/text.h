#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// Numbers and names as text, for JSON and for messages.
namespace plumb {

/// Returns the shortest decimal that reads back to the same bits, as a JSON number; a negative zero is
/// "-0.0". Non-finite values become "nan", "inf" or "-inf", which are not JSON.
std::string shortest(double value);

/// Returns the length of the decimal number without a sign at the start of `text` ("2", ".5", "1.", "3e-4");
/// 0 if there is none. An exponent without digits is not counted.
std::size_t decimal_length(std::string_view text);

/// Returns the double nearest to `decimal`; nullopt beyond the range of doubles. `decimal_length` must be the
/// length of the whole text. Gives the same bits with every standard library and locale.
std::optional<double> read_decimal(std::string_view decimal);

/// Makes `text` fit for a message: control characters and bytes that are not UTF-8 are written as \xNN. Texts
/// longer than `limit` bytes are cut and end in "...".
std::string printable(std::string_view text, std::size_t limit = 80);

/// Returns `printable` text between single quotes.
std::string quoted(std::string_view text);

/// Returns the length in bytes of the UTF-8 character at the start of `text`; 0 if it is invalid (RFC 3629:
/// no overlong forms, no surrogates, nothing beyond U+10FFFF).
std::size_t utf8_length(std::string_view text);

/// Returns true if all of `text` is UTF-8.
bool is_utf8(std::string_view text);

/// Returns true if `text`, which is UTF-8, has a control character: U+0000..U+001F or U+007F..U+009F.
bool has_control_character(std::string_view text);

}  // namespace plumb
