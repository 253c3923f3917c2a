// Chapter 5: sticks, hinges, chains and a ragdoll.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "harness/course/course.h"
#include "harness/course/ragdoll_checks.h"
#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

constexpr double kGravity = 9.81;
constexpr double kPi = std::numbers::pi;
constexpr const char* kSticks = "\"joints\":[\"distance\"]";
constexpr const char* kHinges = "\"shapes\":[\"circle\",\"box\"] and \"joints\":[\"revolute\"]";
constexpr const char* kChain = "\"joints\":[\"distance\"] and \"features\":[\"contacts\"]";
constexpr const char* kRagdoll =
    "\"shapes\":[\"circle\",\"box\"], \"joints\":[\"revolute\"] and \"features\":[\"contacts\"]";

DistanceJoint stick(std::string name, std::string a, std::string b, double length, Vec2d anchor_a = {}) {
  DistanceJoint joint;
  joint.name = std::move(name);
  joint.body_a = std::move(a);
  joint.body_b = std::move(b);
  joint.anchor_a = anchor_a;
  joint.length = length;
  return joint;
}

// Returns the mean period between zero crossings, s; none if there are fewer than three.
std::optional<double> period_of(const std::vector<double>& zeros) {
  if (zeros.size() < 3) return std::nullopt;
  const std::size_t last = zeros.size() - 1 - (zeros.size() - 1) % 2;
  return 2 * (zeros[last] - zeros[0]) / static_cast<double>(last);
}

struct Swing {
  double period;  // s
  double last;    // rad, largest angle in the last period
};

// Returns the swing of a pendulum of length `l`, m, released at `amplitude`, over `time` s, whose string is
// held by position corrections as in `Lab::spin_kept_by_positions`. Such a step also removes h^2 times the
// string's tension over m l from w: dw/dt = -g/l sin(a) - h w (w^2 + g/l cos(a)), integrated here by the
// fourth-order Runge-Kutta method.
Swing swing_by_positions(double amplitude, double l, double h, double time, double due) {
  constexpr int kSteps = 4000;
  const double dt = time / kSteps, stiffness = kGravity / l;
  const auto rate = [&](Vec2d s) {  // of (angle, w)
    return Vec2d{s.y, -stiffness * std::sin(s.x) - h * s.y * (s.y * s.y + stiffness * std::cos(s.x))};
  };
  Vec2d state{amplitude, 0};
  std::vector<double> zeros;
  double last = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Vec2d k1 = rate(state), k2 = rate(state + 0.5 * dt * k1), k3 = rate(state + 0.5 * dt * k2),
                k4 = rate(state + dt * k3);
    const Vec2d next = state + (dt / 6) * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    if ((state.x > 0) != (next.x > 0)) zeros.push_back(dt * (i + state.x / (state.x - next.x)));
    if ((i + 1) * dt > time - due) last = std::max(last, std::abs(next.x));
    state = next;
  }
  return {period_of(zeros).value_or(0), last};
}

// Returns true if a ball reaches three times its initial speed.
bool faster(const Trace& trace) {
  for (const auto& states : trace.states)
    if (length(states[0].velocity) > 3 * length(trace.first(0).velocity)) return true;
  return false;
}

// Returns true if two bodies of equal mass that had opposite velocities still have opposite velocities.
bool opposite(const Trace& trace) {
  return length(trace.last(0).velocity + trace.last(1).velocity) < 1e-6 * length(trace.last(0).velocity);
}

// A stick of 1 m between two balls that move across it at 1 m/s each: it turns at 2 rad/s.
Scene turning_stick() {
  Scene scene = scene_of("stick", {},
                         {make(Ball{.name = "a", .position = {-0.5, 0}, .velocity = {0, -1}, .radius = 0.1}),
                          make(Ball{.name = "b", .position = {0.5, 0}, .velocity = {0, 1}, .radius = 0.1})});
  scene.joints.emplace_back(stick("stick", "a", "b", 1));
  return scene;
}

Finding stick_keeps_its_length(const Lab& lab) {
  const double d = 1, v = 1;
  const Scene scene = turning_stick();
  if (const Trace start = lab.run(scene, 3.5 * lab.dt()); faster(start) && opposite(start)) {
    Finding out;
    out.verdict = Verdict::Fail;
    out.mistake = "impulse_backwards";
    out.observed = out.proven = true;
    out.says =
        "The balls speed up within three steps: the stick's impulse has the wrong sign. It is -speed/(1/ma + "
        "1/mb) "
        "along the stick; b gets it, and a the opposite one.";
    return out;
  }
  const Trace trace = lab.run(scene, 5);
  double worst = 0;
  for (const auto& states : trace.states)
    worst = std::max(worst, std::abs(length(states[1].position - states[0].position) - d));
  const double t = trace.duration(), w = 2 * v / d, wh = w * lab.dt();
  const double end = length(trace.last(1).position - trace.last(0).position);
  // Each step leaves the circle by (w h)^2 d/2; ten times that may accumulate before it is corrected.
  const double tolerance = (5 * wh * wh + 0.005) * d;
  // Without correction, the tangent step lengthens d^2 by (v h)^2 while d v is constant: d^4 grows by 2 d0^2
  // v0^2 h^2.
  const double drifted = std::pow(std::pow(d, 4) + 8 * d * d * v * v * lab.dt() * t, 0.25);
  const double spin = cross(trace.last(1).position - trace.last(0).position,
                            trace.last(1).velocity - trace.last(0).velocity) /
                      (end * end);
  // With position corrections it may lose exactly as much as that method loses, to second order.
  const double slowed = w * lab.spin_kept_by_positions(w, t);
  const bool by_positions = lab.first_order() && std::abs(spin - slowed) <= wh * wh * slowed;
  return Judgement()
      .read("largest change of length", "m", worst, 0, tolerance)
      .read("spin after 5 s", "rad/s", spin, by_positions ? slowed : w,
            by_positions ? wh * wh * slowed : w - 0.95 * w * lab.turn_kept(w, t))
      .mistake("joint_ignored", {std::hypot(d, 2 * v * t) - d, kAny},
               "The stick does nothing: the balls fly apart.")
      .mistake("no_position_correction", {drifted - d, kAny},
               "The stick gets longer: its velocities are corrected and its positions are not. Correct them "
               "by a share "
               "of the error each step.")
      .mistake_if(trace.still(0), "starts_at_rest",
                  "The balls never move: add v dt to the position; v begins with the scene's \"velocity\".")
      .symptom_if(
          worst <= tolerance && spin < 0.95 * w,
          "The stick loses its spin: correcting positions or velocities must act along the stick only.")
      .symptom_if(worst <= tolerance && spin > 1.05 * w,
                  "The stick gains spin: is a correction of positions counted as velocity twice?")
      .finding();
}

// Pulls the light ball of a stick with a heavy and a light ball along the stick.
Finding stick_weighs_masses(const Lab& lab) {
  const double heavy = 10, light = 1, force = 11;
  Scene scene = scene_of("pull", {},
                         {make(Ball{.name = "heavy", .mass = heavy, .radius = 0.1}),
                          make(Ball{.name = "light", .position = {1, 0}, .mass = light, .radius = 0.1})});
  scene.joints.emplace_back(stick("stick", "heavy", "light", 1));
  // The stick begins 5 cm too long: its ends are moved by inverse mass, which leaves their centre in place.
  const double stretch = 0.05;
  Scene stretched = scene;
  stretched.bodies[1].position.x += stretch;
  const auto centre_shift = [&] {
    const Trace corrected = lab.run(stretched, 1);
    const auto shift = [&](std::size_t b) {
      return corrected.last(b).position.x - corrected.first(b).position.x;
    };
    return (heavy * shift(0) + light * shift(1)) / (heavy + light);
  };
  const double centre = lab.corrects_positions() ? centre_shift() : 0;
  scene.forces.emplace_back(push("light", {force, 0}));
  const Trace trace = lab.run(scene, 1);
  const double t = trace.duration(), both = force * t / (heavy + light);
  const double momentum = heavy * trace.last(0).velocity.x + light * trace.last(1).velocity.x;
  scene.forces = {push("light", {-force, 0})};
  // Ends before a stick that stretches would be drawn out to the other side, after 0.43 s.
  const Trace pushed = lab.run(scene, 0.4);
  const double when_pushed = -force * pushed.duration() / (heavy + light);
  // Two balls of 1 kg, for which ma + mb equals 1/ma + 1/mb, move together, first pulled, then pushed.
  const auto alike_hold = [&] {
    Scene alike = scene;
    alike.bodies[0].mass = 1;
    for (const double f : {force, -force}) {
      alike.forces = {push("light", {f, 0})};
      const Trace moved = lab.run(alike, 0.4);
      for (const std::size_t body : {0U, 1U}) {
        const double due_alike = f * moved.duration() / 2;
        if (std::abs(moved.last(body).velocity.x - due_alike) > 0.005 * std::abs(due_alike)) return false;
      }
    }
    return true;
  };
  const auto weak = [&](const Trace& run, double f) {
    const double a = run.last(0).velocity.x / f, b = run.last(1).velocity.x / f;
    const bool right_momentum = std::abs(heavy * a + light * b - run.duration()) < 0.001 * run.duration();
    return right_momentum && a >= 0 && a < b && (b - a) > 0.005 * run.duration() / (heavy + light);
  };
  const bool masses_weaken = weak(trace, force) && weak(pushed, -force) && alike_hold();
  return Judgement()
      .read("vx of 10 kg", "m/s", trace.last(0).velocity.x, both, 0.005 * both)
      .read("vx of 1 kg", "m/s", trace.last(1).velocity.x, both, 0.005 * both)
      .read("vx of 10 kg, pushed by 1 kg", "m/s", pushed.last(0).velocity.x, when_pushed, 0.005 * both)
      .read("shift of the centre of mass of a stick too long", "m", centre, 0, 0.05 * stretch)
      .mistake(
          "masses_ignored", {force * t / light / 2, force * t / light / 2},
          "Both ends are moved alike: share the correction by inverse mass; the light end takes ten parts in "
          "eleven.")
      .mistake("one_body_only", {0, 0},
               "Only the light end is held: the stick pulls on both, the heavy one must come along.")
      .mistake("one_body_only", {force * t / light, force * t / light},
               "Only the heavy end is dragged along: the light one must feel it as well.")
      .mistake("joint_ignored", {0, force * t / light}, "The stick does nothing.")
      .mistake("shares_swapped",
               {force * t / light * heavy / (heavy + light), force * t / light * heavy / (heavy + light)},
               "The shares are swapped: the light end moves more, by inverse mass.")
      .otherwise_if(
          masses_weaken, "joint_impulse_weak",
          "Two balls of 1 kg move together, and 10 kg and 1 kg do not: the stick's impulse is too weak. "
          "It is -dC/dt/(1/ma + 1/mb), not divided by ma + mb, and each end changes by it times its "
          "own inverse mass.")
      .symptom_if(std::abs(momentum - force * t) > 0.05 * force * t,
                  "The stick changes the total momentum: its two ends must get opposite impulses.")
      .finding();
}

// Returns the period from the times at which `angle_of` crosses zero, interpolated linearly between samples.
template <class AngleOf>
std::optional<double> period_of(const Trace& trace, const AngleOf& angle_of) {
  std::vector<double> zeros;
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    const double a = angle_of(trace.states[k - 1]), b = angle_of(trace.states[k]);
    if ((a > 0) != (b > 0))
      zeros.push_back(trace.times[k - 1] + (trace.times[k] - trace.times[k - 1]) * a / (a - b));
  }
  return period_of(zeros);
}

// Returns the ratio of the period of a pendulum of `amplitude` to that of a small swing: 1/agm(1,
// cos(amplitude/2)) (Gauss).
double period_ratio(double amplitude) {
  double a = 1, g = std::cos(amplitude / 2);
  for (int i = 0; i < 6; ++i) {
    const double mean = (a + g) / 2;
    g = std::sqrt(a * g);
    a = mean;
  }
  return 1 / a;
}

Finding pendulum(const Lab& lab) {
  const double l = 1, amplitude = kPi / 3;
  const Vec2d start{l * std::sin(amplitude), -l * std::cos(amplitude)};
  Scene scene = scene_of("pendulum", {0, -kGravity},
                         {make(Ball{.name = "bob", .position = start, .mass = 3, .radius = 0.1})});
  scene.joints.emplace_back(stick("string", std::string(kWorld), "bob", l));
  const Trace trace = lab.run(scene, 10);
  const auto angle = [](const std::vector<BodyState>& s) {
    return std::atan2(s[0].position.x, -s[0].position.y);
  };
  const double small = 2 * kPi * std::sqrt(l / kGravity), due = small * period_ratio(amplitude);
  const std::optional<double> period = period_of(trace, angle);
  // The mean of w^4 over a swing is 3/8 of its peak.
  const double peak = 2 * std::sin(amplitude / 2) * std::sqrt(kGravity / l);
  const double kept = lab.turn_kept(peak, trace.duration() * 3 / 8);
  const double lowest = 0.9 * 2 * std::asin(std::sin(amplitude / 2) * kept);
  double high = 0, stretched = 0;
  for (std::size_t k = 0; k < trace.states.size(); ++k) {
    stretched = std::max(stretched, std::abs(length(trace.states[k][0].position) - l));
    if (trace.times[k] > 10 - due) high = std::max(high, std::abs(angle(trace.states[k])));
  }
  const auto free_stick_holds = [&] {
    const Trace t = lab.run(turning_stick(), 1);
    return std::abs(length(t.last(1).position - t.last(0).position) - 1) < 0.05;
  };
  // With position corrections it may lose exactly as much as that method loses, to second order.
  const Swing slowed = swing_by_positions(amplitude, l, lab.substep(), trace.duration(), due);
  const double share = std::pow(peak * lab.dt(), 2);
  const bool by_positions = lab.first_order() &&
                            std::abs(period.value_or(0) - slowed.period) <= share * slowed.period &&
                            std::abs(high - slowed.last) <= share * slowed.last;
  return Judgement()
      .read("period", "s", period.value_or(0), by_positions ? slowed.period : due,
            by_positions ? share * slowed.period : due * lab.method_error(2 * kPi / due, 0.005))
      .read("last swing", "rad", high, by_positions ? slowed.last : amplitude,
            by_positions ? share * slowed.last : amplitude - lowest)
      .read("largest change of length", "m", stretched, 0, 0.02 * l * lab.coarseness())
      .mistake_if(trace.still(0), "no_gravity",
                  "The bob hangs still, at 60 degrees: gravity pulls at it as well.")
      .proven_if(!period && stretched > 0.2 * l && free_stick_holds(), "joint_ignored",
                 "A stick between two balls holds, and one to \"world\" does not: the end named \"world\" is "
                 "a fixed "
                 "point, at anchor_a.")
      .symptom_if(
          high > 1.1 * amplitude,
          "It swings higher each time: something adds energy. A joint's impulse only stops the change of "
          "length, and a correction of positions leaves velocities as they are.")
      .symptom_if(high < lowest,
                  "It swings lower each time: correct along the string only, and by a share of the error.")
      .mistake("weight_not_divided", {due / std::sqrt(3.0), kAny, kAny},
               "It swings as under three times the gravity, with 3 kg: divide the weight by the mass.")
      .mistake("gravity_divided_by_mass", {due * std::sqrt(3.0), kAny, kAny},
               "It swings as under a third of the gravity, with 3 kg: the weight is m g.")
      .mistake("gravity_twice", {due / std::sqrt(2.0), kAny, kAny}, "It swings as under twice the gravity.")
      .mistake_if(stretched > 0.02 * l * lab.coarseness(), "no_position_correction",
                  "The string stretches: correct the positions as well.")
      .finding();
}

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
  const double less = std::min(slides_x, slides_y), more = std::max(slides_x, slides_y);
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
  // A rod at rest along x, its anchor 2 cm off the hinge, without gravity: what is left of the gap.
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
  const double due = period_with(about_end);
  const std::optional<double> period = period_of(trace, swing);
  const bool still = length(trace.last(0).position - trace.first(0).position) < 0.01 * l;
  return Judgement()
      .read("period", "s", period.value_or(0), due, due * lab.method_error(2 * kPi / due, 0.005))
      .read("largest gap at the hinge", "m", gap, 0, 0.01 * l * lab.coarseness())
      .read("gap on a post that the rod overlaps", "m", at_post, 0, 0.01 * l * lab.coarseness())
      .proven_if(held && at_post > 0.01 * l * lab.coarseness(), "joined_bodies_collide",
                 "The rod is pushed out of the post that it hangs on: bodies that a joint connects do not "
                 "collide, unless \"collide\" is true.")
      .proven_if(more > 0.2 && less < 0.1 * more, "hinge_one_axis",
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

// Two rods on a hinge, without gravity: one rests, the other turns about the hinge at 3 rad/s. The hinge then
// turns the first as well; momentum and angular momentum are conserved.
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
  const auto sums = [&](const std::vector<BodyState>& states) {
    std::pair<Vec2d, double> out{{}, 0};
    for (std::size_t i = 0; i < states.size(); ++i) {
      const double m = scene.bodies[i].mass, l = i == 0 ? 2 * half_a : 2 * half_b;
      out.first += m * states[i].velocity;
      out.second += m * cross(states[i].position, states[i].velocity) +
                    m * (l * l + h * h) / 12 * states[i].angular_velocity;
    }
    return out;
  };
  const auto [p0, l0] = sums(trace.states.front());
  const auto [p, l] = sums(trace.states.back());
  double gap = 0;
  for (const auto& states : trace.states) {
    const auto end = [&](std::size_t i, double at) {
      return states[i].position + at * Vec2d{std::cos(states[i].angle), std::sin(states[i].angle)};
    };
    gap = std::max(gap, length(end(1, -half_b) - end(0, half_a)));
  }
  const double moved = length(p - p0) / length(p0), kept = lab.spin_kept_by_positions(w, trace.duration());
  return Judgement()
      .read("momentum lost", "of all", moved, 0, 1e-6)
      .read("angular momentum kept", "of all", l / l0, 1, std::max(0.05, 1 - kept))
      .read("widest gap at the hinge", "m", gap, 0, 0.02 * lab.coarseness())
      .mistake_if(gap > half_b, "joint_ignored",
                  "The rods leave each other: a hinge holds the two anchors together.")
      .symptom_if(moved > 1e-6,
                  "The hinge changes the total momentum: its two ends must get opposite impulses.")
      .mistake_if(
          trace.last(0).angular_velocity == 0, "one_body_never_spins",
          "The first rod never turns: the hinge's impulse changes the spin of both bodies by r x j/I, and a "
          "gets the opposite impulse.")
      .symptom_if(
          std::abs(l / l0 - 1) > std::max(0.05, 1 - kept),
          "The hinge changes the total angular momentum: an impulse at an anchor changes each body's spin "
          "by r x j/I, with its own r, turned by the body's angle.")
      .finding();
}

constexpr double kLink = 0.2;  // m

Scene chain(int links) {
  const double l = kLink;
  const Vec2d down{std::sqrt(0.5), -std::sqrt(0.5)};
  Scene scene = scene_of("chain", {0, -kGravity}, {});
  for (int i = 0; i < links; ++i) {
    const std::string name = fmt::format("bead{}", i), before = fmt::format("bead{}", i - 1);
    scene.bodies.push_back(
        make(Ball{.name = name, .position = (i + 1) * l * down, .radius = 0.04, .restitution = 0}));
    scene.joints.emplace_back(
        stick(fmt::format("link{}", i), i == 0 ? std::string(kWorld) : before, name, l));
  }
  return scene;
}

// Returns the largest stretch of any link, of its length, and which link it is.
std::pair<double, std::size_t> worst_stretch(const Trace& trace) {
  std::pair<double, std::size_t> worst{0, 0};
  for (const auto& states : trace.states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Vec2d from = i == 0 ? Vec2d{} : states[i - 1].position;
      worst = std::max(worst, {std::abs(length(states[i].position - from) - kLink) / kLink, i});
    }
  }
  return worst;
}

Finding chain_swings(const Lab& lab) {
  const int links = 10;
  const double l = kLink;
  const Trace trace = lab.run(chain(links), 3);
  const auto [worst, where] = worst_stretch(trace);
  const double most = 0.25 * lab.coarseness();
  const bool short_one_holds = worst > most && worst_stretch(lab.run(chain(2), 3)).first <= most;
  double left = 0;
  for (const auto& states : trace.states) left = std::min(left, states.back().position.x);
  const double fallen = trace.last(links - 1).position.y - trace.first(links - 1).position.y;
  const bool falls = fallen < 0.9 * lab.way(0, -kGravity, trace.duration());
  return Judgement()
      .read("largest stretch of a link", "of its length", worst, 0, most)
      .read("farthest that the end swings to the other side", "m", left, -links * l / 2, 0.45 * links * l)
      .mistake_if(trace.still(0), "no_gravity", "It hangs in the air: gravity pulls at it.")
      .mistake_if(falls, "joint_ignored", "The chain falls freely: its links do nothing.")
      .proven_if(short_one_holds, "too_few_iterations",
                 fmt::format(
                     "A chain of 2 links holds, and of 10 links number {} stretches by {:.0f} %: go over all "
                     "joints more often in a step, 20 times or more.",
                     where + 1, 100 * worst))
      .mistake_if(left > -1e-9, "joint_ignored", "The chain does not swing through.")
      .finding();
}

}  // namespace

Chapter constraints_and_ragdoll() {
  return {
      .number = 5,
      .title = "Constraints and a ragdoll",
      .page = "5-constraints-and-ragdoll.md",
      .checks = {{"stick_keeps_its_length", "two circles on a stick keep their distance", kSticks,
                  stick_keeps_its_length},
                 {"stick_weighs_masses", "a stick moves the light end more", kSticks, stick_weighs_masses},
                 {"pendulum", "a pendulum keeps its period and its swing", kSticks, pendulum},
                 {"hinged_rod", "a rod on a hinge swings as a rod", kHinges, hinged_rod},
                 {"hinge_turns_both", "a hinge turns both of its rods", kHinges, hinge_turns_both},
                 {"chain_swings", "a chain swings like a rope", kChain, chain_swings, false},
                 {"ragdoll_flies", "a ragdoll in the air falls as one", kRagdoll, ragdoll_flies, false},
                 {"ragdoll_drops", "it lands, holds together and settles", kRagdoll, ragdoll_drops, false}}};
}

}  // namespace plumb::course
