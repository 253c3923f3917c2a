#include <algorithm>
#include <numbers>
#include <vector>

#include "engine/precise/integration/integrator.h"

// Formulas of the motion with several pieces: `x > 3 && x < 3.1 ? -5 : 0`. Step-size control resolves the
// border of a zone only if some evaluation of a step has been inside. A step that has entered and left a zone
// is therefore repeated up to the middle of the zone.
namespace plumb::precise {
namespace {

// Shortest time in a zone that is found, as a fraction of the step.
constexpr double kShortestPiece = 1e-9;
// Number of intervals of a step that are looked at in one formula. Decisions that stay open however short the
// interval (at rest on a border) are left to step-size control.
constexpr int kMaxIntervals = 2000;
// Variables of a force, of which the angle is in [-pi, pi].
constexpr std::size_t kForceCount = 8, kAngle = 3;

/// The decisions of one formula along the path of a step.
template <class VariablesAt>
class PathPieces {
 public:
  PathPieces(const Formula& formula, VariablesAt& variables_at, double shortest)
      : formula_(formula), at_(variables_at), shortest_(shortest) {}

  /// Returns the first time in (from, to] with other decisions than shortly before it.
  std::optional<double> first_change(double from, double to) {
    if (++looked_at_ > kMaxIntervals || survey(from, to).decided) return std::nullopt;
    if (to - from < shortest_) {
      const bool same = survey(from, from).decisions == survey(to, to).decisions;
      return same ? std::nullopt : std::optional(to);
    }
    const double middle = from + 0.5 * (to - from);
    if (const std::optional<double> found = first_change(from, middle)) return found;
    return first_change(middle, to);
  }

 private:
  /// Bounds the variables by those at three times. A step's path turns little, so that it leaves their hull
  /// by less than a quarter of its width. The time does not leave it.
  Formula::Survey survey(double from, double to) {
    std::vector<double> low = at_(from), high = low;
    if (to > from) {
      for (const double time : {from + 0.5 * (to - from), to}) {
        const std::vector<double>& now = at_(time);
        for (std::size_t i = 0; i < low.size(); ++i)
          low[i] = std::min(low[i], now[i]), high[i] = std::max(high[i], now[i]);
      }
      for (std::size_t i = 1; i < low.size(); ++i) {
        const double margin = 0.25 * (high[i] - low[i]);
        low[i] -= margin, high[i] += margin;
      }
      if (low.size() == kForceCount && high[kAngle] - low[kAngle] > std::numbers::pi)
        low[kAngle] = -std::numbers::pi, high[kAngle] = std::numbers::pi;
    }
    return formula_.survey(low, high);
  }

  const Formula& formula_;
  VariablesAt& at_;
  double shortest_;
  int looked_at_ = 0;
};

}  // namespace

std::optional<double> EventFreeIntegrator::time_in_passed_piece() {
  const std::span<const EquationsOfMotion::FormulaWithPieces> formulas = equations_.formulas_with_pieces();
  if (formulas.empty()) return std::nullopt;
  const double start = start_, end = time_;
  std::optional<double> earliest;
  Compensated state(y_.size());
  std::vector<double> all, own;
  std::size_t first = 0;
  for (const auto& [formula, variables] : formulas) {
    const std::size_t begin = first;
    first += variables;
    const auto variables_at = [&](double time) -> const std::vector<double>& {
      at(time, false, state);
      all.clear();
      equations_.append_formula_variables(time, state.value(), all);
      own.assign(all.begin() + static_cast<std::ptrdiff_t>(begin),
                 all.begin() + static_cast<std::ptrdiff_t>(begin + variables));
      return own;
    };
    PathPieces pieces(*formula, variables_at, kShortestPiece * (end - start));
    const std::optional<double> in = pieces.first_change(start, end);
    if (!in) continue;
    const std::optional<double> out = pieces.first_change(*in, end);
    if (!out) continue;
    const double middle = *in + 0.5 * (*out - *in);
    if (middle > start && middle < end && (!earliest || middle < *earliest)) earliest = middle;
  }
  return earliest;
}

}  // namespace plumb::precise
