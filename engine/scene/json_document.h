#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/error.h"

/// JSON text as a tree that remembers its lines. Knows nothing of scenes.
namespace plumb::json {

enum class Kind { Null, Boolean, Number, String, Array, Object };

/// One value.
struct Node {
  Kind kind = Kind::Null;
  int line = 0;        ///< 1-based; of the value's first character for arrays and objects, else of its last
  int key_line = 0;    ///< of its key in the object that it stands in
  std::string key{};   ///< empty outside objects
  std::string text{};  ///< of a string
  double number = 0;   ///< of a number; 0 or 1 of a boolean
  std::vector<Node> items{};  ///< of an array or object, in the order of the text

  /// The member called `name`; nullptr where there is none.
  const Node* find(std::string_view name) const;
};

/// Why a text was refused, and where.
struct Refusal {
  std::vector<const Node*> path;  ///< from the root to the value that was being read
  std::string value;              ///< the offending text
  std::string problem;
  int line = 0;
  Error::Kind kind = Error::Kind::Syntax;
};

/// The values that were read, and why reading stopped where it did not get to the end.
struct Document {
  Node root;
  std::optional<Refusal> refusal;
};

/// Arrays and objects nest at most this deep.
inline constexpr std::size_t kDeepest = 64;

/// Texts are at most this long, bytes.
inline constexpr std::size_t kLongestText = std::size_t{1} << 30;

/// Reads RFC 8259 JSON. Refused besides: duplicate keys, numbers that a double cannot hold, nesting deeper
/// than `kDeepest`, byte order marks. Numbers are rounded to the nearest double; "-0" keeps its sign.
void parse(std::string_view text, Document& out);

/// `node` as short JSON for messages.
std::string excerpt(const Node& node);

}  // namespace plumb::json
