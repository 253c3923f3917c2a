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
    if (phase.then) jumps_.push_back(ends_.back());
  }
}

Trajectory::State Phases::at(Real time) const {
  std::size_t part = parts_.size() - 1;
  while (part > 0 && parts_[part].start > time) --part;
  return parts_[part].path->at(time - parts_[part].start);
}

Truth turning_truth(const Scene& scene, std::string source, const Phases& path, Vec2<Real> pivot,
                    Vec2<Real> arm, bool turns) {
  const Real first = path.at(0)[0];
  return integrated(follow(
      scene, std::move(source),
      [=](Real time, Moving moving) {
        const Trajectory::State y = path.at(time);
        const Vec2<Real> now = turned(y[0], arm);
        const Motion start = moving[0];
        moving[0] = {pivot + now, start.angle, cross(y[1], now), 0};
        if (turns) moving[0].angle += y[0] - first;
        if (turns) moving[0].angular_velocity = y[1];
      },
      path.jumps()));
}

Trajectory::Law second_order_law(std::function<Real(Real q, Real rate)> acceleration) {
  return [acceleration = std::move(acceleration)](const Trajectory::State& y, Trajectory::State& rate) {
    rate = {y[1], acceleration(y[0], y[1])};
  };
}

}  // namespace plumb::scenarios::truth
