#include "harness/course/flight.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <variant>
#include <vector>

#include <fmt/format.h>

namespace plumb::course {
namespace {

constexpr std::size_t kFewest = 6;  // fewest steps from which a pattern is inferred

// Returns the radius of a circle around the body's centre that contains its shape.
double reach(const Body& body) {
  if (const auto* circle = std::get_if<Circle>(&body.shapes.front().geometry)) return circle->radius;
  const auto* box = std::get_if<Box>(&body.shapes.front().geometry);
  return box == nullptr ? 0 : std::hypot(box->width, box->height) / 2;
}

// Returns the distance of a point from the body's shape.
double distance(const Body& body, const BodyState& state, Vec2d point) {
  const Vec2d way = point - state.position;
  const auto* box = std::get_if<Box>(&body.shapes.front().geometry);
  if (box == nullptr) return std::hypot(way.x, way.y) - reach(body);
  const double c = std::cos(state.angle), s = std::sin(state.angle);
  const double x = std::abs(c * way.x + s * way.y) - box->width / 2,
               y = std::abs(c * way.y - s * way.x) - box->height / 2;
  return std::hypot(std::max(x, 0.0), std::max(y, 0.0));
}

// Returns the number of states from the start in which the body's distance from all others is more than its
// displacement in two steps.
std::size_t length_of_flight(const Recorded& run, std::size_t b) {
  const auto& states = run.trace.states;
  for (std::size_t k = 0; k < states.size(); ++k) {
    double fastest = 0;
    for (const BodyState& s : states[k]) fastest = std::max(fastest, std::hypot(s.velocity.x, s.velocity.y));
    for (std::size_t o = 0; o < run.scene.bodies.size(); ++o) {
      const double gap = distance(run.scene.bodies[o], states[k][o], states[k][b].position);
      if (o != b && gap < reach(run.scene.bodies[b]) + 0.02 + 4 * fastest * run.dt) return k;
    }
  }
  return states.size();
}

// Returns the ratio of each value to the previous one, if it is constant and not 1. If the values vanish
// before the ratio was seen twice, the body has stopped, and there is no ratio.
std::optional<double> constant_ratio(std::span<const double> values) {
  constexpr double kVanishes = 1e-4;
  if (values.size() < kFewest || std::abs(values[0]) < 1e-9) return std::nullopt;
  const double ratio = values[1] / values[0];
  if (!(ratio > 0) || std::abs(ratio - 1) < 1e-6 || ratio * ratio < kVanishes) return std::nullopt;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (std::abs(values[k] - ratio * values[k - 1]) > 1e-5 * std::abs(values[0])) return std::nullopt;
  return ratio;
}

// Returns the speed that stays constant in the last steps, although gravity acts and accelerated the body
// before.
std::optional<double> largest_speed(std::span<const Vec2d> v, Vec2d gain) {
  if (v.size() < 2 * kFewest || (gain.x == 0 && gain.y == 0)) return std::nullopt;
  const auto speed = [&](std::size_t k) { return std::hypot(v[k].x, v[k].y); };
  const double last = speed(v.size() - 1);
  const double step = std::hypot(gain.x, gain.y);
  for (std::size_t k = v.size() - kFewest; k < v.size(); ++k)
    if (std::abs(speed(k) - last) > 1e-6 * step) return std::nullopt;
  const bool fell = std::abs(v[1].x - v[0].x - gain.x) + std::abs(v[1].y - v[0].y - gain.y) < 1e-6 * step;
  return fell && last > speed(0) + step ? std::optional(last) : std::nullopt;
}

bool whole(double value) { return std::abs(value - std::round(value)) < 1e-6; }

// Returns the number of decimals to which all values are rounded. The changes of rounded values differ from
// the correct ones (`changes`, up to `slack`) by at most one unit of the last decimal. They must differ,
// because a wrong change may have few decimals as well.
std::optional<int> decimals(std::span<const double> values, std::span<const double> changes, double slack) {
  if (values.size() < 2 * kFewest || values.front() == values.back()) return std::nullopt;
  double unit = 10;
  for (int digits = 1; digits <= 4; ++digits, unit *= 10) {
    if (!std::all_of(values.begin(), values.end(), [&](double v) { return whole(v * unit); })) continue;
    bool exact = true;
    for (std::size_t k = 1; k < values.size(); ++k) {
      exact = exact && whole(changes[k] * unit);
      if (std::abs(values[k] - values[k - 1] - changes[k]) > 1.01 / unit + slack) return std::nullopt;
    }
    return exact ? std::nullopt : std::optional(digits);
  }
  return std::nullopt;
}

// Returns true if no force changes in time or with the motion: the change of velocity is then equal in all
// steps.
bool forces_are_constant(const Scene& scene) {
  return std::all_of(scene.forces.begin(), scene.forces.end(), [](const ForceLaw& law) {
    if (const auto* torque = std::get_if<Torque>(&law))
      return torque->start == 0 && std::isinf(torque->duration);
    const auto* push = std::get_if<PointForce>(&law);
    return push != nullptr && push->start == 0 && std::isinf(push->duration) && push->point == Vec2d{};
  });
}

// Returns the factor by which all changes differ from the correct ones; nullopt if it is not constant.
std::optional<double> factor_of(std::span<const Vec2d> changes, std::span<const Vec2d> right) {
  double most = 0, factor = 0;
  for (std::size_t k = 0; k < right.size(); ++k)
    for (double Vec2d::*axis : {&Vec2d::x, &Vec2d::y})
      if (std::abs(right[k].*axis) > most)
        most = std::abs(right[k].*axis), factor = changes[k].*axis / (right[k].*axis);
  if (changes.size() < kFewest || most == 0) return std::nullopt;
  for (std::size_t k = 0; k < right.size(); ++k) {
    const Vec2d off = changes[k] - factor * right[k];
    if (std::abs(off.x) + std::abs(off.y) > 1e-9 * most) return std::nullopt;
  }
  return factor;
}

// Measures the factors by which the changes of velocity and of position differ from g dt and v dt.
std::optional<Seen> wrong_factor(const Recorded& run, std::size_t b, std::size_t n) {
  std::vector<Vec2d> gains, due, moves, old_speeds, new_speeds, means;
  for (std::size_t k = 1; k < n; ++k) {
    const BodyState &before = run.trace.states[k - 1][b], &after = run.trace.states[k][b];
    gains.push_back(after.velocity - before.velocity);
    due.push_back(run.dt * run.scene.gravity);
    moves.push_back(after.position - before.position);
    old_speeds.push_back(run.dt * before.velocity);
    new_speeds.push_back(run.dt * after.velocity);
    means.push_back(0.5 * (old_speeds.back() + new_speeds.back()));
  }
  const auto right = [](double factor) { return std::abs(factor - 1) < 1e-6; };
  const std::optional<double> gain = factor_of(gains, due);
  for (const auto& speeds : {new_speeds, old_speeds, means}) {
    const std::optional<double> move = factor_of(moves, speeds);
    if (!gain || !move || (right(*gain) && right(*move)) || *gain <= 0 || *move <= 0) continue;
    if (std::abs(*gain - *move) < 1e-6)
      return Seen{
          "wrong_dt",
          fmt::format("Each step is {:.6g} s long, and \"dt\" of the settings is {:.6g} s: take it as it "
                      "is, not rounded, cut or fixed.",
                      *gain * run.dt, run.dt),
          true};
    if (right(*move))
      return Seen{
          "gravity_wrong",
          fmt::format("Each step adds {:.6g} g dt to the velocity: it should add g dt, with \"gravity\" "
                      "of the scene and \"dt\" of the settings.",
                      *gain),
          true};
    if (right(*gain))
      return Seen{"move_wrong",
                  fmt::format("Each step adds {:.6g} v dt to the position: it should add v dt.", *move),
                  true};
  }
  return std::nullopt;
}

// Finds a factor on velocities in each step: changes that should be constant then form a geometric sequence.
std::optional<Seen> damping_of(const Recorded& run, std::size_t b, std::size_t n) {
  const auto ratio = [&](const auto& value, bool changes) {
    std::vector<double> values;
    for (std::size_t k = 0; k < n; ++k) {
      const double now = value(run.trace.states[k][b]);
      if (!changes) values.push_back(now);
      if (changes && k > 0) values.push_back(now - value(run.trace.states[k - 1][b]));
    }
    return constant_ratio(values);
  };
  const bool forced = !run.scene.forces.empty();
  const Vec2d g = run.scene.gravity;
  const auto x = ratio([](const BodyState& s) { return s.velocity.x; }, forced || g.x != 0);
  const auto y = ratio([](const BodyState& s) { return s.velocity.y; }, forced || g.y != 0);
  const auto kept = x ? x : y;
  if (kept && *kept > 1)
    return Seen{"speeding_up",
                fmt::format("Each step multiplies the velocity by {:.6g} in free flight: nothing "
                            "here speeds the ball up, so leave that out.",
                            *kept)};
  if (kept)
    return Seen{"damping", fmt::format("Each step multiplies the velocity by {:.6g} in free flight: nothing "
                                       "here slows the ball, so leave that out.",
                                       *kept)};
  if (const auto spin = ratio([](const BodyState& s) { return s.angular_velocity; }, forced))
    return Seen{*spin > 1 ? "spin_grows" : "spin_damped",
                fmt::format("Each step multiplies the spin by {:.6g}: nothing here {} it, so leave that out.",
                            *spin, *spin > 1 ? "speeds up" : "slows")};
  return std::nullopt;
}

std::optional<Seen> seen_of(const Recorded& run, std::size_t b) {
  const std::size_t n = length_of_flight(run, b);
  if (auto damping = damping_of(run, b, n)) return damping;
  if (!run.scene.forces.empty()) return std::nullopt;
  std::vector<Vec2d> v;
  for (std::size_t k = 0; k < n; ++k) v.push_back(run.trace.states[k][b].velocity);
  const Vec2d gain = run.dt * run.scene.gravity;
  for (double Vec2d::*axis : {&Vec2d::x, &Vec2d::y}) {
    std::vector<double> speeds, places, gains, moves;
    for (std::size_t k = 0; k < n; ++k) {
      speeds.push_back(v[k].*axis);
      if (k == 0) continue;
      places.push_back(run.trace.states[k][b].position.*axis);
      gains.push_back(v[k].*axis - v[k - 1].*axis);
      moves.push_back(v[k].*axis * run.dt);
    }
    const std::vector<double> due(speeds.size(), gain.*axis);
    const double slack = std::abs(gain.*axis) * run.dt;  // of a method that moves with the old velocity
    if (const auto digits = decimals(places, moves, slack))
      return Seen{
          "state_rounded",
          fmt::format("Positions are rounded to {} decimals: keep them as they are from step to step, "
                      "and write all their digits.",
                      *digits)};
    if (n > 1) {
      const auto later = std::span(speeds).subspan(1);
      if (const auto digits = decimals(later, due, 0))
        return Seen{"state_rounded", fmt::format("Velocities are rounded to {} decimals: keep them as they "
                                                 "are.",
                                                 *digits)};
    }
  }
  if (const auto most = largest_speed(v, gain))
    return Seen{
        "speed_limited",
        fmt::format("The speed never exceeds {:.4g} m/s: nothing limits it here, so leave that out.", *most)};
  return wrong_factor(run, b, n);
}

}  // namespace

bool flies_freely(const Recorded& run) {
  if (!run.scene.joints.empty()) return false;
  for (std::size_t b = 0; b < run.scene.bodies.size(); ++b)
    if (length_of_flight(run, b) < run.trace.states.size()) return false;
  return true;
}

std::optional<Seen> seen_in_flight(const Recorded& run) {
  if (!forces_are_constant(run.scene) || !run.scene.joints.empty()) return std::nullopt;
  std::optional<Seen> general;
  bool all = true;  // every body that flies long enough shows what the first one shows
  for (std::size_t b = 0; b < run.scene.bodies.size(); ++b) {
    if (run.scene.bodies[b].type != BodyType::Dynamic || run.scene.bodies[b].shapes.empty()) continue;
    auto seen = seen_of(run, b);
    if (seen && !seen->general) return seen;
    if (length_of_flight(run, b) <= kFewest) continue;
    if (!general && all) general = seen;
    all = all && seen && seen->says == general->says;
  }
  return all ? general : std::nullopt;
}

}  // namespace plumb::course
