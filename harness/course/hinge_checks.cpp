#include "harness/course/hinge_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/course/pendulum.h"
#include "harness/course/scenes.h"
#include "harness/course/turning_scenes.h"

namespace plumb::course {
namespace {

constexpr double kGravity = 9.81;
constexpr double kPi = std::numbers::pi;

// Returns the farthest that three rods at rest move which two hinges join near their ends. The outer rods lie
// under the ends of the middle one like shingles. Rods of 1 m overlap there by 0.03 m, and shorter ones do
// not touch. A push out of this overlap is across the rods, so that it turns them about the hinges, and a
// correction of the joints cannot take it back. The hinges are at the ends of the outer rods, so that a push
// at the points of contact has a lever as well.
double three_rods_move(const Lab& lab, double l) {
  constexpr double kPitch = 0.9, kRaised = 0.07;            // m, from centre to centre
  constexpr double kOuter = 0.5, kInner = kPitch - kOuter;  // m, from a centre to the hinge
  std::vector<Body> rods;
  for (const char* name : {"a", "b", "c"})
    rods.push_back(
        make(Crate{.name = name,
                   .position = {kPitch * static_cast<double>(rods.size()), rods.size() == 1 ? kRaised : 0},
                   .width = l,
                   .height = 0.1}));
  Scene scene = scene_of("three rods", {}, std::move(rods));
  const auto join = [&](const char* outer, double side) {
    RevoluteJoint hinge;
    hinge.name = outer;
    hinge.body_a = outer;
    hinge.body_b = "b";
    hinge.anchor_a = {side * kOuter, kRaised / 2};
    hinge.anchor_b = {-side * kInner, -kRaised / 2};
    scene.joints.emplace_back(hinge);
  };
  join("a", 1);
  join("c", -1);
  const Trace trace = lab.run(scene, 0.5);
  double most = 0;
  for (const auto& states : trace.states)
    for (std::size_t i = 0; i < states.size(); ++i)
      most = std::max(most, length(states[i].position - trace.first(i).position));
  return most;
}

}  // namespace

Finding hinged_rod(const Lab& lab) {
  const double l = 1, h = 0.1, mass = 2, amplitude = kPi / 6;
  const double about_centre = mass * (l * l + h * h) / 12, about_end = about_centre + mass * l * l / 4;
  const double angle = amplitude - kPi / 2;  // of the rod's x axis; it hangs at -90 degrees
  Scene scene = scene_of("hinge", {0, -kGravity},
                         {make(Crate{.name = "rod",
                                     .position = {l / 2 * std::cos(angle), l / 2 * std::sin(angle)},
                                     .angle = angle,
                                     .mass = mass,
                                     .width = l,
                                     .height = h})});
  RevoluteJoint hinge;
  hinge.name = "hinge";
  hinge.body_a = kWorld;
  hinge.body_b = "rod";
  hinge.anchor_b = {-l / 2, 0};
  scene.joints.emplace_back(hinge);
  const Trace trace = lab.run(scene, 10);
  const auto swing = [](const std::vector<BodyState>& s) {
    return std::atan2(s[0].position.x, -s[0].position.y);
  };
  const auto period_with = [&](double inertia) {
    return 2 * kPi * std::sqrt(inertia / (mass * kGravity * l / 2)) * period_ratio(amplitude);
  };
  double gap = 0;
  for (const auto& states : trace.states) {
    const double a = states[0].angle;
    gap = std::max(gap, length(states[0].position - l / 2 * Vec2d{std::cos(a), std::sin(a)}));
  }
  // If a hinge does not rotate its anchor, it pulls the rod's centre to half a length right of it within a
  // second.
  double to_unturned = l;
  for (std::size_t k = 0; k < trace.states.size() && trace.times[k] < 1; ++k)
    to_unturned = std::min(to_unturned, length(trace.states[k][0].position - Vec2d{l / 2, 0}));
  // The anchor's speed along x and y: a hinge holds both at 0.
  double slides_x = 0, slides_y = 0;
  for (std::size_t k = 1; k < trace.states.size() && trace.times[k] < 0.5; ++k) {
    const BodyState& s = trace.states[k][0];
    const Vec2d arm = -l / 2 * Vec2d{std::cos(s.angle), std::sin(s.angle)};
    slides_x = std::max(slides_x, std::abs(s.velocity.x - s.angular_velocity * arm.y));
    slides_y = std::max(slides_y, std::abs(s.velocity.y + s.angular_velocity * arm.x));
  }
  const double less = std::min(slides_x, slides_y), more = std::max(slides_x, slides_y),
               slides = std::hypot(slides_x, slides_y);
  // The same rod on a post that it overlaps: joined bodies do not collide.
  const auto gap_on_post = [&] {
    Scene joined = scene;
    joined.bodies.push_back(fixed(make(Crate{.name = "post", .width = 0.4, .height = 0.4})));
    std::get<RevoluteJoint>(joined.joints.front()).body_a = "post";
    double most = 0;
    for (const auto& states : lab.run(joined, 1).states)
      most = std::max(most, length(states[0].position -
                                   l / 2 * Vec2d{std::cos(states[0].angle), std::sin(states[0].angle)}));
    return most;
  };
  const double at_post = gap_on_post();
  // A rod at rest along x without gravity, whose anchor is 2 cm off the hinge: returns the gap that remains.
  const auto left_of = [&](Vec2d off) {
    Scene parted = scene;
    parted.gravity = {};
    parted.bodies[0].angle = 0;
    parted.bodies[0].position = Vec2d{l / 2, 0} + off;
    const BodyState end = lab.run(parted, 1).last(0);
    return length(end.position - l / 2 * Vec2d{std::cos(end.angle), std::sin(end.angle)});
  };
  const double parted = 0.02;
  const bool held = gap <= 0.01 * l * lab.coarseness();
  // A rod without a gap stays in place unless its anchor is computed at the wrong point.
  const auto stays = [&] {
    Scene still = scene;
    still.gravity = {};
    const Trace t = lab.run(still, 1);
    return length(t.last(0).position - t.first(0).position) < parted / 4;
  };
  const bool turns_wrong =
      !held && stays() && left_of({parted, 0}) < parted / 4 && left_of({0, parted}) > parted;
  // A rod along x, whose anchor need not be rotated. A hinge that acts along one axis only does not hold
  // along the other one here either.
  const auto holds_unturned = [&] {
    Scene unturned = scene;
    unturned.gravity = {};
    unturned.bodies[0].angle = 0;
    unturned.bodies[0].position = {l / 2, 0};
    unturned.bodies[0].velocity = {1, 1};
    const BodyState end = lab.run(unturned, 1.5 * lab.dt()).last(0);
    return std::abs(end.velocity.x) < 0.2 && std::abs(end.velocity.y - end.angular_velocity * l / 2) < 0.2;
  };
  const double due = period_with(about_end);
  const Stretch stick = stick_at_a_rods_end(lab);
  const std::optional<double> period = period_of(trace, swing);
  const bool still = length(trace.last(0).position - trace.first(0).position) < 0.01 * l;
  const std::optional<double> stiffness = held ? std::nullopt : stiffness_of_joints(lab, true);
  return Judgement()
      .read("period", "s", period.value_or(0), due, due * lab.method_error(2 * kPi / due, 0.005))
      .read("largest gap at the hinge", "m", gap, 0, 0.01 * l * lab.coarseness())
      .read("gap on a post that the rod overlaps", "m", at_post, 0, 0.01 * l * lab.coarseness())
      .read("fastest that the hinged end moves, by the velocity and spin of the rod", "m/s", slides, 0,
            0.5 * lab.coarseness())
      .read("largest change of length of a stick between the end of a rod and a ball", "m", stick.change, 0,
            0.02 * lab.coarseness())
      .read("fastest that the ends of this stick part or close, by their velocities", "m/s", stick.speed, 0,
            0.2 * lab.coarseness())
      .read("farthest that two balls on a stick sink in the floor", "m", sinks_of_joined_balls(lab), 0, 0.03)
      .proven_if(stiffness.has_value(), "joint_as_spring", spring_text(stiffness.value_or(0)))
      .proven_if(held && at_post > 0.01 * l * lab.coarseness(), "joined_bodies_collide",
                 "The rod is pushed out of the post that it hangs on: bodies that a joint connects do not "
                 "collide, unless \"collide\" is true.")
      .proven_if(more > 0.2 && less < 0.1 * more && !holds_unturned(), "hinge_one_axis",
                 fmt::format("The hinge holds its anchor along {0} and lets go along {1}: solve both, along "
                             "(1, 0) and along (0, 1).",
                             slides_x < slides_y ? "x" : "y", slides_x < slides_y ? "y" : "x"))
      .mistake_if(
          turns_wrong, "correction_turns_backwards",
          "A gap along the rod closes and one across it grows: correcting the hinge's positions turns the "
          "bodies the wrong way. The angle changes by (r x push)/I, with the push that moves this body.")
      .mistake_if(gap > 0.2 * l && to_unturned < l / 4, "anchor_not_turned",
                  "The anchor does not turn with the rod: turn \"anchor_b\" by the body's angle to get r.")
      .mistake_if(
          !period && still, "lever_forgotten",
          "The rod does not swing: if gravity acts on it, the hinge holds its centre. It should hold the "
          "anchor, r from the centre: the anchor's velocity is v + w x r, and an impulse changes the spin by "
          "r x j/I.")
      .mistake(
          "rod_as_point", {period_with(mass * l * l / 4), kAny},
          "The rod swings as a point at its centre would: it turns as well, r x j/I, and its inertia counts.")
      .mistake("inertia_sixth", {period_with(2 * about_centre + mass * l * l / 4), kAny},
               "It swings slowly: is the inertia 1/6 where it should be 1/12?")
      .mistake("inertia_half", {period_with(about_centre / 2 + mass * l * l / 4), kAny},
               "It swings fast: is the inertia 1/24 where it should be 1/12?")
      .mistake_if(gap > 0.2 * l, "joint_ignored", "The rod leaves its hinge.")
      .mistake_if(gap > 0.01 * l * lab.coarseness(), "no_position_correction",
                  "The hinge comes apart: correct the positions as well.")
      .finding();
}

namespace {

// Result of closing a gap at a hinge.
struct Closing {
  double gap = 0;   ///< m
  double turn = 0;  ///< sum of m r x dr + I da, as a fraction of the sum of |I da|
  Vec2d shift;      ///< m, of the common centre
};

}  // namespace

Finding hinge_turns_both(const Lab& lab) {
  const double w = 3, half_a = 0.5, half_b = 0.4, h = 0.1;
  const Vec2d arm{0, half_b};
  Scene scene = scene_of("rods", {},
                         {make(Crate{.name = "a", .mass = 2, .width = 2 * half_a, .height = h}),
                          make(Crate{.name = "b",
                                     .position = Vec2d{half_a, 0} + arm,
                                     .velocity = cross(w, arm),
                                     .angle = kPi / 2,
                                     .angular_velocity = w,
                                     .mass = 1,
                                     .width = 2 * half_b,
                                     .height = h})});
  RevoluteJoint hinge;
  hinge.name = "hinge";
  hinge.body_a = "a";
  hinge.body_b = "b";
  hinge.anchor_a = {half_a, 0};
  hinge.anchor_b = {-half_b, 0};
  scene.joints.emplace_back(hinge);
  const Trace trace = lab.run(scene, 1);
  struct Sums {
    Vec2d momentum;
    double spin = 0, energy = 0;
  };
  const auto sums = [&](const std::vector<BodyState>& states) {
    Sums out;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const double m = scene.bodies[i].mass, l = i == 0 ? 2 * half_a : 2 * half_b;
      const double inertia = m * (l * l + h * h) / 12, spin = states[i].angular_velocity;
      out.momentum += m * states[i].velocity;
      out.spin += m * cross(states[i].position, states[i].velocity) + inertia * spin;
      out.energy += m * dot(states[i].velocity, states[i].velocity) / 2 + inertia * spin * spin / 2;
    }
    return out;
  };
  const auto [p0, l0, e0] = sums(trace.states.front());
  const auto [p, l, energy] = sums(trace.states.back());
  double gap = 0;
  for (const auto& states : trace.states) {
    const auto end = [&](std::size_t i, double at) {
      return states[i].position + at * Vec2d{std::cos(states[i].angle), std::sin(states[i].angle)};
    };
    gap = std::max(gap, length(end(1, -half_b) - end(0, half_a)));
  }
  const double moved = length(p - p0) / length(p0), kept = lab.spin_kept_by_positions(w, trace.duration());
  // Methods may lose some of both, but gain none.
  const auto tolerance = [](double ratio, double least) {
    return ratio > 1 ? 0.05 : std::max(0.05, 1 - least);
  };
  const double off_spin = tolerance(l / l0, kept);
  const double still = 1e-3, moves = three_rods_move(lab, 1);
  // The same rods at rest, with a gap at the hinge: closing it pushes them together along one line, so that
  // their common centre stays and their sum of m r x dr + I da is 0.
  const double parted = 0.02;
  const auto close = [&]() -> Closing {
    Scene open = scene;
    for (Body& body : open.bodies) body.velocity = {}, body.angular_velocity = 0;
    open.bodies[1].position += parted * Vec2d{0.8, -0.6};
    const Trace t = lab.run(open, 1);
    Closing out;
    double all = 0, mass = 0;
    for (const Body& body : open.bodies) mass += body.mass;
    for (std::size_t i = 0; i < open.bodies.size(); ++i) {
      const double m = open.bodies[i].mass, l_of = i == 0 ? 2 * half_a : 2 * half_b;
      out.shift += m / mass * (t.last(i).position - t.first(i).position);
      // The first step only: what an engine of positions keeps as velocities turns the rods on after it, and
      // its losses then add up.
      const BodyState &before = t.states[0][i], &after = t.states[1][i];
      const double turn = m * (l_of * l_of + h * h) / 12 * (after.angle - before.angle);
      out.turn +=
          turn + m * cross(0.5 * (before.position + after.position), after.position - before.position);
      all += std::abs(turn);
    }
    out.turn = all > 0 ? out.turn / all : 0;
    const auto end = [&](std::size_t i, double at) {
      const BodyState& s = t.last(i);
      return s.position + at * Vec2d{std::cos(s.angle), std::sin(s.angle)};
    };
    out.gap = length(end(1, -half_b) - end(0, half_a));
    return out;
  };
  const Closing closed = lab.corrects_positions() ? close() : Closing{};
  return Judgement()
      .read("momentum lost", "of all", moved, 0, 1e-6)
      .read("angular momentum kept", "of all", l / l0, 1, off_spin)
      .read("energy kept", "of all", energy / e0, 1, tolerance(energy / e0, kept * kept - 0.05))
      .read("widest gap at the hinge", "m", gap, 0, 0.02 * lab.coarseness())
      .read("motion of three rods at rest that overlap at their hinges", "m", moves, 0, still)
      .read("gap left of 2 cm at the hinge of two rods at rest", "m", closed.gap, 0, parted / 4)
      .read("shift of their common centre", "m", length(closed.shift), 0, 0.05 * parted)
      .read("turn that closing it gives to both together", "of each one's", closed.turn, 0, 0.1)
      .proven_if(
          moves > still && three_rods_move(lab, 0.8) <= still, "joined_bodies_collide",
          "Three rods at rest on two hinges drive each other away where they overlap, and do not where "
          "they do not: the two bodies of every joint do not collide, unless \"collide\" is true. Keep "
          "the pairs of all joints, in either order.")
      .mistake_if(gap > half_b, "joint_ignored",
                  "The rods leave each other: a hinge holds the two anchors together.")
      .symptom_if(moved > 1e-6 * std::max(1.0, std::sqrt(energy / e0)),
                  "The hinge changes the total momentum.")
      .mistake_if(
          trace.last(0).angular_velocity == 0, "one_body_never_spins",
          "The first rod never turns: the hinge's impulse changes the spin of both bodies by r x j/I, and a "
          "gets the opposite impulse.")
      .symptom_if(std::abs(l / l0 - 1) > off_spin, "The hinge changes the total angular momentum.")
      .finding();
}

}  // namespace plumb::course
