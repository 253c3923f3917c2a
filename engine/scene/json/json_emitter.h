#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/math/vec2.h"

namespace plumb::json {

/// Writes JSON front to back. With `indent` >= 0, arrays and objects have one entry per line, except those
/// opened as `Inline`; otherwise all is one line without spaces.
class Emitter {
 public:
  enum class Layout { Block, Inline };

  /// Takes the text piece by piece.
  using Sink = std::function<void(std::string_view)>;

  /// Keeps the text for `take`.
  explicit Emitter(int indent) : indent_(indent) {}
  /// Hands the text to `sink`, so that a large one is never whole in memory; `take` returns the last piece.
  Emitter(int indent, Sink sink) : indent_(indent), sink_(std::move(sink)) {}

  void begin(char bracket, Layout layout = Layout::Block);  ///< '{' or '['
  void end(char bracket);                                   ///< '}' or ']'
  void key(std::string_view name);

  void number(double value);
  void integer(std::int64_t value);
  void boolean(bool value);
  void string(std::string_view value);
  void vector(Vec2d value);

  /// Returns true if a value has no JSON form: a non-finite number or a string that is not UTF-8.
  bool failed() const { return failed_; }

  std::string take() { return std::move(out_); }

 private:
  struct Level {
    bool block = false;
    bool empty = true;
  };

  void separate();  ///< writes the separator between two entries
  void new_line();

  int indent_;
  Sink sink_;
  std::string out_;
  std::vector<Level> levels_;
  bool after_key_ = false;
  bool failed_ = false;
};

}  // namespace plumb::json
