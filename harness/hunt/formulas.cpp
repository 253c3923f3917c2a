// Judges formulas: random ones against their value computed here, and force laws written as formulas.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "engine/scene/formula.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/random.h"
#include "harness/hunt/relations.h"
#include "harness/hunt/subject.h"

namespace plumb::harness::hunt {
namespace {

constexpr int kFormulas = 25;
constexpr double kTolerance = 1e-9;
// Error that rounding causes at the end of a function's domain (such as acos at 1): the square root of the
// rounding.
constexpr double kRootOfRounding = 1e-7;
// Relative error of a slope by finite differences, if two step widths agree to a tenth of that.
constexpr double kSlopeTolerance = 1e-5;

using Number = long double;

/// A random expression in x and y, as text and as its value computed by the standard library.
class Expression {
 public:
  Expression(Random& random, int depth) {
    const int kind = depth <= 0 ? random.whole(0, 2) : random.whole(0, 20);
    if (kind == 0) {
      number_ = random.whole(1, 40) * 0.125;
      text_ = shortest(number_), tight_ = kAtom;
      return;
    }
    if (kind <= 2) {
      name_ = kind == 1 ? 'x' : 'y', text_ = std::string(1, name_), tight_ = kAtom;
      return;
    }
    if (kind <= 8) {
      op_ = "+-*/^-"[kind - 3];
      const int own = op_ == '^' ? kPower : op_ == '*' || op_ == '/' ? kProduct : kSum;
      add(random, depth), add(random, depth);
      // A power associates to the right, the other operators to the left.
      const bool right = op_ == '^';
      text_ = inside(0, right ? own + 1 : own) + op_ + inside(1, right ? own : own + 1);
      tight_ = own;
      return;
    }
    if (kind == 9) {
      op_ = '~', add(random, depth);
      text_ = "(-" + inside(0, kPower) + ")", tight_ = kAtom;
      return;
    }
    if (kind == 10) {
      op_ = '?';
      for (int i = 0; i < 4; ++i) add(random, depth);
      text_ = fmt::format("({} < {} ? {} : {})", inside(0, kSum), inside(1, kSum), part(2), part(3));
      tight_ = kAtom;
      return;
    }
    if (kind == 11) {
      op_ = 't', add(random, depth);
      text_ = "table(" + part(0);
      double at = -3;
      for (int i = 0; i < 4; ++i) {
        at += random.within(0.5, 2);
        points_.push_back({at, random.within(-2, 2)});
        text_ += ", " + shortest(points_.back().x) + ", " + shortest(points_.back().y);
      }
      text_ += ")", tight_ = kAtom;
      return;
    }
    static constexpr const char* kOne[] = {"sin",  "cos",  "tan", "asin", "acos", "atan", "sinh",
                                           "cosh", "tanh", "exp", "ln",   "sqrt", "abs",  "log10"};
    static constexpr const char* kTwo[] = {"min", "max", "hypot", "atan2"};
    op_ = 'f';
    if (random.chance(0.75)) {
      call_ = kOne[random.whole(0, static_cast<int>(std::size(kOne)) - 1)];
      add(random, depth);
      text_ = call_ + "(" + part(0) + ")";
    } else {
      call_ = kTwo[random.whole(0, static_cast<int>(std::size(kTwo)) - 1)];
      add(random, depth), add(random, depth);
      text_ = call_ + "(" + part(0) + ", " + part(1) + ")";
    }
    tight_ = kAtom;
  }

  const std::string& text() const { return text_; }

  /// Returns the value; `largest` becomes the largest magnitude of a part, if that is larger.
  Number at(Number x, Number y, Number& largest) const {
    const Number out = value(x, y, largest);
    largest = std::isnan(out) ? INFINITY : std::max(largest, std::abs(out));
    return out;
  }

 private:
  Number value(Number x, Number y, Number& largest) const {
    if (op_ == 0) return name_ == 'x' ? x : name_ == 'y' ? y : static_cast<Number>(number_);
    std::vector<Number> v;
    for (const auto& each : parts_) v.push_back(each->at(x, y, largest));
    switch (op_) {
      case '+':
        return v[0] + v[1];
      case '-':
        return v[0] - v[1];
      case '*':
        return v[0] * v[1];
      case '/':
        return v[0] / v[1];
      case '^':
        return std::pow(v[0], v[1]);
      case '~':
        return -v[0];
      case '?':
        return v[0] < v[1] ? v[2] : v[3];
      case 't':
        return table(v[0]);
      default:
        return called(v);
    }
  }

  static constexpr int kSum = 1, kProduct = 2, kPower = 3, kAtom = 5;

  void add(Random& random, int depth) {
    parts_.push_back(std::make_unique<Expression>(random, depth - random.whole(1, 2)));
  }
  const std::string& part(std::size_t i) const { return parts_[i]->text_; }
  std::string inside(std::size_t i, int least) const {
    return parts_[i]->tight_ >= least ? part(i) : "(" + part(i) + ")";
  }
  Number table(Number x) const {
    if (!(x > points_.front().x)) return std::isnan(x) ? x : static_cast<Number>(points_.front().y);
    for (std::size_t i = 1; i < points_.size(); ++i)
      if (x <= points_[i].x) {
        const Vec2d a = points_[i - 1], b = points_[i];
        return a.y + (x - a.x) * (static_cast<Number>(b.y) - a.y) / (static_cast<Number>(b.x) - a.x);
      }
    return points_.back().y;
  }
  Number called(const std::vector<Number>& v) const {
    const Number a = v[0];
    if (call_ == "sin") return std::sin(a);
    if (call_ == "cos") return std::cos(a);
    if (call_ == "tan") return std::tan(a);
    if (call_ == "asin") return std::asin(a);
    if (call_ == "acos") return std::acos(a);
    if (call_ == "atan") return std::atan(a);
    if (call_ == "sinh") return std::sinh(a);
    if (call_ == "cosh") return std::cosh(a);
    if (call_ == "tanh") return std::tanh(a);
    if (call_ == "exp") return std::exp(a);
    if (call_ == "ln") return std::log(a);
    if (call_ == "log10") return std::log10(a);
    if (call_ == "sqrt") return std::sqrt(a);
    if (call_ == "abs") return std::abs(a);
    if (call_ == "min") return std::min(a, v[1]);
    if (call_ == "max") return std::max(a, v[1]);
    if (call_ == "hypot") return std::hypot(a, v[1]);
    return std::atan2(a, v[1]);
  }

  char op_ = 0, name_ = 0;
  int tight_ = kAtom;
  double number_ = 0;
  std::string call_, text_;
  std::vector<std::unique_ptr<Expression>> parts_;
  std::vector<Vec2d> points_;
};

std::string wrong_formula(const Expression& expression, double x, double y) {
  static constexpr std::string_view kNames[] = {"x", "y"};
  const Formula formula(expression.text(), kNames);
  // Skips values that change with the rounding of the arguments.
  Number largest = 0;
  const Number right = expression.at(x, y, largest);
  const auto slope = [&](Number h) {
    return (expression.at(x + h, y + h / 2, largest) - expression.at(x - h, y - h / 2, largest)) / (2 * h);
  };
  const Number wide = slope(1e-5L), narrow = slope(5e-6L);
  const Number scale = 1 + std::abs(right);
  if (!std::isfinite(right) || !std::isfinite(wide) || !(largest < 1e4L) || std::abs(wide) > 1e4L ||
      std::abs(wide - narrow) > kSlopeTolerance * 0.1L * (1 + std::abs(wide)))
    return {};
  const double values[] = {x, y};
  const double value = formula.at(std::span<const double>(values));
  const std::string text = expression.text();
  const bool has_ends = text.find("acos") != std::string::npos || text.find("asin") != std::string::npos ||
                        text.find("sqrt") != std::string::npos;
  const double tolerance = has_ends ? kRootOfRounding : kTolerance;
  if (std::isfinite(value) && !(std::abs(value - right) <= tolerance * scale * (1 + std::abs(wide))))
    return fmt::format("{} is {:.12g} at {}, {}, not {:.12g}", text, value, x, y, static_cast<double>(right));
  const Jet jets[] = {{x, 1}, {y, 0.5}};
  const Jet jet = formula.at(std::span<const Jet>(jets));
  if (!std::isfinite(value) || !std::isfinite(jet.first)) return {};  // a pole, or outside of a domain
  if (!(std::abs(jet.first - narrow) <= kSlopeTolerance * (1 + std::abs(narrow))))
    return fmt::format("{} has the slope {:.9g} at {}, {}, not {:.9g}", expression.text(), jet.first, x, y,
                       static_cast<double>(narrow));
  return {};
}

/// Writes persistent force laws as formulas. Returns nullopt if there is none, or if one cannot be written as
/// a formula.
std::optional<Case> as_formulas(const Case& one) {
  Case out = one;
  bool any = false;
  for (ForceLaw& law : out.scene.forces) {
    const auto number = [](double value) { return "(" + shortest(value) + ")"; };
    if (const auto* of = std::get_if<PointForce>(&law)) {
      if (of->start > 0 || std::isfinite(of->duration)) return {};
      FormulaForce made{
          .body = of->body, .x = number(of->force.x), .y = number(of->force.y), .point = of->point};
      if (of->frame == Frame::Body) {
        made.x = fmt::format("cos(angle)*{} - sin(angle)*{}", number(of->force.x), number(of->force.y));
        made.y = fmt::format("sin(angle)*{} + cos(angle)*{}", number(of->force.x), number(of->force.y));
      }
      law = made;
    } else if (const auto* drag = std::get_if<LinearDrag>(&law)) {
      law = FormulaForce{.body = drag->body,
                         .x = number(-drag->coefficient) + "*vx",
                         .y = number(-drag->coefficient) + "*vy",
                         .torque = number(-drag->angular_coefficient) + "*w"};
    } else if (const auto* quadratic = std::get_if<QuadraticDrag>(&law)) {
      law = FormulaForce{.body = quadratic->body,
                         .x = number(-quadratic->coefficient) + "*hypot(vx, vy)*vx",
                         .y = number(-quadratic->coefficient) + "*hypot(vx, vy)*vy"};
    } else if (const auto* torque = std::get_if<Torque>(&law)) {
      if (torque->start > 0 || std::isfinite(torque->duration)) return {};
      law = FormulaForce{.body = torque->body, .torque = number(torque->torque)};
    } else if (const auto* swing = std::get_if<SinusoidalForce>(&law)) {
      const std::string part =
          fmt::format("*sin({}*t + {})", number(swing->angular_frequency), number(swing->phase));
      law = FormulaForce{.body = swing->body,
                         .x = number(swing->amplitude.x) + part,
                         .y = number(swing->amplitude.y) + part,
                         .point = swing->point};
    } else if (const auto* spring = std::get_if<SpringForce>(&law)) {
      law = FormulaSpring{.body_a = spring->body_a,
                          .body_b = spring->body_b,
                          .anchor_a = spring->anchor_a,
                          .anchor_b = spring->anchor_b,
                          .tension = fmt::format("{}*(length - {}) + {}*rate", number(spring->stiffness),
                                                 number(spring->rest_length), number(spring->damping))};
    } else {
      return {};
    }
    any = true;
  }
  return any ? std::optional(out) : std::nullopt;
}

}  // namespace

Verdict formulas(const Case& one, const Engine&, const Motion&) {
  Random random(one.seed, one.index + 7);
  for (int i = 0; i < kFormulas; ++i) {
    const Expression expression(random, 4);
    const double x = random.within(-2, 2) + 0.0137, y = random.within(0.1, 3) + 0.00291;
    std::string what;
    try {
      what = wrong_formula(expression, x, y);
    } catch (const std::invalid_argument& error) {
      what = fmt::format("{} is rejected: {}", expression.text(), error.what());
    }
    if (!what.empty())
      return Objection{.law = "formulas",
                       .judge = "formulas",
                       .what = what,
                       .right = "a formula has the value of its expression and the derivative of that value"};
  }
  return {};
}

bool has_laws_as_formulas(const Case& one, const Engine& engine) {
  return engine.kind != Engine::Kind::Other && !one.world_only() && as_formulas(one).has_value();
}

// Laws that are evaluated a step late, and laws that are solved implicitly with the velocities, differ by two
// things: the displacement in a few steps, and the velocity that forces add in one step.
Verdict as_formulas_relation(const Case& one, const Engine& engine, const Motion& motion) {
  const auto other = as_formulas(one);
  if (!other || !motion.failure.empty()) return {};
  const Motion by_formulas = run(engine, *other);
  const std::vector<double> off = apart(one, motion, by_formulas);
  const std::vector<double> extent = extents(one.scene);
  double fastest = 0, hardest = 0;
  for (std::size_t k = 1; k < off.size(); ++k) {
    for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
      const BodyState &now = motion.samples[k].states[i], &before = motion.samples[k - 1].states[i];
      fastest = std::max(fastest, length(now.velocity) + extent[i] * std::abs(now.angular_velocity));
      hardest = std::max(hardest, (length(now.velocity - before.velocity) +
                                   extent[i] * std::abs(now.angular_velocity - before.angular_velocity)) /
                                      one.dt);
    }
    const double time = static_cast<double>(k) * one.dt;
    const bool precise = engine.kind == Engine::Kind::Precise;
    const double bound =
        precise ? 1e-5 * largest_size(one.scene)
                : 0.05 * largest_size(one.scene) + 2 * one.dt * fastest + one.dt * hardest * time;
    if (off[k] <= bound) continue;
    // With half the step a first-order error halves.
    if (!precise) {
      for (const auto& [scene, own] : {std::pair(&one, &motion), std::pair(&*other, &by_formulas)}) {
        const std::vector<double> change = apart(one, *own, run(engine, *scene, {.refine = 2}));
        if (k >= change.size() || change[k] > 0.25 * bound) return {};
      }
    }
    const std::vector<double> calm = growth(one, engine, motion);
    if (k >= calm.size() || calm[k] > (precise ? 0.03 * largest_size(one.scene) : 0.02 * bound)) return {};
    return Objection{.law = "as_formulas",
                     .judge = "as_formulas",
                     .what = fmt::format(
                         "differs by {:.3g} m from the motion with the same force laws as formulas", off[k]),
                     .right = "a force law and its formula give the same force",
                     .figure = off[k],
                     .bound = bound,
                     .unit = "m",
                     .time = time};
  }
  return {};
}

}  // namespace plumb::harness::hunt
