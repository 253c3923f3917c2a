#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/scene/scene.h"

namespace plumb::harness::case_file {

/// The names that formulas of a case file may use: `t`, constants, and the states of bodies ("ball.x").
class Names {
 public:
  /// Adds every body's state ("ball.x", ".y", ".angle", ".vx", ".vy", ".w"), its initial state ("ball.x0",
  /// ...), "ball.mass" and "ball.inertia", the length of each distance joint ("rod.length"), "gravity.x",
  /// "gravity.y" and `pi`. A character of a name that is not a letter, digit or underscore is written as an
  /// underscore.
  explicit Names(const Scene& scene);

  /// Adds a constant. Throws `Error` (Name) if the name is taken or invalid.
  void add(const std::string& name, double value);

 private:
  friend class Expression;
  enum class Kind { Constant, Time, State, Shared };
  struct Symbol {
    Kind kind = Kind::Constant;
    double value = 0;
    std::size_t body = 0;
    int component = 0;
  };
  void put(const std::string& name, const Symbol& symbol);
  std::map<std::string, Symbol> symbols_;
};

/// Returns `name` as formulas write it: "left ball" is "left_ball".
std::string formula_name(std::string_view name);

/// A formula over the names of a case file, evaluated by muparser. A plain number or name needs no library.
class Expression {
 public:
  /// Throws `Error`: Syntax for an invalid formula, Name for an unknown name, Unsupported if plumb was built
  /// without muparser.
  Expression(const std::string& text, const Names& names);

  double at(double time, std::span<const BodyState> states) const;

  /// Returns true if the value depends on `t` or on a body's state.
  bool varies() const;

 private:
  struct Parts;
  std::shared_ptr<Parts> parts_;
};

}  // namespace plumb::harness::case_file
