#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/math/jet.h"

namespace plumb {

namespace formula {
/// A point of a table.
struct Point {
  double x = 0, y = 0;
};
}  // namespace formula

/// A function that is given as text, such as "0.1*sin(50*t)": numbers, variables, `+ - * / ^`, parentheses,
/// comparisons, `&& ||`, `a ? b : c`, `pi`, the functions
///   sin cos tan asin acos atan atan2 sinh cosh tanh exp ln log10 sqrt abs sign min max hypot mod floor
/// and table(x, x0, y0, x1, y1, ...), straight lines between the given numbers with ascending x0, x1, ...,
/// constant beyond its ends. Angles are in rad. Values have the same bits on every platform, and derivatives
/// follow from the rules of differentiation. Evaluation does not allocate.
class Formula {
 public:
  /// Zero.
  Formula() = default;

  /// Parses `text`; the values of `variables` are given to `at` in the same order. Throws
  /// std::invalid_argument, which says what is wrong.
  Formula(std::string_view text, std::span<const std::string_view> variables);

  double at(std::span<const double> variables) const;
  /// Returns the value and its derivatives along the direction of the variables' derivatives.
  Jet at(std::span<const Jet> variables) const;

  /// Returns true if the value depends on this variable.
  bool uses(std::size_t variable) const;

  /// Facts about a formula over an interval of its first variable, a time. A decision is a comparison,
  /// case, piece of a table or whole part by which the time selects what is computed; those that also depend
  /// on other variables do not count. The shorter the interval, the sharper it is.
  struct Survey {
    bool decided = true;          ///< all decisions are the same at all times of the interval
    std::uint64_t decisions = 0;  ///< a hash of them, if they are
    double low = 0, high = 0;     ///< contain all values
  };
  Survey survey(double from, double to) const;
  /// Does the same for a box of all variables, all of whose decisions count.
  Survey survey(std::span<const double> low, std::span<const double> high) const;
  bool has_decisions() const;

  /// More than this many pending values are refused: "1+(2+(3+...".
  static constexpr std::size_t kMaxStack = 64;

 private:
  friend class FormulaParser;
  enum class Code : std::uint8_t {
    Number,
    Variable,
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    Greater,
    LessEqual,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Select,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Abs,
    Sign,
    Min,
    Max,
    Hypot,
    Mod,
    Floor,
    Table,
  };
  struct Operation {
    Code code = Code::Number;
    std::uint32_t index = 0;  // of a variable or table
    double number = 0;
  };
  using Point = formula::Point;

  template <class Value>
  Value evaluate(std::span<const Value> variables) const;

  std::vector<Operation> operations_{{}};  // in reverse Polish notation
  std::vector<std::vector<Point>> tables_;
};

}  // namespace plumb
