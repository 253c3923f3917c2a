// Chapter 3: collisions of circles. Without gravity and friction, the speeds after a collision are closed
// forms.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/course/course.h"
#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

constexpr const char* kCircles = "\"shapes\":[\"circle\"] and \"features\":[\"contacts\"]: circles that move";
constexpr double kNever = 1e9;    // m/s
constexpr double kShare = 0.002;  // of the closing speed: tolerance for a contact's softness

double distance(const Trace& trace, std::size_t k) {
  const Vec2d way = trace.states[k][1].position - trace.states[k][0].position;
  return std::hypot(way.x, way.y);
}

Trace head_on(const Lab& lab, Ball a, Ball b, double duration = 1.5) {
  a.name = "a";
  b.name = "b";
  return lab.run(scene_of("head on", {}, {make(a), make(b)}), duration);
}

Finding detects(const Lab& lab) {
  const double r = 0.3, v = 1, reach = 2 * r;
  const Trace trace = head_on(lab, {.position = {-1, 0}, .velocity = {v, 0}, .radius = r},
                              {.position = {1, 0}, .velocity = {-v, 0}, .radius = r});
  double nearest = distance(trace, 0);
  for (std::size_t k = 0; k < trace.states.size(); ++k) nearest = std::min(nearest, distance(trace, k));
  const bool through = trace.last(0).position.x > trace.last(1).position.x;
  const double tolerance = 2 * v * lab.dt() + 0.01 * reach;
  return Judgement()
      .read("nearest that the centres came", "m", nearest, reach, tolerance)
      .mistake_if(through, "no_detection",
                  "The circles go through each other: they touch when their centres are nearer than r1 + r2.")
      .mistake("diameters", {2 * reach}, "They turn back too early: add the radii, not the diameters.")
      .mistake("one_radius", {r},
               "They turn back too late: the distance is held against one radius, not r1 + r2.")
      .mistake("square_of_distance", {std::sqrt(reach)},
               "The square of the distance is held against r1 + r2: square both.")
      .finding();
}

Finding equal_masses_swap(const Lab& lab) {
  const double u = 2, w = -1, closing = u - w;
  const Trace trace =
      head_on(lab, {.position = {-2, 0}, .velocity = {u, 0}}, {.position = {1, 0}, .velocity = {w, 0}}, 2);
  const double mean = (u + w) / 2;
  double nearest = distance(trace, 0);
  for (std::size_t k = 0; k < trace.states.size(); ++k) nearest = std::min(nearest, distance(trace, k));
  const bool caught = distance(trace, trace.states.size() - 1) < 0.9 && nearest < 0.25;  // radii of 0.5
  return Judgement()
      .read("vx of the first", "m/s", trace.last(0).velocity.x, w, kShare * closing)
      .read("vx of the second", "m/s", trace.last(1).velocity.x, u, kShare * closing)
      .mistake("no_collision", {u, w}, "Nothing happens to the velocities: the contact is not answered.")
      .mistake(
          "restitution_ignored", {mean, mean},
          "They stick together: restitution 1 sends them apart as fast as they came, (1 + e) in the impulse.")
      .mistake(
          "each_turned", {-u, -w},
          "Each velocity is turned round by itself: it is the relative velocity along the normal that turns.")
      .mistake_if(trace.last(0).velocity.x > u + closing / 2 && trace.last(1).velocity.x < w - closing / 2,
                  "impulse_backwards",
                  "They speed up into each other: the impulse has the wrong sign. The normal points from a "
                  "to b, and a "
                  "gets -j n, b +j n.")
      .mistake("one_body_only", {w, w},
               "Only the first ball gets an impulse: the second gets the opposite one.")
      .mistake("one_body_only", {u - closing, w},
               "Only the first ball gets an impulse: the second gets the opposite one.")
      .mistake("one_body_only", {u, u},
               "Only the second ball gets an impulse: the first gets the opposite one.")
      .mistake("one_body_only", {u, w + closing},
               "Only the second ball gets an impulse: the first gets the opposite one.")
      .mistake_if(
          caught, "normal_flipped",
          "The two are caught inside each other: they are pushed together when they part and let go when "
          "they "
          "close. The normal is flipped: it points from a to b, and they close when (vb - va) . n < 0.")
      .finding();
}

constexpr const char* kInverses =
    "The blow is too weak: the impulse is divided by m1 + m2, which is right for two masses of 1 alone. It "
    "is "
    "-(1 + e) vn/(1/m1 + 1/m2).";

Finding heavy_hits_light(const Lab& lab) {
  const double heavy = 10, light = 1, v = 2;
  const Trace trace = head_on(lab, {.position = {-2, 0}, .velocity = {v, 0}, .mass = heavy},
                              {.position = {0, 0}, .mass = light}, 2);
  const double j = 2 * v / (1 / heavy + 1 / light);
  const double after_heavy = v - j / heavy, after_light = j / light, wrong_j = 2 * v / (heavy + light);
  const double together = v * heavy / (heavy + light);  // after any number of weak impacts
  int blows = 0;                                        // steps in which the heavy ball's velocity changes
  for (std::size_t k = 1; k < trace.states.size(); ++k)
    blows += std::abs(trace.states[k][0].velocity.x - trace.states[k - 1][0].velocity.x) > 1e-6 * v;
  return Judgement()
      .read("vx of 10 kg", "m/s", trace.last(0).velocity.x, after_heavy, kShare * v)
      .read("vx of 1 kg", "m/s", trace.last(1).velocity.x, after_light, kShare * v)
      .mistake("masses_ignored", {0, v}, "They swap velocities as equal masses do: the masses are not used.")
      .mistake("inverse_mass_forgotten", {v - j, j},
               "Both velocities change by j: each changes by j times its inverse mass, so the heavy ball "
               "barely slows.")
      .mistake("masses_in_place_of_inverses", {v - wrong_j / heavy, wrong_j / light}, kInverses)
      .mistake("masses_in_place_of_inverses", {blows > 2 ? together : kNever, together}, kInverses)
      .mistake("restitution_ignored", {blows > 2 ? kNever : together, together},
               "They go on together: restitution 1 sends them apart as fast as they came.")
      .mistake("masses_swapped", {v - j / light, j / heavy}, "Each ball gets the other's inverse mass.")
      .mistake("effective_mass_forgotten", {v - 2 * v / heavy, 2 * v / light},
               "The impulse is not divided by 1/m1 + 1/m2.")
      .mistake("multiplied_by_mass", {v - j * heavy, j * light},
               "The impulse is multiplied by the masses: divide.")
      .finding();
}

Finding restitution(const Lab& lab) {
  const double u = 2, w = -1, closing = u - w, mean = (u + w) / 2, e = 0.5;
  const auto after = [&](double restitution) {
    return head_on(lab, {.position = {-2, 0}, .velocity = {u, 0}, .restitution = restitution},
                   {.position = {1, 0}, .velocity = {w, 0}, .restitution = restitution}, 2);
  };
  const Trace dead = after(0), half = after(e);
  const auto parting = [](const Trace& trace) { return trace.last(1).velocity.x - trace.last(0).velocity.x; };
  return Judgement()
      .read("vx of the first at e = 0", "m/s", dead.last(0).velocity.x, mean, kShare * closing)
      .read("speed apart at e = 0", "m/s", parting(dead), 0, kShare * closing)
      .read("speed apart at e = 0.5", "m/s", parting(half), e * closing, kShare * closing)
      .mistake("always_elastic", {w, closing, closing},
               "Every collision is elastic: restitution is not used.")
      .mistake("restitution_ignored", {mean, 0, 0}, "No collision bounces: restitution is not used.")
      .mistake("restitution_squared", {mean, 0, e * e * closing},
               "Restitution counts twice, or both balls' are multiplied: it is a ratio of speeds, once.")
      .mistake("one_plus_forgotten", {u, -closing, -(1 - e) * closing},
               "The impulse has e where it should have 1 + e: without bounce it must still stop the two.")
      .mistake("halved", {kAny, -closing / 2, kAny},
               "Without bounce they still close: the impulse is half of what it should be.")
      .finding();
}

Finding oblique(const Lab& lab) {
  const double r = 0.4, v = 2, offset = r, d = 2 * r;  // line of centres at contact: 30 degrees
  const Trace trace = head_on(lab, {.position = {-2, offset}, .velocity = {v, 0}, .radius = r},
                              {.position = {0, 0}, .radius = r}, 2);
  const double s = offset / d, c = std::sqrt(1 - s * s);
  const Vec2d n{c, -s}, hit = v * c * n, stays = Vec2d{v, 0} - hit;
  // Detected a step late, the line of centres has turned by at most v dt s/d, and velocities by twice that.
  const double tolerance = 2 * v * (v * lab.dt() * s / d) + kShare * v;
  const Vec2d a = trace.last(0).velocity, b = trace.last(1).velocity;
  const auto gives = [](Vec2d first, Vec2d second) {
    return std::vector<double>{first.x, first.y, second.x, second.y};
  };
  return Judgement()
      .read("vx of the first", "m/s", a.x, stays.x, tolerance)
      .read("vy of the first", "m/s", a.y, stays.y, tolerance)
      .read("vx of the second", "m/s", b.x, hit.x, tolerance)
      .read("vy of the second", "m/s", b.y, hit.y, tolerance)
      .mistake("whole_velocity", gives({0, 0}, {v, 0}),
               "The whole velocities are exchanged: only the parts along the line of centres are.")
      .mistake("normal_not_unit", gives(Vec2d{v, 0} - d * d * hit, d * d * hit),
               "The impulse is off by the square of the distance: divide the line of centres by its length.")
      .mistake("normal_along_velocity", gives({0, 0}, {v * c, 0}),
               "The impulse follows the velocity: it follows the line of centres.")
      .mistake("tangent", gives(hit, stays), "The parts along and across the line of centres are mixed up.")
      .mistake("y_of_normal_flipped", gives({stays.x, -stays.y}, {hit.x, -hit.y}),
               "The y of the normal has the wrong sign.")
      .mistake("no_collision", gives({v, 0}, {0, 0}), "They pass: circles at an offset touch as well.")
      .finding();
}

Finding post(const Lab& lab) {
  const double v = 2, start = -2;
  const Body ball = make(Ball{.position = {start, 0}, .velocity = {v, 0}});
  const Trace trace = lab.run(scene_of("post", {}, {ball, fixed(make(Ball{.name = "post"}))}), 1.5);
  const double t = trace.duration(), touches = -1, late = v * lab.dt();
  return Judgement()
      .read("vx of the ball", "m/s", trace.last(0).velocity.x, -v, kShare * v)
      .read("vy of the ball", "m/s", trace.last(0).velocity.y, 0, kShare * v)
      .read("x of the ball", "m", trace.last(0).position.x, touches - (v * t - (touches - start)), 3 * late)
      .read("x of the post", "m", trace.last(1).position.x, 0, 1e-9)
      .mistake_if(trace.still(0), "starts_at_rest", "The ball never moves.")
      .mistake(
          "static_has_mass", {0, 0, touches, kAny},
          "The ball stops at the post: the post takes the blow as a ball of 1 kg would, and a static body's "
          "inverse mass is 0; or no collision bounces, as the checks before would say.")
      .mistake("static_moves", {-v, 0, kAny, kAny},
               "The static post moves: it stands still whatever hits it.")
      .mistake("no_collision", {v, 0, start + v * t, 0}, "The ball goes through the static post.")
      .finding();
}

// Returns the separation speed of two balls that overlap at the start; nothing should drive them apart. It is
// 0 for an engine that refuses such a start.
double kick(const Lab& lab) try {
  const double r = 0.5, deep = 0.1;
  const Trace trace = head_on(lab, {.position = {-r + deep / 2, 0}, .radius = r, .restitution = 0},
                              {.position = {r - deep / 2, 0}, .radius = r, .restitution = 0}, 2);
  return trace.last(1).velocity.x - trace.last(0).velocity.x;
} catch (const Error& error) {
  if (error.field() == "overlap") return 0;
  throw;
}

Finding break_shot(const Lab& lab) {
  const double r = 0.2, gap = 0.06, v = 2;  // slower than a gap a step: collisions do not coincide
  std::vector<Body> bodies{
      make(Ball{.name = "cue", .position = {-1, 0.12}, .velocity = {v, 0}, .radius = r})};
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i <= row; ++i) {
      const double pitch = 2 * r + gap;
      bodies.push_back(make(Ball{.name = fmt::format("ball{}{}", row, i),
                                 .position = {row * pitch * std::sqrt(3.0) / 2, (i - row / 2.0) * pitch},
                                 .radius = r}));
    }
  }
  const Trace trace = lab.run(scene_of("break", {}, bodies), 3);
  Vec2d momentum{};
  double energy = 0, overlap = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    momentum += trace.last(i).velocity;
    energy += dot(trace.last(i).velocity, trace.last(i).velocity) / 2;
    for (std::size_t j = 0; j < i; ++j) {
      const Vec2d way = trace.last(i).position - trace.last(j).position;
      overlap = std::max(overlap, 2 * r - std::hypot(way.x, way.y));
    }
  }
  const double e0 = v * v / 2, ratio = energy / e0, p = std::hypot(momentum.x - v, momentum.y) / v;
  const double parting = kick(lab);
  return Judgement()
      .read("momentum lost", "of all", p, 0, lab.rounding(20, 3))
      .read("energy kept", "of all", ratio, 1, 0.02)
      .read("overlap at the end", "m", overlap, 0, v * lab.dt())
      .read("speed apart of two that overlap", "m/s", parting, 0, 0.05)
      .mistake_if(p > 0.01, "momentum_not_kept",
                  "Momentum is lost or made: what one ball gets the other must lose. Are both changed, by "
                  "opposite impulses, with velocities read before either is changed?")
      .mistake_if(
          std::abs(parting) > 0.05, "correction_adds_energy",
          fmt::format("Two balls that overlap fly apart, and energy is {:.2f} times what it was: pushing "
                      "overlaps apart must move positions and leave velocities alone.",
                      ratio))
      .mistake_if(ratio > 1.02, "impulse_too_strong",
                  fmt::format("Energy grows to {:.2f} times: impulses are too strong, or contacts that part "
                              "already get one.",
                              ratio))
      .mistake_if(
          ratio < 0.98, "energy_lost",
          "Elastic balls lose energy: restitution is 1 here. Is a contact answered twice a step, or with "
          "the velocities of before another one?")
      .mistake_if(overlap > v * lab.dt(), "overlaps_stay",
                  "Balls stay in each other: push them apart as well.")
      .finding();
}

Finding pile_rests(const Lab& lab) {
  const double r = 0.5, g = 9.81, drop = 0.1;
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}));
  const Body lower = make(Ball{.name = "lower", .position = {0, r + drop}, .radius = r, .restitution = 0});
  const Body upper =
      make(Ball{.name = "upper", .position = {0, 3 * r + 2 * drop}, .radius = r, .restitution = 0});
  const Trace trace = lab.run(scene_of("pile", {0, -g}, {lower, upper, floor}), 1.5);
  const double height = trace.last(0).position.y - r;
  const double gap = trace.last(1).position.y - trace.last(0).position.y - 2 * r;
  const double tolerance = g * lab.dt() * lab.dt() + 0.04 * r;
  return Judgement()
      .read("lower ball above the floor", "m", height, 0, tolerance)
      .read("upper ball above the lower", "m", gap, 0, tolerance)
      .read("vy of the upper", "m/s", trace.last(1).velocity.y, 0, 2 * g * lab.dt())
      .mistake_if(trace.still(0), "no_gravity", "It hangs in the air: gravity pulls at it.")
      .mistake_if(height < -2 * r || gap < -2 * r, "falls_through",
                  "A ball sinks through what it rests on: contacts hold as long as two overlap and close.")
      .mistake_if(
          height < -tolerance || gap < -tolerance, "sinks",
          "The pile sinks in: besides the velocities, move two that overlap apart, each by its share of "
          "the inverse masses.")
      .mistake_if(height > tolerance || gap > tolerance, "restless",
                  "The pile does not come to rest: restitution is 0 here, what gravity adds in a step must "
                  "not bounce, and "
                  "pushing overlaps apart must leave velocities alone.")
      .finding();
}

}  // namespace

Chapter circle_collisions() {
  return {.number = 3,
          .title = "Circles that collide",
          .page = "3-circle-collisions.md",
          .checks = {{"detects", "circles touch at r1 + r2", kCircles, detects},
                     {"equal_masses_swap", "equal masses swap their velocities", kCircles, equal_masses_swap},
                     {"heavy_hits_light", "a heavy ball barely slows", kCircles, heavy_hits_light},
                     {"restitution_of_two", "restitution from 0 to 1", kCircles, restitution},
                     {"oblique", "only the part along the line of centres changes", kCircles, oblique},
                     {"post", "what is static takes no blow", kCircles, post},
                     {"break_shot", "a break keeps momentum and energy", kCircles, break_shot},
                     {"pile_rests", "a ball rests on a ball", kCircles, pile_rests}}};
}

}  // namespace plumb::course
