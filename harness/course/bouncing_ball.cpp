// Chapter 1: a ball falls, speeds up, bounces off walls and settles.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "harness/course/course.h"
#include "harness/course/room_checks.h"
#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

constexpr double kGravity = 9.81;
constexpr const char* kBall = "\"shapes\":[\"circle\"]";
constexpr const char* kWalls =
    "\"shapes\":[\"circle\",\"box\"] and \"features\":[\"contacts\"]: one circle against static boxes";

Scene falling() { return scene_of("fall", {0, -kGravity}, {make(Ball{})}); }

std::string hard_coded(const char* value) {
  return fmt::format("The ball falls with {} m/s^2, the scene says 9.81: take \"gravity\" from the scene.",
                     value);
}

// Returns the factor by which each step of a fall multiplies the velocity, if there is one: successive
// increments of the speed then have a constant ratio below 1.
std::optional<double> kept_each_step(const Trace& trace) {
  const auto gain = [&](std::size_t k) {
    return trace.states[k + 1][0].velocity.y - trace.states[k][0].velocity.y;
  };
  if (trace.states.size() < 4 || gain(0) == 0) return std::nullopt;
  const double ratio = gain(1) / gain(0);
  if (!(ratio > 0) || std::abs(ratio - 1) < 1e-6) return std::nullopt;
  for (std::size_t k = 1; k + 2 < trace.states.size(); ++k)
    if (std::abs(gain(k + 1) - ratio * gain(k)) > 1e-4 * std::abs(gain(0))) return std::nullopt;
  return ratio;
}

Finding falls(const Lab& lab) {
  const Trace trace = lab.run(falling(), 1);
  const double t = trace.duration(), v = -kGravity * t;
  const double n = std::round(t / lab.dt()), h = lab.dt();
  const std::optional<double> kept = kept_each_step(trace);
  Judgement judgement;
  judgement.read("vy after 1 s", "m/s", trace.last(0).velocity.y, v, lab.rounding(v, t));
  if (judgement.good()) return judgement.finding();
  const auto wall = wall_of_no_scene(lab);
  return judgement.proven_if(wall.has_value(), kWallOfNoScene, wall.value_or(""))
      .proven_if(
          kept.has_value(), kept.value_or(1) > 1 ? "speeding_up" : "damping",
          fmt::format("Each step multiplies the velocity by {:.6g}: nothing here {}, so leave that out.",
                      kept.value_or(1), kept.value_or(1) > 1 ? "speeds the ball up" : "slows the ball"))
      .mistake("gravity_hard_coded", {-9.8 * t}, hard_coded("9.8"))
      .mistake("gravity_hard_coded", {-10 * t}, hard_coded("10"))
      .mistake("gravity_hard_coded", {-9.80665 * t}, hard_coded("9.80665"))
      .mistake("no_gravity", {0}, "The ball never speeds up: add gravity times dt to the velocity each step.")
      .mistake("gravity_upwards", {-v},
               "The ball falls upwards: y points up, and the scene's gravity is negative already; add it.")
      .mistake(
          "dt_twice", {v * h},
          "dt enters twice: the velocity grows by g dt each step, not by g dt dt. Is gravity multiplied by "
          "dt before, or the velocity by dt before it is kept?")
      .mistake("dt_missing", {-kGravity * n},
               "dt is missing: each step adds all of g to the velocity, and should add g dt.")
      .mistake("milliseconds", {v * 1000}, "A thousand times too fast: dt is in seconds, not milliseconds.")
      .mistake("milliseconds", {v / 1000}, "A thousand times too slow: dt is in seconds already.")
      .mistake("gravity_twice", {2 * v},
               "Gravity acts twice a step: is it added as a force and as an acceleration?")
      .mistake("gravity_halved", {v / 2},
               "Half of gravity: v grows by g dt. The half belongs to the distance, g t^2/2.")
      .finding();
}

std::string figures_of(const char* scheme) {
  return fmt::format("The figures are those of {}, and \"hello\" declares another scheme.", scheme);
}
std::string explicit_euler() {
  return figures_of("explicit Euler (position first, with the old velocity)") +
         " It adds energy every step: update the velocity first, then move with the new one.";
}

// Returns the substep, s, or the step if the method adapts its own.
double step_of(const Lab& lab) { return lab.substep() > 0 ? lab.substep() : lab.dt(); }

Finding falls_far_enough(const Lab& lab) {
  const Trace trace = lab.run(falling(), 1);
  const double t = trace.duration(), h = step_of(lab);
  const double n = std::round(t / h), exact = -kGravity * t * t / 2, late = kGravity * t * h / 2;
  return Judgement()
      .read("y after 1 s", "m", trace.last(0).position.y, lab.way(0, -kGravity, t), lab.rounding(exact, t))
      .mistake("does_not_move", {0}, "The position never changes: add v dt to it in each step.")
      .mistake("explicit_euler", {exact + late}, explicit_euler())
      .mistake("semi_implicit_euler", {exact - late},
               figures_of("semi-implicit Euler (velocity first, position with the new velocity)"))
      .mistake("exact_parabola", {exact}, figures_of("an exact parabola, as by velocity Verlet"))
      .mistake(
          "half_a_step_twice", {exact - 2 * late},
          "Each step moves g dt^2/2 too far: the new velocity already includes g dt, so move by v dt alone.")
      .mistake("velocity_without_dt", {(exact - late) / h}, "Each step moves the ball by v, not by v dt.")
      .mistake("velocity_with_dt_twice", {(exact - late) * h},
               "Each step moves the ball by v dt dt, not by v dt.")
      .mistake("constant_speed", {-kGravity * h * n * h},
               "The ball keeps its first speed: keep the velocity from step to step.")
      .finding();
}

constexpr const char* kMixed =
    "The components of gravity are mixed up: gravity[0] changes vx alone, and gravity[1] changes vy alone.";

Finding scene_says_gravity(const Lab& lab) {
  const Vec2d gravity{1.5, -3}, v0{3, 4};
  Scene scene = scene_of("throw", gravity, {make(Ball{.velocity = v0})});
  const Trace trace = lab.run(scene, 1), other = lab.run(falling(), 1);
  const double t = trace.duration();
  // With the signs of both components reversed.
  const Trace up = lab.run(scene_of("throw up", -gravity, {make(Ball{.velocity = v0})}), 1);
  const Vec2d v = trace.last(0).velocity, right = v0 + t * gravity;
  const double tolerance = lab.rounding(8, t);
  // If a different gravity adds the same velocity, the engine uses a constant.
  const Vec2d gain = v - v0, gain_of_other = other.last(0).velocity;
  const bool same_gain = std::hypot(gain.x - gain_of_other.x, gain.y - gain_of_other.y) < 1e-6 && gain.y != 0;
  const Fling slow = fling(lab, kSlow, 1), fast = fling(lab, kFast, 0.5);
  return Judgement()
      .read("vx after 1 s", "m/s", v.x, right.x, tolerance)
      .read("vy after 1 s", "m/s", v.y, right.y, tolerance)
      .read("x after 1 s", "m", trace.last(0).position.x, lab.way(v0.x, gravity.x, t), tolerance)
      .read("vx after 1 s, with gravity to the left and up", "m/s", up.last(0).velocity.x,
            v0.x - t * gravity.x, tolerance)
      .read("vy after 1 s, with gravity to the left and up", "m/s", up.last(0).velocity.y,
            v0.y - t * gravity.y, tolerance)
      .read("way of a slow ball, without gravity", "m", slow.way, slow.due, tolerance)
      .read("way of a fast ball, without gravity", "m", fast.way, fast.due, lab.rounding(kFast, 1))
      .proven_if(slow.held && !fast.held, "slow_is_stopped", kSlowIsHeld)
      .proven_if(fast.limited && std::abs(slow.way - slow.due) <= tolerance, "speed_limited",
                 limit_text(fast.speed))
      .proven_if(
          same_gain, "gravity_hard_coded",
          fmt::format("Gravity is {:.4g} m/s^2 downwards whatever the scene says: take \"gravity\" from the "
                      "scene.",
                      -gain.y / t))
      .mistake("gravity_only_down", {v0.x, right.y}, "Gravity is a vector: its x counts as well.")
      .mistake("starts_at_rest", {t * gravity.x, t * gravity.y},
               "The ball starts at rest: take \"velocity\" from the scene.")
      .mistake("ignores_gravity", {v0.x, v0.y}, "The scene's gravity is not used.")
      .mistake("gravity_mixed", {v0.x + t * gravity.y, v0.y + t * gravity.x}, kMixed)
      .mistake("gravity_mixed", {right.x, right.y + t * gravity.x}, kMixed)
      .mistake("gravity_mixed", {right.x + t * gravity.y, right.y}, kMixed)
      .mistake("gravity_mixed", {right.x, v0.y + t * gravity.x}, kMixed)
      .mistake("gravity_mixed", {v0.x + t * gravity.y, right.y}, kMixed)
      .mistake("explicit_euler",
               {right.x, right.y, v0.x * t + gravity.x * t * t / 2 - gravity.x * t * step_of(lab) / 2},
               explicit_euler())
      .finding();
}

// Compares the speed after one second at three step sizes.
Finding any_step_size(const Lab& lab) {
  struct Fall {
    double speed, way;  // ratios to the expected values, apart from the method's own offset of at most a step
  };
  const auto fall = [&](int finer) -> Fall {
    const Trace trace = lab.run(falling(), 1, finer);
    const double t = trace.duration();
    return {trace.last(0).velocity.y / t, (trace.last(0).position.y - trace.first(0).position.y) / (t * t)};
  };
  const Fall one = fall(1), half = fall(2), quarter = fall(4);
  const auto over = [](double other, double first) { return first == 0 ? 0 : other / first; };
  const double relative = lab.rounding(kGravity, 4) / std::max(std::abs(one.speed), 1e-3);
  const double offset = 4 * lab.dt();
  // Along x as well, as each component may be multiplied by another step.
  const auto aside = [&](int finer) -> Fall {
    const Trace trace =
        lab.run(scene_of("fall aside", {-kGravity / 2, -kGravity}, {make(Ball{})}), 0.5, finer);
    const double t = trace.duration();
    return {trace.last(0).velocity.x / t, (trace.last(0).position.x - trace.first(0).position.x) / (t * t)};
  };
  const Fall along = aside(1), half_along = aside(2);
  // The same fall, asked for in a single sample after all steps.
  const Trace end = lab.run_to_end(falling(), 1);
  const double at_once = end.last(0).velocity.y / end.duration();
  return Judgement()
      .read("vy/t with dt/2 over that with dt", "", over(half.speed, one.speed), 1, relative)
      .read("vy/t with dt/4 over that with dt", "", over(quarter.speed, one.speed), 1, relative)
      .read("way with dt/2 over that with dt", "", over(half.way, one.way), 1, offset)
      .read("way with dt/4 over that with dt", "", over(quarter.way, one.way), 1, offset)
      .read("vy/t of the last step, asked for alone, over that with each step", "", over(at_once, one.speed),
            1, relative)
      .read("vx/t with dt/2 over that with dt, with gravity along x", "", over(half_along.speed, along.speed),
            1, 2 * relative)
      .read("way along x with dt/2 over that with dt", "", over(half_along.way, along.way), 1, 2 * offset)
      .mistake("per_frame", {2, 4, kAny, kAny},
               "Twice the steps, twice the speed: something is added once a step and does not depend on dt. "
               "Multiply it by dt.")
      .mistake("dt_twice", {0.5, 0.25, kAny, kAny}, "Half the step, half the speed: dt enters twice.")
      .finding();
}

// Drops a ball of radius r at (1, -2) m/s, or at a multiple, on a floor whose top is at -0.5 m.
Trace bounce(const Lab& lab, double r, double e = 1, double times = 1) {
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -1}, .width = 20, .height = 1, .restitution = 0}));
  const Body ball =
      make(Ball{.position = {0, 0.5 + r}, .velocity = times * Vec2d{1, -2}, .radius = r, .restitution = e});
  return lab.run(scene_of("bounce", {}, {ball, floor}), 1);
}

// Returns true if a step at the floor moves the ball farther down than its velocities before and after the
// step can.
bool pulled_into_floor(const Lab& lab, const Trace& trace) {
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    const BodyState &before = trace.states[k - 1][0], &after = trace.states[k][0];
    const double least = std::min(before.velocity.y, after.velocity.y) * lab.dt();
    if (after.position.y - before.position.y < least - 1e-6) return true;
  }
  return false;
}

// Returns true if the first change of vy leaves the fraction (1 - e) of it: the impulse then has the factor e
// instead of 1 + e.
bool keeps_rest(const Trace& trace, double e) {
  const double v = trace.first(0).velocity.y;
  for (const auto& states : trace.states)
    if (states[0].velocity.y != v) return std::abs(states[0].velocity.y - (1 - e) * v) < 0.01 * std::abs(v);
  return false;
}

constexpr const char* kNormalNotUnit =
    "The bounce is right where the normal's length happens to be 1 m, and wrong elsewhere: divide the normal "
    "by its "
    "length.";
constexpr const char* kOnePlus =
    "The first contact takes away e of the speed: the change is (1 + e) times it, 1 to stop the ball and e "
    "to send it "
    "back.";

constexpr const char* kThreshold =
    "The ball stops at 2 m/s and bounces when it is faster: the speed below which restitution is 0 is too "
    "high. It is 2 g dt, or the scene's \"restitution_threshold\".";
constexpr double kFloor = -0.5;  // m, its top

Finding bounces(const Lab& lab) {
  const double r = 0.4, tolerance = 0.002;
  const Trace trace = bounce(lab, r);
  const BodyState& end = trace.last(0);
  // With e = 1 all powers of e are equal, and so are 2 e and 1 + e. A single speed of 2 m/s does not
  // distinguish e from e times the speed.
  const double e = 0.6, quick = 1.5;
  const BodyState slower = bounce(lab, r, e, quick).last(0);
  double lowest = trace.first(0).position.y - r;
  for (const auto& states : trace.states) lowest = std::min(lowest, states[0].position.y - r);
  Judgement judgement;
  judgement.read("vx after the bounce", "m/s", end.velocity.x, 1, tolerance)
      .read("vy after the bounce", "m/s", end.velocity.y, 2, 2 * tolerance)
      .read("lowest point of the ball", "m", lowest, kFloor, 4 * lab.dt() + 0.05 * r)
      .read("vx after a bounce of restitution 0.6", "m/s", slower.velocity.x, quick, tolerance)
      .read("vy after a bounce of restitution 0.6", "m/s", slower.velocity.y, 2 * quick * e, 2 * tolerance)
      .read("turn aside of balls that pass a platform", "m/s", turn_at_platform(lab), 0, tolerance);
  if (judgement.good()) return judgement.finding();
  // With a radius of 1 m the vector from the wall to the centre has length 1 m minus the overlap of a step.
  const double off_at_1 = std::abs(bounce(lab, 1).last(0).velocity.y - 2);
  const bool right_at_1 = off_at_1 < 0.3 && off_at_1 < std::abs(end.velocity.y - 2) / 3;
  constexpr double kFaster = 5;
  const bool stops = std::abs(end.velocity.y) < tolerance;
  const bool bounces_fast =
      stops && std::abs(bounce(lab, r, 1, kFaster).last(0).velocity.y - 2 * kFaster) < 0.1;
  const double along = end.velocity.x;
  const auto wall = wall_of_no_scene(lab);
  return judgement.mistake_if(trace.still(0), "starts_at_rest", kStill)
      .proven_if(wall.has_value(), kWallOfNoScene, wall.value_or(""))
      .proven_if(bounces_fast, "threshold_too_high", kThreshold)
      .proven_if(
          pushed_too_far(trace, lab.dt(), [&](const auto& s) { return s[0].position.y - (kFloor + r); }),
          "pushed_too_far", kPushedTooFar)
      .proven_if(
          std::abs(end.velocity.y - 2) <= 2 * tolerance && along > 0.05 && std::abs(along - 1) > tolerance,
          "along_wall_changed",
          "The bounce changes the speed along the wall as well: only the part along the normal "
          "changes.")
      .mistake("whole_sizes", {1, 2, kFloor + 0.5, quick, 2 * quick * e},
               "It turns half a metre above the floor, which is 1 m high: a box reaches half of its width "
               "and half of its height from its centre.")
      .mistake("quarter_sizes", {1, 2, kFloor - 0.25, quick, 2 * quick * e},
               "It sinks into the floor before it turns: a box reaches half of its width and half of its "
               "height from its centre, not a quarter.")
      .mistake("diameters", {1, 2, kFloor + r, quick, 2 * quick * e},
               "It turns a radius too early: compare the distance with the "
               "radius, not with the diameter.")
      .mistake("radius_ignored", {1, 2, kFloor - r, quick, 2 * quick * e},
               "It turns when its centre reaches the floor: it touches when the nearest point is a radius "
               "away.")
      .mistake_if(
          pulled_into_floor(lab, trace), "normal_flipped",
          "The ball is pulled into the floor: the normal points into the wall, and should point out of it, "
          "towards the ball.")
      .mistake_if(right_at_1, "normal_not_unit", kNormalNotUnit)
      .mistake_if(keeps_rest(bounce(lab, r, 0.7), 0.7), "one_plus_forgotten", kOnePlus)
      .mistake(
          "falls_through", {1, -2, kAny, quick, -2 * quick},
          "The ball goes through the floor: no contact is found, the velocity is not changed, or the normal "
          "points into the wall, so that coming looks like leaving.")
      .mistake("both_turned", {-1, 2},
               "The whole velocity is reversed: reverse only its part along the wall's normal.")
      .mistake("wrong_axis", {-1, -2}, "The floor reverses vx: its normal points up, so reverse vy.")
      .mistake(
          "restitution_ignored", {1, 0, kAny, quick, 0},
          "The ball stops at the floor: with restitution 1 it should leave as fast as it came, at -e vy.")
      .mistake("restitution_squared", {1, 2, kAny, quick, 2 * quick * e * e},
               "Restitution is applied twice: multiply the speed by e once.")
      .mistake("restitution_root", {1, 2, kAny, quick, 2 * quick * std::sqrt(e)},
               "The energy is multiplied by e: restitution multiplies the speed.")
      .mistake("restitution_ignored", {1, 2, kAny, quick, 2 * quick},
               "All of the speed comes back, at restitution 0.6 as well: multiply it by the restitution.")
      .mistake("restitution_of_one_less", {1, 0, kAny, quick, 2 * quick * (1 - e)},
               "The speed is multiplied by 1 - e: it should be e.")
      .mistake("stops_dead", {0, 0, kAny, 0, 0},
               "The ball stops dead: only the normal part of the velocity changes, by -e.")
      .finding();
}

// Returns true if the velocity reverses in one step and again in the next.
bool trembles(const Trace& trace) {
  for (std::size_t k = 2; k < trace.states.size(); ++k) {
    const auto speed = [&](std::size_t at) { return trace.states[at][0].velocity.y; };
    if (speed(k - 2) * speed(k - 1) < 0 && speed(k - 1) * speed(k) < 0) return true;
  }
  return false;
}

// Returns true if a ball without gravity rises more slowly some time after its bounce than right after it.
bool loses_what_it_got(const Trace& trace) {
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    const double before = trace.states[k - 1][0].velocity.y, after = trace.states[k][0].velocity.y;
    if (before > 0 && after < before - 0.01 * std::abs(trace.first(0).velocity.y)) return true;
  }
  return false;
}

Finding restitution(const Lab& lab) {
  const double e = 0.7, wall = 0.2, v = 2;
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -1}, .width = 20, .height = 1, .restitution = wall}));
  // The gap is not a whole number of steps, so the ball is detected well inside the floor.
  const Body ball = make(Ball{.position = {0, 1.003}, .velocity = {0, -v}, .restitution = e});
  const auto after = [&](double speed) {
    const Body quick = make(Ball{.position = {0, 1.003}, .velocity = {0, -speed}, .restitution = e});
    return lab.run(scene_of("restitution", {}, {quick, floor}), 1);
  };
  const double lively = 0.5, dull = 0.3;
  Body dull_ball = ball, lively_floor = floor;
  dull_ball.shapes.front().restitution = dull;
  lively_floor.shapes.front().restitution = lively;
  const auto vy_after = [&](std::vector<Body> bodies, std::size_t of) {
    return lab.run(scene_of("restitution of two", {}, std::move(bodies)), 1).last(of).velocity.y;
  };
  const Trace trace = after(v);
  const double end = trace.last(0).velocity.y;
  const bool stops = std::abs(end) < 0.002 * v && !trembles(trace) && !loses_what_it_got(trace);
  const bool bounces_fast = stops && std::abs(after(5 * v).last(0).velocity.y - 5 * e * v) < 0.05 * v;
  return Judgement()
      .read("vy after the bounce", "m/s", end, e * v, 0.002 * v)
      .read("vy after a bounce on a floor of 0.5, with a ball of 0.3", "m/s",
            vy_after({dull_ball, lively_floor}, 0), lively * v, 0.002 * v)
      .read("vy after a bounce on a floor of 0.2 that comes first in the scene", "m/s",
            vy_after({floor, ball}, 1), e * v, 0.002 * v)
      .proven_if(bounces_fast, "threshold_too_high", kThreshold)
      .mistake_if(trace.still(0), "starts_at_rest", kStill)
      .mistake_if(trembles(trace) || loses_what_it_got(trace), "turned_every_step", kTurnedEveryStep)
      .mistake_if(keeps_rest(trace, e), "one_plus_forgotten", kOnePlus)
      .mistake("restitution_squared", {e * e * v},
               "Restitution is applied twice: multiply the speed by e once.")
      .mistake("restitution_root", {std::sqrt(e) * v},
               "The energy is multiplied by e: restitution multiplies the speed.")
      .mistake("restitution_ignored", {v}, "All of the speed comes back: multiply it by the restitution.")
      .mistake("restitution_zero", {0},
               "None of the speed comes back: restitution is not used, or what it gives is taken back in the "
               "same step. If you go over contacts several times, compute the bounce -e vn once, before the "
               "first time.")
      .mistake("restitution_of_one_less", {(1 - e) * v}, "The speed is multiplied by 1 - e: it should be e.")
      .mistake("restitution_average", {(e + wall) / 2 * v},
               "The two restitutions are averaged: \"contact_rules\" says maximum.")
      .mistake("restitution_product", {e * wall * v},
               "The two restitutions are multiplied: \"contact_rules\" says maximum.")
      .mistake("restitution_mean", {std::sqrt(e * wall) * v},
               "The geometric mean of the two restitutions is taken: \"contact_rules\" says maximum.")
      .mistake("falls_through", {-v}, "The ball goes through the floor.")
      .finding();
}

}  // namespace

Chapter bouncing_ball() {
  return {.number = 1,
          .title = "A bouncing ball",
          .page = "1-bouncing-ball.md",
          .checks = {{"falls", "a ball speeds up by g a second", kBall, falls},
                     {"falls_far_enough", "it falls as far as its method predicts", kBall, falls_far_enough},
                     {"scene_says_gravity", "gravity and the first velocity come from the scene", kBall,
                      scene_says_gravity},
                     {"any_step_size", "the same speed at any step size", kBall, any_step_size},
                     {"bounces", "a bounce reverses the velocity along the normal", kWalls, bounces},
                     {"restitution", "restitution multiplies the speed", kWalls, restitution},
                     {"four_walls", "it stays between four walls and keeps its speed", kWalls, four_walls},
                     {"settles", "under gravity it comes to rest on the floor", kWalls, settles}}};
}

}  // namespace plumb::course
