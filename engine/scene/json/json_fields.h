#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/math/vec2.h"
#include "engine/scene/json/json_document.h"

/// Typed reading of JSON values, with errors that name the place and the problem.
namespace plumb::json {

/// A value together with the path to it from the root. Lives on the stack; its parent view must outlive it.
class View {
 public:
  explicit View(const Node& root) : node_(&root) {}
  View(const Node& node, const View& parent) : node_(&node), parent_(&parent) {}

  const Node& node() const { return *node_; }

  /// Returns the path from the root to here.
  std::vector<const Node*> path() const;

  /// Throws `Error` about this value: its subject, field, excerpt and line.
  [[noreturn]] void fail(Error::Kind kind, const std::string& problem) const;

  /// Same as `fail`, at another line: that of a vector's component.
  [[noreturn]] void fail_at(int line, Error::Kind kind, const std::string& problem) const;

 private:
  const Node* node_;
  const View* parent_ = nullptr;
};

double number(const View& view);
bool boolean(const View& view);
std::string string(const View& view);
Vec2d vector(const View& view);

/// Reads a whole number from `lowest` to `highest`.
double integer(const View& view, double lowest, double highest);

/// Reads 64 bits as a whole number; a negative one stands for its two's complement.
std::uint64_t bits(const View& view);

/// Returns the index in `names` of the string here; otherwise throws `Error` (Name) that suggests the nearest
/// name.
std::size_t choice(const View& view, std::span<const std::string_view> names);

/// Calls `visit` with a view of each entry of the list here. If this is not a list, throws with the message
/// `problem`.
template <class Visit>
void each(const View& view, const char* problem, const Visit& visit) {
  if (view.node().kind != Kind::Array) view.fail(Error::Kind::Syntax, problem);
  for (const Node& item : view.node().items) visit(View(item, view));
}

/// An object whose keys are all known.
class Fields {
 public:
  using Keys = std::vector<std::string_view>;

  /// `what` is the thing's name for messages: "a body". Throws for a key that is not in `keys`.
  Fields(const View& view, std::string_view what, const Keys& keys);

  bool has(std::string_view key) const { return view_.node().find(key) != nullptr; }

  /// Returns the member `key`; throws if it is absent.
  View required(std::string_view key) const;

 private:
  const View& view_;
  std::string_view what_;
};

}  // namespace plumb::json
