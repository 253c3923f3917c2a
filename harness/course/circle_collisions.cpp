// Chapter 3: collisions of two circles. Without gravity and friction, the speeds after a collision are closed
// forms.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/course/circle_contacts.h"
#include "harness/course/circle_pairs.h"
#include "harness/course/course.h"
#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

constexpr const char* kCircles = "\"shapes\":[\"circle\"] and \"features\":[\"contacts\"]: circles that move";
constexpr double kNever = 1e9;  // m/s

constexpr const char* kNormalNotUnit =
    "The collision is right where r1 + r2 happens to be 1 m, and wrong elsewhere: divide the line of centres "
    "by its "
    "length to get the normal.";

constexpr const char* kNormalFlipped =
    "The two are caught inside each other: they are pushed together when they part and let go when they "
    "close. The "
    "normal is flipped: it points from a to b, and they close when (vb - va) . n < 0.";

Finding detects(const Lab& lab) {
  const double r = 0.3, v = 1, reach = 2 * r;
  const auto meet = [&](double second, double aside = 0) {
    return head_on(lab, {.position = {aside - 1, aside}, .velocity = {v, 0}, .radius = r},
                   {.position = {aside + 1, aside}, .velocity = {-v, 0}, .radius = second});
  };
  const auto nearest_of = [](const Trace& t) {
    double nearest = distance(t, 0);
    for (std::size_t k = 0; k < t.states.size(); ++k) nearest = std::min(nearest, distance(t, k));
    return nearest;
  };
  const double larger = 0.5, smaller = 0.1;
  const Trace trace = meet(r), with_larger = meet(larger), with_smaller = meet(smaller);
  const double nearest = nearest_of(trace), tolerance = 2 * v * lab.dt() + 0.01 * reach;
  const double last = distance(trace, trace.states.size() - 1);
  const bool caught = last < 0.9 * reach && nearest < reach / 4;
  const bool through = !caught && trace.last(0).position.x > trace.last(1).position.x;
  constexpr double kAside = 0.45;  // m, off the borders of cells that begin at the origin
  const bool elsewhere = through && std::abs(nearest_of(meet(r, kAside)) - reach) <= tolerance;
  return Judgement()
      .read("nearest that the centres came", "m", nearest, reach, tolerance)
      .read("nearest of radii 0.3 m and 0.5 m", "m", nearest_of(with_larger), r + larger, tolerance)
      .read("nearest of radii 0.3 m and 0.1 m", "m", nearest_of(with_smaller), r + smaller, tolerance)
      .mistake_if(caught, "normal_flipped", kNormalFlipped)
      .proven_if(
          elsewhere, "place_matters",
          "Two circles go through each other, and collide half a metre beside that: whether two collide "
          "must not depend on the place. If bodies are sorted into cells, compare those of neighbouring "
          "cells as well.")
      .mistake_if(
          through, "no_detection",
          "The circles go through each other: they touch when their centres are nearer than r1 + r2. Is the "
          "contact found, and are the velocities changed?")
      .mistake("diameters", {2 * reach}, "They turn back too early: add the radii, not the diameters.")
      .mistake("one_radius", {r},
               "They turn back too late: compare the distance with r1 + r2, not with one radius.")
      .mistake("square_of_distance", {std::sqrt(reach)},
               "The square of the distance is compared with r1 + r2: compare it with (r1 + r2)^2.")
      .finding();
}

// Returns the velocity of a ball that lands on a post while it moves away from another one, which it still
// overlaps.
Vec2d lands_between(const Lab& lab, bool ball_last) {
  const double r = 0.4, large = 0.9, at = r - 0.01;
  const Body ball = make(Ball{.position = {at, at}, .velocity = {0.5, -1}, .radius = r, .restitution = 0.5});
  const auto post = [&](const char* name, Vec2d centre) {
    return fixed(make(Ball{.name = name, .position = centre, .radius = large, .restitution = 0.5}));
  };
  std::vector<Body> bodies{post("below", {at, -large}), post("left", {-large, at})};
  bodies.insert(ball_last ? bodies.end() : bodies.begin(), ball);
  return lab.run(scene_of("corner", {}, bodies), 0.2).last(ball_last ? 2 : 0).velocity;
}

// Returns vy of a ball that lands on a thin floor while two others, which come first, part in an overlap.
double lands_beside_parting(const Lab& lab) {
  const double v = 6, small = 0.2;
  const Body floor = fixed(
      make(Crate{.name = "floor", .position = {3, -0.05}, .width = 2, .height = 0.1, .restitution = 0}));
  return lab
      .run(scene_of("beside", {},
                    {make(Ball{.name = "a", .position = {-0.25, 0}, .velocity = {-0.1, 0}}),
                     make(Ball{.name = "b", .position = {0.25, 0}, .velocity = {0.1, 0}}),
                     make(Ball{.name = "c",
                               .position = {3, small + 0.01},
                               .velocity = {0, -v},
                               .radius = small,
                               .restitution = 0.5}),
                     floor}),
           0.3)
      .last(2)
      .velocity.y;
}

// Starts two overlapping balls that move apart: their velocities should not change.
Finding parting_is_left_alone(const Lab& lab) try {
  const double v = 1, deep = 0.06, r = 0.4;
  const Trace trace =
      head_on(lab, {.position = {-r + deep / 2, 0}, .velocity = {-v / 2, 0}, .radius = r, .restitution = 0.5},
              {.position = {r - deep / 2, 0}, .velocity = {v / 2, 0}, .radius = r, .restitution = 0.5}, 0.5);
  const double apart = parting(trace.states.back());
  const Vec2d first = lands_between(lab, false), last = lands_between(lab, true);
  return Judgement()
      .read("speed apart of two that overlap and part", "m/s", apart, v, 0.05 * v)
      .read("speed away from a post of a ball that lands on another", "m/s", first.x, 0.5, 0.05 * v)
      .read("speed up after it has landed", "m/s", first.y, 0.5, 0.05 * v)
      .read("speed away from the post if the ball is the last body", "m/s", last.x, 0.5, 0.05 * v)
      .read("speed up in this case", "m/s", last.y, 0.5, 0.05 * v)
      .read("speed up of a ball that lands while two others part", "m/s", lands_beside_parting(lab), 3, 0.05)
      .mistake_if(apart < 0.95 * v, "no_test_of_parting", kPulledBack)
      .mistake_if(
          apart > 1.05 * v, "correction_adds_energy",
          "Two balls that overlap are driven apart: correct positions, and leave velocities as they are.")
      .finding();
} catch (const Error& error) {
  if (error.field() == "overlap") return {};  // an engine may refuse such a start
  throw;
}

Finding equal_masses_swap(const Lab& lab) {
  const double u = 2, w = -1, closing = u - w, r = 0.3, reach = 2 * r;
  const auto meet = [&](double radius, double along = 0) {
    return head_on(lab, {.position = {-2, 0}, .velocity = {u, along}, .radius = radius},
                   {.position = {1, 0}, .velocity = {w, along}, .radius = radius}, 2);
  };
  // A common velocity of both balls changes nothing.
  const double drift = 0.7;
  const Trace trace = meet(r), drifting = meet(r, drift);
  const double mean = (u + w) / 2;
  double nearest = distance(trace, 0);
  for (std::size_t k = 0; k < trace.states.size(); ++k) nearest = std::min(nearest, distance(trace, k));
  const bool caught = distance(trace, trace.states.size() - 1) < 0.9 * reach && nearest < reach / 4;
  Judgement judgement;
  judgement.read("vx of the first", "m/s", trace.last(0).velocity.x, w, kShare * closing)
      .read("vx of the second", "m/s", trace.last(1).velocity.x, u, kShare * closing)
      .read("vx of the first if both drift along y", "m/s", drifting.last(0).velocity.x, w, kShare * closing)
      .read("vy of the first if both drift along y", "m/s", drifting.last(0).velocity.y, drift,
            kShare * closing);
  if (judgement.good()) return judgement.finding();
  const auto off = [&](const Trace& t) {
    return std::abs(t.last(0).velocity.x - w) + std::abs(t.last(1).velocity.x - u);
  };
  const double off_at_1 = off(meet(0.5));
  const bool right_at_1 = off_at_1 < 0.2 * closing && off_at_1 < off(trace) / 3;
  return judgement.mistake_if(caught, "normal_flipped", kNormalFlipped)
      .mistake_if(pulled_back(trace, closing), "no_test_of_parting", kPulledBack)
      .mistake_if(right_at_1, "normal_not_unit", kNormalNotUnit)
      .mistake("no_collision", {u, w},
               "The velocities do not change: no contact is found, or no impulse is applied.")
      .mistake(
          "restitution_ignored", {mean, mean},
          "They stick together: with restitution 1 they part as fast as they came; the impulse has 1 + e. "
          "If you go over contacts several times, compute the bounce once, before the first time.")
      .mistake("each_turned", {-u, -w},
               "Each velocity is reversed by itself: reverse the relative velocity along the normal.")
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
      .finding();
}

constexpr const char* kInverses =
    "The impulse is too weak: it is divided by m1 + m2, which is right only for two masses of 1. It is "
    "-(1 + e) vn/(1/m1 + 1/m2).";

Finding heavy_hits_light(const Lab& lab) {
  const double heavy = 10, light = 1, v = 2;
  // The radii add up to 1.8 m: with a normal that is not normalised, impulses are 3.24 times too strong.
  const auto meet = [&](double radius) {
    return head_on(lab, {.position = {-3, 0}, .velocity = {v, 0}, .mass = heavy, .radius = radius},
                   {.position = {0, 0}, .mass = light, .radius = 0.8 * radius}, 2);
  };
  const Trace trace = meet(1);
  const double j = 2 * v / (1 / heavy + 1 / light);
  const double after_heavy = v - j / heavy, after_light = j / light, wrong_j = 2 * v / (heavy + light);
  const double together = v * heavy / (heavy + light);  // if they stay together: any number of weak impacts
  int changes = 0;                                      // steps in which the heavy ball's velocity changes
  for (std::size_t k = 1; k < trace.states.size(); ++k)
    changes += std::abs(trace.states[k][0].velocity.x - trace.states[k - 1][0].velocity.x) > 1e-6 * v;
  Judgement judgement;
  judgement.read("vx of 10 kg", "m/s", trace.last(0).velocity.x, after_heavy, kShare * v)
      .read("vx of 1 kg", "m/s", trace.last(1).velocity.x, after_light, kShare * v);
  if (judgement.good()) return judgement.finding();
  const auto off = [&](const Trace& t) {
    return std::abs(t.last(0).velocity.x - after_heavy) + std::abs(t.last(1).velocity.x - after_light);
  };
  const double off_at_1 = off(meet(1 / 1.8));
  // Changes only the masses. With a correct motion, all other quantities stay correct, along y as well.
  const auto alike_at = [&](double mass) {
    const Trace t = head_on(lab, {.position = {-3, 0}, .velocity = {v, 0}, .mass = mass, .radius = 1},
                            {.position = {0, 0}, .mass = mass, .radius = 0.8}, 2);
    const Vec2d wrong[] = {t.last(0).velocity, t.last(1).velocity - Vec2d{v, 0}};
    return std::abs(wrong[0].x) + std::abs(wrong[0].y) + std::abs(wrong[1].x) + std::abs(wrong[1].y) <
           0.01 * v;
  };
  const bool straight = trace.last(0).velocity.y == 0 && trace.last(1).velocity.y == 0;
  const bool alike_is_right = straight && alike_at(light) && alike_at(heavy);
  const bool right_at_1 = off_at_1 < 0.2 * v && off_at_1 < off(trace) / 3;
  return judgement.mistake_if(right_at_1, "normal_not_unit", kNormalNotUnit)
      .mistake_if(pulled_back(trace, v), "no_test_of_parting", kPulledBack)
      .mistake("masses_ignored", {0, v}, "They swap velocities as equal masses do: the masses are not used.")
      .mistake("inverse_mass_forgotten", {v - j, j},
               "Both velocities change by j: each should change by j times its own inverse mass, so that the "
               "heavy "
               "ball barely slows.")
      .mistake("masses_in_place_of_inverses", {v - wrong_j / heavy, wrong_j / light}, kInverses)
      .mistake("masses_in_place_of_inverses", {changes > 2 ? together : kNever, together}, kInverses)
      .mistake("restitution_ignored", {changes > 2 ? kNever : together, together},
               "They go on together: with restitution 1 they part as fast as they came.")
      .mistake("no_collision", {alike_is_right ? kNever : v, 0},
               "The velocities do not change: no contact is found, or no impulse is applied.")
      .otherwise_if(
          alike_is_right, "masses_wrong",
          "The collision is right for equal masses and wrong for 10 kg and 1 kg: the impulse is -(1 + "
          "e) vn/(1/ma + 1/mb), and each velocity changes by it times its own inverse mass.")
      .mistake("masses_swapped", {v - j / light, j / heavy}, "Each ball gets the other's inverse mass.")
      .mistake("effective_mass_forgotten", {v - 2 * v / heavy, 2 * v / light},
               "The impulse is not divided by 1/m1 + 1/m2.")
      .mistake("multiplied_by_mass", {v - j * heavy, j * light},
               "The impulse is multiplied by the masses: divide.")
      .finding();
}

Finding restitution(const Lab& lab) {
  const double u = 2, w = -1, closing = u - w, mean = (u + w) / 2, e = 0.5;
  const auto after = [&](double first, double second) {
    return head_on(lab, {.position = {-2, 0}, .velocity = {u, 0}, .restitution = first},
                   {.position = {1, 0}, .velocity = {w, 0}, .restitution = second}, 2);
  };
  const double less = 0.2;
  const Trace dead = after(0, 0), half = after(e, e), mixed = after(e, less), other = after(less, e);
  const auto apart = [](const Trace& trace) { return parting(trace.states.back()); };
  return Judgement()
      .read("vx of the first at e = 0", "m/s", dead.last(0).velocity.x, mean, kShare * closing)
      .read("speed apart at e = 0", "m/s", apart(dead), 0, kShare * closing)
      .read("speed apart at e = 0.5", "m/s", apart(half), e * closing, kShare * closing)
      .read("speed apart at e = 0.5 and 0.2", "m/s", apart(mixed), e * closing, kShare * closing)
      .read("speed apart at e = 0.2 and 0.5", "m/s", apart(other), e * closing, kShare * closing)
      .mistake("always_elastic", {w, closing, closing},
               "Every collision is elastic: restitution is not used.")
      .mistake("restitution_ignored", {mean, 0, 0}, "No collision bounces: restitution is not used.")
      .mistake("restitution_squared", {mean, 0, e * e * closing},
               "Restitution is applied twice, or both balls' are multiplied: \"contact_rules\" says maximum, "
               "and it "
               "multiplies the speed once.")
      .mistake("one_plus_forgotten", {u, -closing, -(1 - e) * closing},
               "The impulse has e where it should have 1 + e: with e = 0 it must still stop the two.")
      .mistake("halved", {kAny, -closing / 2, kAny},
               "With e = 0 they still close: the impulse is half of what it should be.")
      .finding();
}

Finding oblique(const Lab& lab) {
  const double r = 0.4, v = 2, offset = r, d = 2 * r;  // line of centres at contact: 30 degrees
  // Rotate by -25 degrees, so that the approach, the line of centres and the axes all differ widely.
  const double turn = -25 * std::numbers::pi / 180;
  const auto meet = [&](Rotation<double> q) {
    return head_on(lab, {.position = q * Vec2d{-2, offset}, .velocity = q * Vec2d{v, 0}, .radius = r},
                   {.position = {0, 0}, .radius = r}, 2);
  };
  const Rotation<double> q{std::cos(turn), std::sin(turn)};
  const Trace trace = meet({1, 0}), turned = meet(q);
  const double s = offset / d, c = std::sqrt(1 - s * s);
  const Vec2d n{c, -s}, hit = v * c * n, stays = Vec2d{v, 0} - hit;
  // If the contact is detected a step late, the line of centres has turned by at most v dt s/d, and the
  // velocities by twice that.
  const double tolerance = 2 * v * (v * lab.dt() * s / d) + kShare * v;
  const Vec2d a = trace.last(0).velocity, b = trace.last(1).velocity;
  const Vec2d ta = q.inverse() * turned.last(0).velocity, tb = q.inverse() * turned.last(1).velocity;
  // Rotates the result with the scene. Mistakes that follow the coordinate axes differ.
  const auto gives = [](Vec2d first, Vec2d second) {
    return std::vector<double>{first.x, first.y, second.x, second.y, first.x, first.y, second.x, second.y};
  };
  return Judgement()
      .read("vx of the first", "m/s", a.x, stays.x, tolerance)
      .read("vy of the first", "m/s", a.y, stays.y, tolerance)
      .read("vx of the second", "m/s", b.x, hit.x, tolerance)
      .read("vy of the second", "m/s", b.y, hit.y, tolerance)
      .read("the first along the approach, turned by -25 degrees", "m/s", ta.x, stays.x, tolerance)
      .read("the first across the approach, turned by -25 degrees", "m/s", ta.y, stays.y, tolerance)
      .read("the second along the approach, turned by -25 degrees", "m/s", tb.x, hit.x, tolerance)
      .read("the second across the approach, turned by -25 degrees", "m/s", tb.y, hit.y, tolerance)
      .mistake("whole_velocity", gives({0, 0}, {v, 0}),
               "The whole velocities are exchanged: only the parts along the line of centres are.")
      .mistake("normal_not_unit", gives(Vec2d{v, 0} - d * d * hit, d * d * hit),
               "The impulse is off by the square of the distance: divide the line of centres by its length.")
      .mistake("normal_along_velocity", gives({0, 0}, {v * c, 0}),
               "The impulse follows the velocity: it follows the line of centres.")
      .mistake("tangent", gives(hit, stays), "The parts along and across the line of centres are mixed up.")
      .mistake("y_of_normal_flipped", {stays.x, -stays.y, hit.x, -hit.y},
               "The y of the normal has the wrong sign.")
      .mistake("no_collision", gives({v, 0}, {0, 0}),
               "They pass each other: circles touch off their centres as well.")
      .finding();
}

}  // namespace

Chapter circle_collisions() {
  return {.number = 3,
          .title = "Circles that collide",
          .page = "3-circle-collisions.md",
          .checks = {
              {"detects", "circles touch at r1 + r2", kCircles, detects},
              {"equal_masses_swap", "equal masses swap their velocities", kCircles, equal_masses_swap},
              {"overlap_is_shared", "an overlap is corrected by inverse masses", kCircles, overlap_is_shared},
              {"parting_is_left_alone", "balls that overlap and part are left alone", kCircles,
               parting_is_left_alone},
              {"heavy_hits_light", "a heavy ball barely slows", kCircles, heavy_hits_light},
              {"restitution_of_two", "restitution from 0 to 1", kCircles, restitution},
              {"oblique", "only the part along the line of centres changes", kCircles, oblique},
              {"post", "a static post does not move, and sends the ball back", kCircles, post},
              {"break_shot", "a break keeps momentum and energy", kCircles, break_shot, false},
              {"pile_rests", "a ball rests on a ball", kCircles, pile_rests}}};
}

}  // namespace plumb::course
