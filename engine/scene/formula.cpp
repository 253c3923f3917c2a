#include "engine/scene/formula.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/core/suggest.h"
#include "engine/math/arc_tangent.h"
#include "engine/math/exponential.h"
#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

double value_of(double a) { return a; }
double value_of(const Jet& a) { return a.value; }

double through(double, double f, double, double) { return f; }

double hyperbolic_sine(double x) {
  if (std::abs(x) < 0.25) {
    // x + x^3/3! + ... + x^13/13!, without the cancellation of e^x - e^-x.
    double sum = 0;
    for (int n = 12; n >= 2; n -= 2) sum = (1 + sum) * (x * x / (n * (n + 1)));
    return x + x * sum;
  }
  const double grown = exponential(0.5 * std::abs(x));
  const double size = 0.5 * grown * grown - 0.5 / (grown * grown);
  return x < 0 ? -size : size;
}
double hyperbolic_cosine(double x) {
  const double grown = exponential(0.5 * std::abs(x));
  return 0.5 * grown * grown + 0.5 / (grown * grown);
}
double hyperbolic_tangent(double x) {
  if (std::abs(x) > 20) return x > 0 ? 1 : -1;  // the rest is below rounding
  return hyperbolic_sine(x) / hyperbolic_cosine(x);
}

// Functions of a number or a jet: the value, and the first two derivatives where they are wanted.
template <class V>
V sine(V a) {
  const Rotation<double> turn = rotation_of(value_of(a));
  return through(a, turn.s, turn.c, -turn.s);
}
template <class V>
V cosine(V a) {
  const Rotation<double> turn = rotation_of(value_of(a));
  return through(a, turn.c, -turn.s, -turn.c);
}
template <class V>
V tangent(V a) {
  const Rotation<double> turn = rotation_of(value_of(a));
  const double tan = turn.s / turn.c, slope = 1 + tan * tan;
  return through(a, tan, slope, 2 * tan * slope);
}
template <class V>
V arc_sine(V a) {
  const double x = value_of(a), rest = (1 - x) * (1 + x), root = std::sqrt(rest);
  return through(a, rest < 0 ? root : arc_tangent(x, root), 1 / root, x / (rest * root));
}
template <class V>
V arc_cosine(V a) {
  const double x = value_of(a), rest = (1 - x) * (1 + x), root = std::sqrt(rest);
  return through(a, rest < 0 ? root : arc_tangent(root, x), -1 / root, -x / (rest * root));
}
template <class V>
V arc_tangent_of(V a) {
  const double x = value_of(a), slope = 1 / (1 + x * x);
  return through(a, arc_tangent(x, 1), slope, -2 * x * slope * slope);
}
template <class V>
V exponential_of(V a) {
  const double grown = exponential(value_of(a));
  return through(a, grown, grown, grown);
}
template <class V>
V logarithm_of(V a, double unit) {
  const double x = value_of(a);
  return through(a, logarithm(x) / unit, 1 / (unit * x), -1 / (unit * x * x));
}
// At 0 the slope is taken as 0, so that sqrt(x^2 + y^2) has a derivative everywhere.
template <class V>
V root_of(V a) {
  const double root = std::sqrt(value_of(a));
  const double slope = root > 0 ? 0.5 / root : 0;
  return through(a, root, slope, root > 0 ? -0.5 * slope / (root * root) : 0);
}
template <class V>
V sinh_of(V a) {
  const double s = hyperbolic_sine(value_of(a)), c = hyperbolic_cosine(value_of(a));
  return through(a, s, c, s);
}
template <class V>
V cosh_of(V a) {
  const double s = hyperbolic_sine(value_of(a)), c = hyperbolic_cosine(value_of(a));
  return through(a, c, s, c);
}
template <class V>
V tanh_of(V a) {
  const double t = hyperbolic_tangent(value_of(a)), slope = 1 - t * t;
  return through(a, t, slope, -2 * t * slope);
}

double arc_tangent_of(double y, double x) { return arc_tangent(y, x); }
// d atan2(y, x) = (x dy - y dx) / r^2.
Jet arc_tangent_of(Jet y, Jet x) {
  const Jet slope = (x * Jet(y.first, y.second) - y * Jet(x.first, x.second)) / (x * x + y * y);
  return {arc_tangent(y.value, x.value), slope.value, slope.first};
}

double power_of(double a, double b) { return power(a, b); }
Jet power_of(Jet a, Jet b) {
  const double value = power(a.value, b.value);
  if (b.first == 0 && b.second == 0) {
    const double n = b.value;
    const double slope = n == 0 ? 0 : n * power(a.value, n - 1);
    const double curve = n == 0 || n == 1 ? 0 : n * (n - 1) * power(a.value, n - 2);
    return through(a, value, slope, curve);
  }
  Jet grown = exponential_of(b * logarithm_of(a, 1));
  grown.value = value;
  return grown;
}

double rest_of(double a, double b) { return a - b * std::floor(a / b); }
Jet rest_of(Jet a, Jet b) { return a - b * Jet(std::floor(a.value / b.value)); }

}  // namespace

/// Parses by recursive descent, each level of precedence in a function of its own.
class FormulaParser {
 public:
  using Code = Formula::Code;

  FormulaParser(std::string_view text, std::span<const std::string_view> variables, Formula& out)
      : text_(text), variables_(variables), out_(out) {}

  void run() {
    out_.operations_.clear();
    choice();
    skip_spaces();
    if (at_ < text_.size()) fail("has " + quoted_here() + " after its end");
  }

 private:
  struct Function {
    std::string_view name;
    int arguments;
    Code code;
  };
  static constexpr std::array kFunctions{
      Function{"sin", 1, Code::Sin},     Function{"cos", 1, Code::Cos},   Function{"tan", 1, Code::Tan},
      Function{"asin", 1, Code::Asin},   Function{"acos", 1, Code::Acos}, Function{"atan", 1, Code::Atan},
      Function{"atan2", 2, Code::Atan2}, Function{"sinh", 1, Code::Sinh}, Function{"cosh", 1, Code::Cosh},
      Function{"tanh", 1, Code::Tanh},   Function{"exp", 1, Code::Exp},   Function{"ln", 1, Code::Ln},
      Function{"log10", 1, Code::Log10}, Function{"sqrt", 1, Code::Sqrt}, Function{"abs", 1, Code::Abs},
      Function{"sign", 1, Code::Sign},   Function{"min", 2, Code::Min},   Function{"max", 2, Code::Max},
      Function{"hypot", 2, Code::Hypot}, Function{"mod", 2, Code::Mod},   Function{"floor", 1, Code::Floor},
      Function{"table", -1, Code::Table}};

  [[noreturn]] static void fail(const std::string& what) { throw std::invalid_argument(what); }

  std::string quoted_here() const {
    return "'" + std::string(text_.substr(at_, 20)) + "' at character " + std::to_string(at_ + 1);
  }

  void skip_spaces() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool take(std::string_view token) {
    skip_spaces();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }
  void expect(std::string_view token, std::string_view after) {
    if (take(token)) return;
    if (at_ == text_.size()) fail("ends where '" + std::string(token) + "' is missing");
    fail("has " + quoted_here() + " where '" + std::string(token) + "' should follow " + std::string(after));
  }

  /// Appends an operation that takes `taken` values off the stack and leaves one.
  void put(Code code, std::size_t taken, std::uint32_t index = 0, double number = 0) {
    depth_ = depth_ - taken + 1;
    if (depth_ > Formula::kDeepest) fail("has too many pending values: nest less");
    out_.operations_.push_back({code, index, number});
  }

  // Counts calls within calls, so that text of many parentheses cannot exhaust the stack.
  struct Level {
    explicit Level(int& nesting) : nesting_(nesting) {
      if (++nesting_ > 100) fail("nests more than 100 deep");
    }
    ~Level() { --nesting_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    int& nesting_;
  };

  void choice() {
    const Level level(nesting_);
    either();
    if (!take("?")) return;
    choice();
    expect(":", "the first value of '? :'");
    choice();
    put(Code::Choose, 3);
  }
  void either() {
    both();
    while (take("||")) both(), put(Code::Or, 2);
  }
  void both() {
    comparison();
    while (take("&&")) comparison(), put(Code::And, 2);
  }
  void comparison() {
    sum();
    static constexpr std::pair<std::string_view, Code> kSigns[] = {
        {"<=", Code::AtMost},    {">=", Code::AtLeast}, {"==", Code::Equal},
        {"!=", Code::Different}, {"<", Code::Less},     {">", Code::Greater}};
    for (const auto& [sign, code] : kSigns) {
      if (!take(sign)) continue;
      sum();
      put(code, 2);
      return;
    }
  }
  void sum() {
    product();
    while (true) {
      if (take("+")) {
        product(), put(Code::Add, 2);
      } else if (take("-")) {
        product(), put(Code::Subtract, 2);
      } else {
        return;
      }
    }
  }
  void product() {
    signed_power();
    while (true) {
      if (take("*")) {
        signed_power(), put(Code::Multiply, 2);
      } else if (take("/")) {
        signed_power(), put(Code::Divide, 2);
      } else {
        return;
      }
    }
  }
  void signed_power() {
    const Level level(nesting_);
    if (take("+")) return signed_power();
    if (take("-")) {
      signed_power();
      put(Code::Negate, 1);
      return;
    }
    value();
    if (!take("^")) return;
    signed_power();
    put(Code::Power, 2);
  }

  void value() {
    skip_spaces();
    if (at_ == text_.size()) fail(text_.empty() ? "is empty" : "ends where a value is missing");
    if (take("(")) {
      choice();
      return expect(")", "the value in parentheses");
    }
    if (is_digit(text_[at_]) || text_[at_] == '.') return put(Code::Number, 0, 0, number());
    if (!is_letter(text_[at_])) fail("has " + quoted_here() + " where a value is missing");
    name();
  }

  double number() {
    const char* const begin = text_.data() + at_;
    double value = 0;
    const auto [stop, failure] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (failure != std::errc{}) fail("has no number in " + quoted_here());
    at_ += static_cast<std::size_t>(stop - begin);
    return value;
  }
  double signed_number() {
    skip_spaces();
    const bool minus = take("-");
    skip_spaces();
    if (at_ == text_.size() || !(is_digit(text_[at_]) || text_[at_] == '.'))
      fail("has a table with something other than numbers" +
           (at_ < text_.size() ? ": " + quoted_here() : std::string{}));
    return minus ? -number() : number();
  }

  void name() {
    const std::size_t start = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '.')) ++at_;
    const std::string_view word = text_.substr(start, at_ - start);
    const auto variable = std::find(variables_.begin(), variables_.end(), word);
    if (variable != variables_.end())
      return put(Code::Variable, 0, static_cast<std::uint32_t>(variable - variables_.begin()));
    if (word == "pi") return put(Code::Number, 0, 0, std::numbers::pi);
    for (const Function& function : kFunctions) {
      if (word != function.name) continue;
      expect("(", word);
      if (function.code == Code::Table) return table();
      for (int i = 0; i < function.arguments; ++i) {
        if (i > 0) expect(",", "an argument of " + std::string(word));
        choice();
      }
      expect(")", "the arguments of " + std::string(word));
      return put(function.code, static_cast<std::size_t>(function.arguments));
    }
    std::vector<std::string> known(variables_.begin(), variables_.end());
    known.emplace_back("pi");
    for (const Function& function : kFunctions) known.emplace_back(function.name);
    fail("has an unknown name, '" + std::string(word) + "'" + did_you_mean(word, known));
  }

  void table() {
    choice();
    std::vector<Formula::Point> points;
    while (take(",")) {
      const double x = signed_number();
      expect(",", "the x of a point of the table");
      points.push_back({x, signed_number()});
      if (points.size() > 1 && !(points[points.size() - 2].x < x))
        fail("has a table whose x do not ascend: " + std::to_string(x));
    }
    expect(")", "the last point of the table");
    if (points.size() < 2) fail("has a table of fewer than two points");
    put(Code::Table, 1, static_cast<std::uint32_t>(out_.tables_.size()));
    out_.tables_.push_back(std::move(points));
  }

  std::string_view text_;
  std::span<const std::string_view> variables_;
  Formula& out_;
  std::size_t at_ = 0, depth_ = 0;
  int nesting_ = 0;
};

Formula::Formula(std::string_view text, std::span<const std::string_view> variables) {
  FormulaParser(text, variables, *this).run();
}

template <class Value>
Value Formula::evaluate(std::span<const Value> variables) const {
  std::array<Value, kDeepest + 2> stack{};
  Value* top = stack.data() + 1;  // one past the last value; the first is never read
  const auto two = [&](auto&& apply) {
    --top;
    top[-1] = apply(top[-1], top[0]);
  };
  const auto compare = [&](auto&& holds) {
    two([&](const Value& a, const Value& b) { return Value(holds(value_of(a), value_of(b)) ? 1.0 : 0.0); });
  };
  for (const Operation& operation : operations_) {
    Value& last = top[-1];
    switch (operation.code) {
      case Code::Number:
        *top++ = Value(operation.number);
        break;
      case Code::Variable:
        *top++ = variables[operation.index];
        break;
      case Code::Negate:
        last = -last;
        break;
      case Code::Add:
        two([](const Value& a, const Value& b) { return a + b; });
        break;
      case Code::Subtract:
        two([](const Value& a, const Value& b) { return a - b; });
        break;
      case Code::Multiply:
        two([](const Value& a, const Value& b) { return a * b; });
        break;
      case Code::Divide:
        two([](const Value& a, const Value& b) { return a / b; });
        break;
      case Code::Power:
        two([](const Value& a, const Value& b) { return power_of(a, b); });
        break;
      case Code::Less:
        compare([](double a, double b) { return a < b; });
        break;
      case Code::Greater:
        compare([](double a, double b) { return a > b; });
        break;
      case Code::AtMost:
        compare([](double a, double b) { return a <= b; });
        break;
      case Code::AtLeast:
        compare([](double a, double b) { return a >= b; });
        break;
      case Code::Equal:
        compare([](double a, double b) { return a == b; });
        break;
      case Code::Different:
        compare([](double a, double b) { return a != b; });
        break;
      case Code::And:
        compare([](double a, double b) { return a != 0 && b != 0; });
        break;
      case Code::Or:
        compare([](double a, double b) { return a != 0 || b != 0; });
        break;
      case Code::Choose:
        top -= 2;
        top[-1] = value_of(top[-1]) != 0 ? top[0] : top[1];
        break;
      case Code::Sin:
        last = sine(last);
        break;
      case Code::Cos:
        last = cosine(last);
        break;
      case Code::Tan:
        last = tangent(last);
        break;
      case Code::Asin:
        last = arc_sine(last);
        break;
      case Code::Acos:
        last = arc_cosine(last);
        break;
      case Code::Atan:
        last = arc_tangent_of(last);
        break;
      case Code::Atan2:
        two([](const Value& a, const Value& b) { return arc_tangent_of(a, b); });
        break;
      case Code::Sinh:
        last = sinh_of(last);
        break;
      case Code::Cosh:
        last = cosh_of(last);
        break;
      case Code::Tanh:
        last = tanh_of(last);
        break;
      case Code::Exp:
        last = exponential_of(last);
        break;
      case Code::Ln:
        last = logarithm_of(last, 1);
        break;
      case Code::Log10:
        last = logarithm_of(last, std::numbers::ln10);
        break;
      case Code::Sqrt:
        last = root_of(last);
        break;
      case Code::Abs:
        last = value_of(last) < 0 ? -last : last;
        break;
      case Code::Sign:
        last = Value(value_of(last) > 0 ? 1.0 : value_of(last) < 0 ? -1.0 : 0.0);
        break;
      case Code::Min:
        two([](const Value& a, const Value& b) { return value_of(b) < value_of(a) ? b : a; });
        break;
      case Code::Max:
        two([](const Value& a, const Value& b) { return value_of(b) > value_of(a) ? b : a; });
        break;
      case Code::Hypot:
        two([](const Value& a, const Value& b) { return root_of(a * a + b * b); });
        break;
      case Code::Mod:
        two([](const Value& a, const Value& b) { return rest_of(a, b); });
        break;
      case Code::Floor:
        last = Value(std::floor(value_of(last)));
        break;
      case Code::Table: {
        const std::vector<Point>& points = tables_[operation.index];
        const double x = value_of(last);
        if (!(x > points.front().x)) {
          last = Value(std::isnan(x) ? x : points.front().y);
        } else if (x >= points.back().x) {
          last = Value(points.back().y);
        } else {
          const auto next = std::upper_bound(points.begin(), points.end(), x,
                                             [](double value, const Point& p) { return value < p.x; });
          const Point& from = next[-1];
          const double slope = (next->y - from.y) / (next->x - from.x);
          last = through(last, from.y + slope * (x - from.x), slope, 0);
        }
        break;
      }
    }
  }
  return top[-1];
}

double Formula::at(std::span<const double> variables) const { return evaluate(variables); }
Jet Formula::at(std::span<const Jet> variables) const { return evaluate(variables); }

bool Formula::uses(std::size_t variable) const {
  return std::any_of(operations_.begin(), operations_.end(), [&](const Operation& operation) {
    return operation.code == Code::Variable && operation.index == variable;
  });
}

}  // namespace plumb
