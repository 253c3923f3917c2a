#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/formula.h"

namespace plumb {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

/// Parses by recursive descent, each level of precedence in a function of its own.
class FormulaParser {
 public:
  using Code = Formula::Code;

  FormulaParser(std::string_view text, std::span<const std::string_view> variables, Formula& out)
      : text_(text), variables_(variables), out_(out) {}

  void run() {
    out_.operations_.clear();
    conditional();
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
  bool accept(std::string_view token) {
    skip_spaces();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }
  void expect(std::string_view token, std::string_view after) {
    if (accept(token)) return;
    if (at_ == text_.size()) fail("ends where '" + std::string(token) + "' is missing");
    fail("has " + quoted_here() + " where '" + std::string(token) + "' should follow " + std::string(after));
  }

  /// Appends an operation that pops `operands` values off the stack and pushes one.
  void emit(Code code, std::size_t operands, std::uint32_t index = 0, double number = 0) {
    depth_ = depth_ - operands + 1;
    if (depth_ > Formula::kMaxStack) fail("has too many pending values: nest less");
    out_.operations_.push_back({code, index, number});
  }

  // Counts nested calls, so that text with many parentheses cannot exhaust the stack.
  struct Level {
    explicit Level(int& nesting) : nesting_(nesting) {
      if (++nesting_ > 100) fail("nests more than 100 deep");
    }
    ~Level() { --nesting_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    int& nesting_;
  };

  void conditional() {
    const Level level(nesting_);
    logical_or();
    if (!accept("?")) return;
    conditional();
    expect(":", "the first value of '? :'");
    conditional();
    emit(Code::Select, 3);
  }
  void logical_or() {
    logical_and();
    while (accept("||")) logical_and(), emit(Code::Or, 2);
  }
  void logical_and() {
    comparison();
    while (accept("&&")) comparison(), emit(Code::And, 2);
  }
  void comparison() {
    sum();
    static constexpr std::pair<std::string_view, Code> kSigns[] = {
        {"<=", Code::LessEqual}, {">=", Code::GreaterEqual}, {"==", Code::Equal},
        {"!=", Code::NotEqual},  {"<", Code::Less},          {">", Code::Greater}};
    for (const auto& [sign, code] : kSigns) {
      if (!accept(sign)) continue;
      sum();
      emit(code, 2);
      return;
    }
  }
  void sum() {
    product();
    while (true) {
      if (accept("+")) {
        product(), emit(Code::Add, 2);
      } else if (accept("-")) {
        product(), emit(Code::Subtract, 2);
      } else {
        return;
      }
    }
  }
  void product() {
    signed_power();
    while (true) {
      if (accept("*")) {
        signed_power(), emit(Code::Multiply, 2);
      } else if (accept("/")) {
        signed_power(), emit(Code::Divide, 2);
      } else {
        return;
      }
    }
  }
  void signed_power() {
    const Level level(nesting_);
    if (accept("+")) return signed_power();
    if (accept("-")) {
      signed_power();
      emit(Code::Negate, 1);
      return;
    }
    value();
    if (!accept("^")) return;
    signed_power();
    emit(Code::Power, 2);
  }

  void value() {
    skip_spaces();
    if (at_ == text_.size()) fail(text_.empty() ? "is empty" : "ends where a value is missing");
    if (accept("(")) {
      conditional();
      return expect(")", "the value in parentheses");
    }
    if (is_digit(text_[at_]) || text_[at_] == '.') return emit(Code::Number, 0, 0, number());
    if (!is_letter(text_[at_])) fail("has " + quoted_here() + " where a value is missing");
    name();
  }

  double number() {
    const std::size_t length = decimal_length(text_.substr(at_));
    const std::optional<double> value = read_decimal(text_.substr(at_, length));
    if (length == 0 || !value) fail("has no number in " + quoted_here());
    at_ += length;
    return *value;
  }
  double signed_number() {
    skip_spaces();
    const bool minus = accept("-");
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
      return emit(Code::Variable, 0, static_cast<std::uint32_t>(variable - variables_.begin()));
    if (word == "pi") return emit(Code::Number, 0, 0, std::numbers::pi);
    for (const Function& function : kFunctions) {
      if (word != function.name) continue;
      expect("(", word);
      if (function.code == Code::Table) return table();
      for (int i = 0; i < function.arguments; ++i) {
        if (i > 0) expect(",", "an argument of " + std::string(word));
        conditional();
      }
      expect(")", "the arguments of " + std::string(word));
      return emit(function.code, static_cast<std::size_t>(function.arguments));
    }
    std::vector<std::string> known(variables_.begin(), variables_.end());
    known.emplace_back("pi");
    for (const Function& function : kFunctions) known.emplace_back(function.name);
    fail("has an unknown name, '" + std::string(word) + "'" + did_you_mean(word, known));
  }

  void table() {
    conditional();
    std::vector<Formula::Point> points;
    while (accept(",")) {
      const double x = signed_number();
      expect(",", "the x of a point of the table");
      points.push_back({x, signed_number()});
      if (points.size() > 1 && !(points[points.size() - 2].x < x))
        fail("has a table whose x do not ascend: " + std::to_string(x));
    }
    expect(")", "the last point of the table");
    if (points.size() < 2) fail("has a table of fewer than two points");
    emit(Code::Table, 1, static_cast<std::uint32_t>(out_.tables_.size()));
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

}  // namespace plumb
