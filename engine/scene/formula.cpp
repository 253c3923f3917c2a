#include "engine/scene/formula.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/scene/formula_decisions.h"
#include "engine/scene/formula_functions.h"

namespace plumb {

template <class Value>
Value Formula::evaluate(std::span<const Value> variables) const {
  using namespace formula;
  std::array<Value, kMaxStack + 2> stack{};
  Value* top = stack.data() + 1;  // one past the last value; value 0 is never read
  const auto two = [&](auto&& apply) {
    --top;
    top[-1] = apply(top[-1], top[0]);
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
        two([](const Value& a, const Value& b) { return less(a, b); });
        break;
      case Code::Greater:
        two([](const Value& a, const Value& b) { return less(b, a); });
        break;
      case Code::LessEqual:
        two([](const Value& a, const Value& b) { return at_most(a, b); });
        break;
      case Code::GreaterEqual:
        two([](const Value& a, const Value& b) { return at_most(b, a); });
        break;
      case Code::Equal:
        two([](const Value& a, const Value& b) { return equal(a, b); });
        break;
      case Code::NotEqual:
        two([](const Value& a, const Value& b) { return opposite(equal(a, b)); });
        break;
      case Code::And:
        two([](const Value& a, const Value& b) { return both(a, b); });
        break;
      case Code::Or:
        two([](const Value& a, const Value& b) { return opposite(both(opposite(a), opposite(b))); });
        break;
      case Code::Select:
        top -= 2;
        top[-1] = select(top[-1], top[0], top[1]);
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
        last = sqrt_of(last);
        break;
      case Code::Abs:
        last = absolute(last);
        break;
      case Code::Sign:
        last = sign_of(last);
        break;
      case Code::Min:
        two([](const Value& a, const Value& b) { return smaller(a, b); });
        break;
      case Code::Max:
        two([](const Value& a, const Value& b) { return larger(a, b); });
        break;
      case Code::Hypot:
        two([](const Value& a, const Value& b) { return sqrt_of(a * a + b * b); });
        break;
      case Code::Mod:
        two([](const Value& a, const Value& b) { return modulo_of(a, b); });
        break;
      case Code::Floor:
        last = floor_of(last);
        break;
      case Code::Table:
        last = through_points(last, std::span<const Point>(tables_[operation.index]));
        break;
    }
  }
  return top[-1];
}

double Formula::at(std::span<const double> variables) const { return evaluate(variables); }
Jet Formula::at(std::span<const Jet> variables) const { return evaluate(variables); }

// Maximum number of variables of a formula of a scene.
constexpr std::size_t kMaxVariables = 8;

Formula::Survey Formula::survey(double from, double to) const {
  std::array<formula::Ranged, kMaxVariables> variables{};
  for (formula::Ranged& variable : variables)
    variable.value = Interval::everything(), variable.of_motion = true;
  variables[0] = formula::Ranged(Interval(from, to));
  const formula::Ranged out = evaluate(std::span<const formula::Ranged>(variables));
  return {!out.undecided, out.decisions, out.value.low, out.value.high};
}

Formula::Survey Formula::survey(std::span<const double> low, std::span<const double> high) const {
  std::array<formula::Ranged, kMaxVariables> variables{};
  for (std::size_t i = 0; i < low.size(); ++i) variables[i] = formula::Ranged(Interval(low[i], high[i]));
  const formula::Ranged out = evaluate(std::span<const formula::Ranged>(variables));
  return {!out.undecided, out.decisions, out.value.low, out.value.high};
}

bool Formula::has_decisions() const {
  return std::any_of(operations_.begin(), operations_.end(), [](const Operation& operation) {
    switch (operation.code) {
      case Code::Less:
      case Code::Greater:
      case Code::LessEqual:
      case Code::GreaterEqual:
      case Code::Equal:
      case Code::NotEqual:
      case Code::Atan2:
      case Code::Abs:
      case Code::Sign:
      case Code::Min:
      case Code::Max:
      case Code::Mod:
      case Code::Floor:
      case Code::Table:
        return true;
      default:
        return false;
    }
  });
}

bool Formula::uses(std::size_t variable) const {
  return std::any_of(operations_.begin(), operations_.end(), [&](const Operation& operation) {
    return operation.code == Code::Variable && operation.index == variable;
  });
}

}  // namespace plumb