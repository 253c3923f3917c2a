#include "engine/precise/dynamics/formula_switches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

namespace plumb::precise {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Duration of one search, s, and number of intervals that it looks at in one formula. A formula whose
// decisions stay open however short the interval is (such as a comparison of equal values) is smooth as far
// as the search knows, after which step-size control alone treats it.
constexpr double kHorizon = 1e6;
constexpr int kMaxIntervals = 20000;
// Shortest piece that is found, s, relative to a time after 1 s.
constexpr double kShortest = 1e-9;

/// A search for the first change of a formula's decisions.
class Search {
 public:
  explicit Search(const Formula& formula) : formula_(formula) {}

  /// Returns the first time in (from, to] with other decisions than shortly before it.
  std::optional<double> first(double from, double to) {
    if (++looked_at_ > kMaxIntervals || formula_.survey(from, to).decided) return std::nullopt;
    const double middle = from + 0.5 * (to - from);
    const bool adjacent = !(from < middle && middle < to);
    if (adjacent || to - from < kShortest * std::max(1.0, std::abs(from))) {
      if (formula_.survey(from, from).decisions == formula_.survey(to, to).decisions) return std::nullopt;
      if (adjacent) return to;
    }
    if (const std::optional<double> found = first(from, middle)) return found;
    return first(middle, to);
  }

 private:
  const Formula& formula_;
  int looked_at_ = 0;
};

/// A stretch of time over which a step might pass a rise and fall of a formula.
class QuietTime {
 public:
  QuietTime(const Formula& formula, double from, double to) : formula_(formula), from_(from), to_(to) {
    const double first = at(from), last = at(to);
    constexpr double kRounding = 1e-12;
    const double width = std::abs(last - first) + kRounding * std::max(std::abs(first), std::abs(last));
    low_ = std::min(first, last) - width, high_ = std::max(first, last) + width;
  }

  /// Returns true if a step can miss nothing: no value leaves those of the ends by more than their range, or
  /// the formula is busy most of the time, so that some evaluations of any step see it.
  bool is_seen() const {
    constexpr int kHalvings = 6;
    return is_within(from_, to_, kHalvings) || is_busy();
  }

 private:
  double at(double time) const { return formula_.survey(time, time).low; }
  bool is_within(double from, double to, int halvings) const {
    const Formula::Survey all = formula_.survey(from, to);
    if (low_ <= all.low && all.high <= high_) return true;
    const double middle = from + 0.5 * (to - from), value = at(middle);
    if (halvings == 0 || !(low_ <= value && value <= high_)) return false;
    return is_within(from, middle, halvings - 1) && is_within(middle, to, halvings - 1);
  }
  bool is_busy() const {
    const Formula::Survey all = formula_.survey(from_, to_);
    // A pole says nothing of what is far from it.
    if (!std::isfinite(all.low) || !std::isfinite(all.high)) return true;
    // Fractions of the golden ratio, which are in step with no period.
    constexpr int kSamples = 32;
    constexpr double kGolden = 0.6180339887498949, kQuiet = 0.05;
    int quiet = 0;
    const double first = at(from_);
    for (int i = 1; i <= kSamples; ++i) {
      const double value = at(from_ + std::fmod(i * kGolden, 1.0) * (to_ - from_));
      quiet += std::abs(value - first) <= kQuiet * (all.high - all.low) ? 1 : 0;
    }
    return 2 * quiet < kSamples;
  }

  const Formula& formula_;
  double from_, to_;
  double low_ = 0, high_ = 0;
};

}  // namespace

FormulaSwitches::FormulaSwitches(const Scene& scene) {
  const auto add = [&](const std::string& text, std::span<const std::string_view> variables) {
    if (text.empty()) return;
    Formula formula(text, variables);
    if (!formula.uses(0)) return;
    bool alone = true;
    for (std::size_t i = 1; i < variables.size(); ++i) alone = alone && !formula.uses(i);
    if (alone || formula.has_decisions()) formulas_.push_back({std::move(formula), alone});
  };
  for (const Body& body : scene.bodies)
    for (const std::string& text : {body.motion.x, body.motion.y, body.motion.angle})
      add(text, kTimeVariable);
  for (const Drive& drive : scene.drives) add(drive.speed, kTimeVariable);
  for (const ForceLaw& law : scene.forces) {
    std::visit(
        [&](const auto& l) {
          using Law = std::decay_t<decltype(l)>;
          if constexpr (std::is_same_v<Law, FormulaForce>)
            for (const std::string& text : {l.x, l.y, l.torque}) add(text, kForceVariables);
          if constexpr (std::is_same_v<Law, FormulaSpring>) add(l.tension, kSpringVariables);
        },
        law);
  }
}

double FormulaSwitches::next(double time) {
  if (formulas_.empty()) return kInfinity;
  if (after_ <= time && time < end_) return end_;
  double end = time + kHorizon;
  for (const Entry& entry : formulas_) end = Search(entry.formula).first(time, end).value_or(end);
  const double shortest = kShortest * std::max(1.0, std::abs(time));
  for (const Entry& entry : formulas_) {
    if (!entry.of_time_alone) continue;
    // Up to a switch, not at it.
    while (end - time > shortest &&
           !QuietTime(entry.formula, time, std::nextafter(end, -kInfinity)).is_seen())
      end = time + 0.5 * (end - time);
  }
  restore(time, end);
  return end_;
}

}  // namespace plumb::precise
