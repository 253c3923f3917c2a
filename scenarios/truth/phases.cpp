#include "scenarios/truth/phases.h"

#include <cmath>
#include <optional>
#include <utility>

namespace plumb::scenarios::truth {
namespace {

/// Returns the time within the phase at which `until` stops being positive; nothing before `horizon`.
std::optional<Real> end_of(const Phase& phase, const Trajectory& path, Real horizon, Real spacing) {
  if (!phase.until) return std::nullopt;
  for (Real low = 0; low < horizon; low += spacing) {
    Real high = low + spacing;
    if (phase.until(path.at(high)) > 0) continue;
    for (Real middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2)
      (phase.until(path.at(middle)) > 0 ? low : high) = middle;
    return high;
  }
  return std::nullopt;
}

}  // namespace

Phases::Phases(Trajectory::State start, std::vector<Phase> phases, Real horizon, Real spacing) {
  Real now = 0;
  for (const Phase& phase : phases) {
    const auto path = std::make_shared<const Trajectory>(start, phase.law, spacing);
    parts_.push_back({now, path});
    const std::optional<Real> end = end_of(phase, *path, horizon - now, spacing);
    if (!end) return;
    start = path->at(*end);
    if (phase.then) start = phase.then(start);
    now += *end;
    ends_.push_back(static_cast<double>(now));
  }
}

Trajectory::State Phases::at(Real time) const {
  std::size_t part = parts_.size() - 1;
  while (part > 0 && parts_[part].start > time) --part;
  return parts_[part].path->at(time - parts_[part].start);
}

Trajectory::Law second_order_law(std::function<Real(Real q, Real rate)> acceleration) {
  return [acceleration = std::move(acceleration)](const Trajectory::State& y, Trajectory::State& rate) {
    rate = {y[1], acceleration(y[0], y[1])};
  };
}

}  // namespace plumb::scenarios::truth
