#include "harness/course/lab.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb::course {

using reference::Scheme;

double farthest_push(const Trace& trace, double dt) {
  double most = 0;
  for (std::size_t k = 1; k < trace.states.size(); ++k)
    for (std::size_t b = 0; b < trace.states[k].size(); ++b) {
      const BodyState &before = trace.states[k - 1][b], &after = trace.states[k][b];
      const Vec2d way = 1 / dt * (after.position - before.position) - before.velocity;
      const Vec2d change = after.velocity - before.velocity;
      const double square = dot(change, change);
      const double share = square > 0 ? std::clamp(dot(way, change) / square, 0.0, 1.0) : 0;
      const Vec2d left = way - share * change;
      most = std::max(most, dt * std::hypot(left.x, left.y));
    }
  return most;
}

bool pushed_too_far(const Trace& trace, double dt,
                    const std::function<double(const std::vector<BodyState>&)>& gap) {
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    std::vector<BodyState> moved = trace.states[k - 1];
    bool unchanged = true;
    for (std::size_t b = 0; b < moved.size(); ++b) {
      const BodyState& after = trace.states[k][b];
      unchanged = unchanged && moved[b].velocity == after.velocity &&
                  moved[b].angular_velocity == after.angular_velocity;
      moved[b].position += dt * moved[b].velocity;
      moved[b].angle += dt * moved[b].angular_velocity;
    }
    const double overlap = -gap(moved);
    if (unchanged && overlap > 0 && gap(trace.states[k]) > 0.05 * overlap) return true;
  }
  return false;
}

Lab::Lab(const reference::Backend& engine, const reference::StepSettings& settings,
         std::vector<Recorded>* runs, Watcher watcher)
    : engine_(engine),
      settings_(settings),
      method_(engine.method(settings)),
      runs_(runs),
      watcher_(std::move(watcher)) {
  if (method_.scheme == Scheme::Adaptive) method_.substep = 0;
}

Trace Lab::run(const Scene& scene, double duration, int finer) const {
  reference::StepSettings settings = settings_;
  settings.dt /= finer;
  for (const reference::Backend* engine : {&engine_, refuses_as_})
    if (engine != nullptr)
      if (const std::string reason = engine->unsupported(scene, settings); !reason.empty())
        throw NotYet(reason);
  Trace trace;
  trace.times.push_back(0);
  trace.states.emplace_back();
  for (const Body& body : scene.bodies) trace.states.back().push_back(initial_state(body));
  const int steps = static_cast<int>(std::floor(duration / settings.dt + 1e-6));
  const auto simulator = engine_.create(scene, settings);
  const std::size_t run = runs_ != nullptr ? runs_->size() : 0;
  const auto keep = [&] {
    if (runs_ != nullptr) runs_->push_back({scene, trace, settings.dt});
  };
  try {
    simulator->record(steps, 1, scene.bodies.size(), [&](double time, std::span<const BodyState> states) {
      trace.times.push_back(time);
      trace.states.emplace_back(states.begin(), states.end());
      if (watcher_) watcher_(run, trace.states.size() - 1, states);
    });
  } catch (...) {
    keep();
    throw;
  }
  keep();
  return trace;
}

Trace Lab::run_to_end(const Scene& scene, double duration) const {
  if (const std::string reason = engine_.unsupported(scene, settings_); !reason.empty()) throw NotYet(reason);
  Trace trace;
  trace.times.push_back(0);
  trace.states.emplace_back();
  for (const Body& body : scene.bodies) trace.states.back().push_back(initial_state(body));
  const int steps = static_cast<int>(std::floor(duration / settings_.dt + 1e-6));
  engine_.create(scene, settings_)
      ->record(1, steps, scene.bodies.size(), [&](double time, std::span<const BodyState> states) {
        trace.times.push_back(time);
        trace.states.emplace_back(states.begin(), states.end());
      });
  return trace;
}

reference::StepSettings Lab::plain_settings() const {
  reference::StepSettings out;
  out.dt = settings_.dt;
  if (method_.substep > 0) out.substeps = std::max(1, static_cast<int>(std::round(out.dt / method_.substep)));
  return out;
}

double Lab::rounding(double scale, double time) const {
  const double steps = time / (method_.substep > 0 ? method_.substep : settings_.dt);
  const double adaptive = method_.scheme == Scheme::Adaptive ? 1e-6 : 0;
  return (2 * method_.epsilon * (steps + 1) + adaptive) * std::abs(scale);
}

double Lab::method_error(double rate, double floor) const {
  const int order = method_.order;
  return std::max(floor, order == 0 ? 0 : std::pow(rate * method_.substep, order) / 2);
}

double Lab::turn_kept(double w, double time) const {
  return method_.order == 1 ? 1 / std::sqrt(1 + w * w * method_.substep * time) : 1;
}

double Lab::spin_kept_by_positions(double w, double time) const {
  return method_.order == 1 ? 1 / std::sqrt(1 + 2 * w * w * method_.substep * time) : 1;
}

double Lab::coarseness() const { return std::max(1.0, std::pow(60 * settings_.dt, 2)); }

double Lab::way(double v, double a, double time) const {
  double late = 0;
  if (method_.scheme == Scheme::ExplicitEuler) late = -method_.substep;
  if (method_.scheme == Scheme::SemiImplicitEuler) late = method_.substep;
  return v * time + a * time * (time + late) / 2;
}

}  // namespace plumb::course
