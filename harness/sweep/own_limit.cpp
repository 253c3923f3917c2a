#include "harness/sweep/own_limit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/isolate.h"
#include "harness/style.h"
#include "harness/summary.h"
#include "harness/truth_table.h"

namespace plumb::harness::sweep {
namespace {

constexpr double kInterval = 1.0 / 240;  // s
constexpr double kRounding = 1e-13;      // m: runs that differ by less count as equal

using States = std::vector<BodyState>;

std::string record(const Scene& scene, double duration, const reference::Backend& backend,
                   const reference::StepSettings& settings) {
  const auto simulator = backend.create(scene, settings);
  States states(scene.bodies.size());
  simulator->read(states);
  std::string out;
  const auto take = [&](std::span<const BodyState> now) {
    out.append(reinterpret_cast<const char*>(now.data()), now.size_bytes());
  };
  take(states);
  const int every = static_cast<int>(std::lround(kInterval / settings.dt));
  simulator->record(step_count(duration, kInterval), every, states.size(),
                    [&](double, std::span<const BodyState> now) { take(now); });
  return out;
}

std::optional<States> run(const scenarios::Problem& problem, const reference::Backend& backend,
                          const reference::StepSettings& settings, double seconds, std::string& why) {
  const Outcome outcome =
      isolate([&] { return record(problem.scene, problem.duration, backend, settings); }, seconds);
  why = outcome.text;
  if (outcome.kind != Outcome::Kind::Done) return {};
  States states(outcome.text.size() / sizeof(BodyState));
  std::memcpy(states.data(), outcome.text.data(), states.size() * sizeof(BodyState));
  for (const BodyState& state : states) {
    if (std::isfinite(state.position.x + state.position.y + state.angle)) continue;
    why = "its state is not finite";
    return {};
  }
  return states;
}

Metrics distances(const States& a, const States& b) {
  double position = 0, angle = 0, velocity = 0, spin = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    position =
        std::max(position, std::hypot(a[i].position.x - b[i].position.x, a[i].position.y - b[i].position.y));
    angle = std::max(angle, std::abs(a[i].angle - b[i].angle));
    velocity =
        std::max(velocity, std::hypot(a[i].velocity.x - b[i].velocity.x, a[i].velocity.y - b[i].velocity.y));
    spin = std::max(spin, std::abs(a[i].angular_velocity - b[i].angular_velocity));
  }
  Metrics out;
  out.position_error = position, out.angle_error = angle;
  out.velocity_error = velocity, out.angular_velocity_error = spin;
  return out;
}

// Returns settings with finer and finer steps, and the engine's defaults otherwise.
std::vector<reference::StepSettings> refinements(const reference::Backend& backend, const Ladder& ladder) {
  std::vector<reference::StepSettings> out;
  if (backend.method({}).scheme == reference::Scheme::Adaptive) {
    for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
      out.push_back({.dt = kInterval});
      out.back().tolerance = tolerance;
    }
    return out;
  }
  for (int rung = 0; rung < ladder.rungs; ++rung)
    if (ladder.dt(rung) <= kInterval * (1 + 1e-9)) out.push_back({.dt = ladder.dt(rung)});
  return out;
}

// Returns the last two refinements that lead to `at`; none if they do not.
std::vector<reference::StepSettings> last_two(const std::vector<reference::StepSettings>& all,
                                              const reference::StepSettings& at) {
  for (std::size_t i = 1; i < all.size(); ++i)
    if (all[i].dt == at.dt && all[i].tolerance == at.tolerance) return {all[i - 1], all[i]};
  return {};
}

BodyState between(const BodyState& a, const BodyState& b, double share, double interval) {
  const double s2 = share * share, s3 = s2 * share;
  const double h0 = 2 * s3 - 3 * s2 + 1, h1 = s3 - 2 * s2 + share, h2 = 3 * s2 - 2 * s3, h3 = s3 - s2;
  const auto place = [&](double x, double v, double y, double w) {
    return h0 * x + h1 * interval * v + h2 * y + h3 * interval * w;
  };
  BodyState out;
  out.position = {place(a.position.x, a.velocity.x, b.position.x, b.velocity.x),
                  place(a.position.y, a.velocity.y, b.position.y, b.velocity.y)};
  out.angle = place(a.angle, a.angular_velocity, b.angle, b.angular_velocity);
  out.velocity = a.velocity + share * (b.velocity - a.velocity);
  out.angular_velocity = a.angular_velocity + share * (b.angular_velocity - a.angular_velocity);
  return out;
}

}  // namespace

void OwnLimit::at(double time, std::span<BodyState> out) const {
  const std::size_t last = states.size() / bodies - 1;
  const double place = std::max(0.0, time / interval);
  const double nearest = std::round(place);
  const bool on_sample = std::abs(place - nearest) < 1e-6;
  const std::size_t low = std::min(static_cast<std::size_t>(on_sample ? nearest : place), last);
  const std::size_t high = std::min(low + 1, last);
  const double share = on_sample ? 0 : place - static_cast<double>(low);
  for (std::size_t i = 0; i < bodies; ++i) {
    const BodyState& before = states[low * bodies + i];
    out[i] = share == 0 || high == low ? before : between(before, states[high * bodies + i], share, interval);
  }
}

std::shared_ptr<const OwnLimit> find_own_limit(const scenarios::Problem& problem,
                                               const reference::Backend& backend, const Ladder& ladder,
                                               double seconds,
                                               const std::optional<reference::StepSettings>& at) {
  using Clock = std::chrono::steady_clock;
  auto out = std::make_shared<OwnLimit>();
  out->interval = kInterval;
  out->bodies = problem.scene.bodies.size();
  const bool adaptive = backend.method({}).scheme == reference::Scheme::Adaptive;
  int runs = 0;
  std::vector<reference::StepSettings> all = refinements(backend, ladder);
  if (at) all = last_two(all, *at);
  for (const reference::StepSettings& settings : all) {
    const Clock::time_point start = Clock::now();
    std::optional<States> states = run(problem, backend, settings, std::max(1.0, 3 * seconds), out->problem);
    if (!states) break;
    out->problem.clear();
    ++runs;
    if (runs > 1) out->within = distances(out->states, *states);
    const double distance = out->within.position_error.value_or(INFINITY);
    out->states = std::move(*states);
    out->settings = settings;
    out->source = fmt::format("{}'s own limit at {}, within {} m of the result at {}", backend.name(),
                              settings_text(settings), figure(distance),
                              adaptive ? "a hundred times the tolerance" : "twice the step");
    const double took = std::chrono::duration<double>(Clock::now() - start).count();
    if (!at && (distance < kRounding || 2 * took > seconds)) break;
  }
  if (runs >= 2) {
    out->problem.clear();
  } else if (out->problem.empty()) {
    out->problem = fmt::format("two runs with steps of 1/240 s or less take more than {:g} s", seconds);
  }
  return out;
}

void hold_against(Result& result, const OwnLimit& limit) {
  result.truth_within = limit.within;
  result.truth_asked = limit.settings;
  for (Check& check : result.checks)
    if (check.oracle == Oracle::Exact) check.oracle = Oracle::Self;
  for (const MetricField& metric : kMetricFields) {
    const auto& least = limit.within.*metric.value;
    if (!least) continue;
    const auto known = [&](double error) { return !(std::max(error, kRoundingFloor) < *least); };
    auto& error = result.metrics.*metric.value;
    if (error && !known(*error)) error.reset();
    std::erase_if(result.checks, [&](const Check& check) {
      return check.oracle == Oracle::Self && check.name == metric.name && !known(check.value);
    });
  }
}

}  // namespace plumb::harness::sweep
