#pragma once

#include <array>
#include <cstdint>
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

/// Returns the index in `names` of the string here; throws `Error` (Name) that suggests the nearest.
std::size_t choice(const View& view, const std::string_view* names, std::size_t count);

template <std::size_t kCount>
std::size_t choice(const View& view, const std::array<std::string_view, kCount>& names) {
  return choice(view, names.data(), kCount);
}

/// An object whose keys are all known. Reading an absent optional member leaves `out` unchanged.
class Fields {
 public:
  using Keys = std::vector<std::string_view>;

  /// `what` is the thing's name for messages: "a body". Throws for a key that is not in `keys`.
  Fields(const View& view, std::string_view what, const Keys& keys);

  bool has(std::string_view key) const { return view_.node().find(key) != nullptr; }

  /// Returns the member `key`; throws if it is absent.
  View required(std::string_view key) const;

  void read(std::string_view key, double& out) const;
  void read(std::string_view key, bool& out) const;
  void read(std::string_view key, std::string& out) const;
  void read(std::string_view key, Vec2d& out) const;
  /// Reads 64 bits as a whole number; a negative one stands for its two's complement.
  void read(std::string_view key, std::uint64_t& out) const;
  void read(std::string_view key, std::int32_t& out) const;

  template <class Enum, std::size_t kCount>
  void read(std::string_view key, Enum& out, const std::array<std::string_view, kCount>& names) const {
    if (has(key)) out = static_cast<Enum>(choice(required(key), names));
  }

  /// Calls `visit` with a view of each entry of the list `key`, if present.
  template <class Visit>
  void each(std::string_view key, Visit visit) const {
    if (!has(key)) return;
    const View list = required(key);
    if (list.node().kind != Kind::Array) list.fail(Error::Kind::Syntax, "must be a list [...]");
    for (const Node& item : list.node().items) visit(View(item, list));
  }

 private:
  const View& view_;
  std::string_view what_;
};

}  // namespace plumb::json
