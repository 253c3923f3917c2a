// Chapter 1: a ball among walls and on a floor.
#include "harness/course/room_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

constexpr double kGravity = 9.81;

// Counts the sign changes of the velocity, on either axis.
int turns(const Trace& trace) {
  int count = 0;
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    const Vec2d a = trace.states[k - 1][0].velocity, b = trace.states[k][0].velocity;
    count += (a.x * b.x < 0) + (a.y * b.y < 0);
  }
  return count;
}

// Returns the largest upward speed, m/s, of a ball that slides on the floor. Only gravity's speed of a step
// is along the normal there, and does not bounce.
double rise_of_sliding_ball(const Lab& lab) {
  const double r = 0.5;
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}));
  // Rises by less than a step's gravity at first: whichever step finds the contact, the ball then falls with
  // less than the 2 g dt below which restitution is 0, and not with just as much.
  const double step = lab.substep() > 0 ? lab.substep() : lab.dt();
  const Body ball = make(
      Ball{.position = {-3, r}, .velocity = {3, 0.3 * kGravity * step}, .radius = r, .restitution = 0.9});
  const Trace trace = lab.run(scene_of("slide", {0, -kGravity}, {ball, floor}), 1.5);
  double out = 0;
  for (std::size_t k = 0; k < trace.states.size(); ++k)
    if (trace.times[k] > 0.5) out = std::max(out, trace.states[k][0].velocity.y);
  return out;
}

}  // namespace

Finding four_walls(const Lab& lab) {
  const double half_width = 2, half_height = 1.5, r = 0.25, thick = 1;
  const Vec2d v{3.1, 2.3};
  const auto wall = [&](const char* name, Vec2d at, double width, double height) {
    return fixed(make(Crate{.name = name, .position = at, .width = width, .height = height}));
  };
  const double x = half_width + thick / 2, y = half_height + thick / 2;
  // The ball's place in the scene must not matter.
  const auto room = [&](std::ptrdiff_t place, double duration) {
    std::vector<Body> bodies{wall("right", {x, 0}, thick, 6), wall("left", {-x, 0}, thick, 6),
                             wall("upper", {0, y}, 7, thick), wall("lower", {0, -y}, 7, thick)};
    bodies.insert(bodies.begin() + place, make(Ball{.velocity = v, .radius = r}));
    return lab.run(scene_of("room", {}, bodies), duration);
  };
  const auto into_walls = [&](const Trace& run, std::size_t place) {
    double out = 0;
    for (const auto& states : run.states) {
      const Vec2d p = states[place].position;
      out = std::max({out, std::abs(p.x) + r - half_width, std::abs(p.y) + r - half_height});
    }
    return out;
  };
  const Trace trace = room(0, 5);
  const double outside = into_walls(trace, 0), among = into_walls(room(2, 2), 2),
               after = into_walls(room(4, 2), 4), most = v.x * lab.dt() + 0.01 * r;
  const double speed = std::hypot(v.x, v.y),
               end = std::hypot(trace.last(0).velocity.x, trace.last(0).velocity.y);
  // Unfold the room at its walls: the straight path then crosses a wall every 2 (half - r).
  const double t = trace.duration();
  const int due = static_cast<int>((v.x * t / (half_width - r) + 1) / 2) +
                  static_cast<int>((v.y * t / (half_height - r) + 1) / 2);
  const std::string passed = wall_passed(trace.last(0), half_width, half_height);
  Judgement judgement;
  judgement.read("farthest into a wall", "m", outside, 0, most)
      .read("turns at walls", "", turns(trace), due, 2)
      .read("speed after 5 s", "m/s", end, speed, 0.002 * speed)
      .read("farthest into a wall if two walls come before the ball in the scene", "m", among, 0, most)
      .read("farthest into a wall if the ball is the last body", "m", after, 0, most);
  if (judgement.good()) return judgement.finding();
  const auto other_wall = wall_of_no_scene(lab);
  return judgement.proven_if(other_wall.has_value(), kWallOfNoScene, other_wall.value_or(""))
      .mistake_if(trace.still(0), "starts_at_rest", kStill)
      .mistake_if(turns(trace) > 2 * due, "turned_every_step", kTurnedEveryStep)
      .mistake_if(!passed.empty() && leaves_straight(trace, half_width - r, half_height - r, r),
                  "wall_missing", fmt::format("The ball leaves through the {} wall.", passed))
      .symptom_if(!passed.empty(), fmt::format("The ball leaves through the {} wall.", passed))
      .symptom_if(end > 1.002 * speed, "The ball gains speed at walls.")
      .symptom_if(end < 0.998 * speed, "The ball loses speed in the air or at walls.")
      .finding();
}

Finding settles(const Lab& lab) {
  const double r = 0.5;
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}));
  const Body ball = make(Ball{.position = {0, 1 + r}, .radius = r, .restitution = 0.5});
  const Trace trace = lab.run(scene_of("settle", {0, -kGravity}, {ball, floor}), 5);
  // Bounces end after sqrt(2 h/g) (1 + e)/(1 - e) = 1.35 s; twice this time is tolerated.
  double high = 0, low = 0;
  for (std::size_t k = 0; k < trace.states.size(); ++k) {
    if (trace.times[k] < 2.7) continue;
    high = std::max(high, trace.states[k][0].position.y - r);
    low = std::min(low, trace.states[k][0].position.y - r);
  }
  const double tolerance = kGravity * lab.dt() * lab.dt() + 0.02 * r;
  const double speed = trace.last(0).velocity.y;
  const double rises = rise_of_sliding_ball(lab);
  double first = 0;  // m, of the first bounce, which begins after 0.45 s
  for (std::size_t k = 0; k < trace.states.size(); ++k)
    if (trace.times[k] > 0.5 && trace.times[k] < 1)
      first = std::max(first, trace.states[k][0].position.y - r);
  return Judgement()
      .read("highest above the floor from 2.7 s on", "m", high, 0, tolerance)
      .read("deepest in the floor from 2.7 s on", "m", low, 0, tolerance)
      .read("vy after 5 s", "m/s", speed, 0, 0.5 * kGravity * lab.dt())
      .read("fastest that a ball which slides on the floor rises", "m/s", rises, 0, 0.4 * kGravity * lab.dt())
      .read("height of the first bounce", "m", first, 0.25, 0.05)
      .read("y of the floor", "m", trace.last(1).position.y, -0.5, 1e-9)
      .read("vy of the floor", "m/s", trace.last(1).velocity.y, 0, 1e-9)
      .read("least change of vy in a step on the way up", "g dt", least_gain_above(lab, trace, r, kGravity),
            1, 0.01)
      .proven_if(
          std::abs(trace.last(1).position.y + 0.5) > 1e-9 || std::abs(trace.last(1).velocity.y) > 1e-9,
          "static_moves",
          "The floor moves: gravity, forces and contacts change only bodies whose type is \"dynamic\".")
      .mistake_if(trace.still(0), "no_gravity", "It hangs in the air: gravity pulls at it.")
      .mistake_if(low < -r, "falls_through",
                  "The ball sinks through the floor: stop it in each step in which it moves towards the "
                  "floor, however slowly.")
      .mistake_if(
          low < -tolerance && high <= tolerance, "sinks",
          "The ball sinks into the floor little by little: correct its position as well as its velocity.")
      .symptom_if(high > 0.5, "The ball keeps bouncing.")
      .mistake_if(high > tolerance, "restless",
                  "The ball keeps bouncing on the floor: gravity adds g dt of speed each step, and that must "
                  "not bounce. "
                  "Take restitution as 0 up to 2 g dt.")
      .finding();
}

}  // namespace plumb::course
