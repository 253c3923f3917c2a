#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/error.h"

/// JSON text as a tree with line numbers. Independent of scenes.
namespace plumb::json {

enum class Kind { Null, Boolean, Number, String, Array, Object };

/// One value.
struct Node {
  Kind kind = Kind::Null;
  int line = 0;        ///< 1-based; of the first character of an array or object, of the last of other values
  int key_line = 0;    ///< line of its key in the parent object
  std::string key{};   ///< empty outside objects
  std::string text{};  ///< of a string
  double number = 0;   ///< of a number; 0 or 1 of a boolean
  bool beyond_64_bits =
      false;  ///< a whole number that was written without a fraction, but is too large for `bits`
  std::uint64_t bits = 0;  ///< of a whole number that was written without a fraction: exact, two's complement
  std::vector<Node> items{};  ///< of an array or object, in the order of the text

  /// Returns the member called `name`, or nullptr.
  const Node* find(std::string_view name) const;
};

/// Reason and position of an error in the text.
struct ParseError {
  std::vector<const Node*> path;  ///< from the root to the value being read
  std::string value;              ///< the offending text
  std::string problem;
  int line = 0;
  Error::Kind kind = Error::Kind::Syntax;
};

/// The values read, and the reason if reading stopped before the end.
struct Document {
  Node root;
  std::optional<ParseError> error;
};

/// Maximum nesting depth of arrays and objects.
inline constexpr std::size_t kMaxNesting = 64;

/// Maximum length of a text, bytes.
inline constexpr std::size_t kMaxTextSize = std::size_t{1} << 30;

/// Parses RFC 8259 JSON. Also refuses duplicate keys, numbers that a double cannot hold, nesting deeper than
/// `kMaxNesting` and byte order marks. Numbers are rounded to the nearest double; "-0" keeps its sign.
void parse(std::string_view text, Document& out);

/// Returns `node` as short JSON for messages.
std::string excerpt(const Node& node);

}  // namespace plumb::json
