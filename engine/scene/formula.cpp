#include "engine/scene/formula.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
      case Code::LessEqual:
        compare([](double a, double b) { return a <= b; });
        break;
      case Code::GreaterEqual:
        compare([](double a, double b) { return a >= b; });
        break;
      case Code::Equal:
        compare([](double a, double b) { return a == b; });
        break;
      case Code::NotEqual:
        compare([](double a, double b) { return a != b; });
        break;
      case Code::And:
        compare([](double a, double b) { return a != 0 && b != 0; });
        break;
      case Code::Or:
        compare([](double a, double b) { return a != 0 || b != 0; });
        break;
      case Code::Select:
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
        last = sqrt_of(last);
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
        two([](const Value& a, const Value& b) { return sqrt_of(a * a + b * b); });
        break;
      case Code::Mod:
        two([](const Value& a, const Value& b) { return modulo_of(a, b); });
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