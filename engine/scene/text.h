#pragma once

#include <string>
#include <string_view>

/// Numbers and names as text, for JSON and for messages.
namespace plumb {

/// The shortest decimal that reads back to the same bits, as a JSON number; a negative zero is "-0.0". What
/// is not finite becomes "nan", "inf" or "-inf", which JSON has no words for.
std::string shortest(double value);

/// `text` fit for a message: control characters and bytes that are not UTF-8 are written as \xNN, and what is
/// longer than `limit` bytes ends in "...".
std::string printable(std::string_view text, std::size_t limit = 80);

/// `printable` between single quotes.
std::string quoted(std::string_view text);

/// Bytes of the UTF-8 character that `text` starts with; 0 when it starts with none (RFC 3629: no overlong
/// forms, no surrogates, nothing beyond U+10FFFF).
std::size_t utf8_length(std::string_view text);

/// Whether all of `text` is UTF-8.
bool is_utf8(std::string_view text);

/// Whether `text`, which is UTF-8, holds a control character: U+0000..U+001F or U+007F..U+009F.
bool has_control_character(std::string_view text);

}  // namespace plumb
