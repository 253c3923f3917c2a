#include "harness/course/stick_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/course/pendulum.h"
#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

constexpr double kGravity = 9.81;
constexpr double kPi = std::numbers::pi;

DistanceJoint stick(std::string name, std::string a, std::string b, double length, Vec2d anchor_a = {}) {
  DistanceJoint joint;
  joint.name = std::move(name);
  joint.body_a = std::move(a);
  joint.body_b = std::move(b);
  joint.anchor_a = anchor_a;
  joint.length = length;
  return joint;
}

struct Swing {
  double period;  // s
  double last;    // rad, largest angle in the last period
};

// Returns the swing of a pendulum of length `l`, m, released at `amplitude`, over `time` s, whose string is
// held by position corrections as in `Lab::spin_kept_by_positions`. Such a step also removes h^2 times the
// string's tension over m l from w. So dw/dt = -g/l sin(a) - h w (w^2 + g/l cos(a)), integrated here by the
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

// A stick of 1 m between two balls that move perpendicular to it at 1 m/s each: it turns at 2 rad/s.
Scene turning_stick() {
  Scene scene = scene_of("stick", {},
                         {make(Ball{.name = "a", .position = {-0.5, 0}, .velocity = {0, -1}, .radius = 0.1}),
                          make(Ball{.name = "b", .position = {0.5, 0}, .velocity = {0, 1}, .radius = 0.1})});
  scene.joints.emplace_back(stick("stick", "a", "b", 1));
  return scene;
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

// Returns the fraction of a ball's speed along its stick that remains after a step. It is 0 if the direction
// is normalised, for every length of the stick.
double speed_left(const Lab& lab, double length, double mass = 1) {
  Scene scene = scene_of(
      "one stick", {},
      {make(Ball{.name = "bob", .position = {length, 0}, .velocity = {1, 0}, .mass = mass, .radius = 0.04})});
  scene.joints.emplace_back(stick("stick", std::string(kWorld), "bob", length));
  return lab.run(scene, 1.5 * lab.dt()).last(0).velocity.x;
}

// Returns how much of an error a ball at rest keeps in 0.3 s, m, on a stick of the world that was 5 cm too
// short.
double error_left(const Lab& lab, double mass) {
  constexpr double kOff = 0.05;  // m
  Scene scene =
      scene_of("one short stick", {},
               {make(Ball{.name = "bob", .position = {1 + kOff, 0}, .mass = mass, .radius = 0.04})});
  scene.joints.emplace_back(stick("stick", std::string(kWorld), "bob", 1));
  return lab.run(scene, 0.3).last(0).position.x - 1;
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

}  // namespace

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
  double along = 0;
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    const auto& [a, b] = std::pair(trace.states[k][0], trace.states[k][1]);
    const Vec2d way = b.position - a.position;
    along = std::max(along, std::abs(dot(b.velocity - a.velocity, way)) / length(way));
  }
  // Each step leaves the circle by (w h)^2 d/2; ten times that may accumulate before it is corrected.
  const double tolerance = (5 * wh * wh + 0.005) * d;
  // Without correction, the tangent step lengthens d^2 by (v h)^2 while d v is constant: d^4 grows by 2 d0^2
  // v0^2 h^2.
  const double drifted = std::pow(std::pow(d, 4) + 8 * d * d * v * v * lab.dt() * t, 0.25);
  const double spin = cross(trace.last(1).position - trace.last(0).position,
                            trace.last(1).velocity - trace.last(0).velocity) /
                      (end * end);
  // Two balls at rest on a stick that is too long, or too short, at the start.
  constexpr double kOff = 0.1;  // m
  const auto settles_at = [&](double start) {
    Scene still = scene;
    for (Body& body : still.bodies) body.velocity = {};
    still.bodies[1].position = still.bodies[0].position + Vec2d{start, 0};
    const Trace rest = lab.run(still, 1);
    return length(rest.last(1).position - rest.last(0).position);
  };
  const bool corrects = lab.corrects_positions();
  const double from_long = corrects ? settles_at(d + kOff) : d,
               from_short = corrects ? settles_at(d - kOff) : d;
  const bool keeps_start =
      std::abs(from_long - d - kOff) < 1e-6 && std::abs(from_short - d + kOff) < 1e-6 && worst <= tolerance;
  // An engine that corrects positions may lose as much as that method loses, to second order.
  const double slowed = w * lab.spin_kept_by_positions(w, t);
  const bool by_positions = lab.first_order() && std::abs(spin - slowed) <= wh * wh * slowed;
  const double due = by_positions ? slowed : w,
               within = by_positions ? wh * wh * slowed : w - 0.95 * w * lab.turn_kept(w, t),
               slowest = due - within, fastest = due + within;
  return Judgement()
      .read("largest change of length", "m", worst, 0, tolerance)
      .read("spin after 5 s", "rad/s", spin, due, within)
      .read("fastest that the ends part or close, by their velocities", "m/s", along, 0, 6 * v * wh + 0.01)
      .read("distance of two at rest whose stick was 0.1 m too long at the start", "m", from_long, d,
            kOff / 4)
      .read("distance of two whose stick was 0.1 m too short", "m", from_short, d, kOff / 4)
      .proven_if(
          keeps_start, "length_of_start",
          "A stick that is too long or too short at the start stays so: it keeps the distance that its ends "
          "have at the start. Take \"length\" from the scene.")
      .mistake("joint_ignored", {std::hypot(d, 2 * v * t) - d, kAny},
               "The stick does nothing: the balls fly apart.")
      .mistake("no_position_correction", {drifted - d, kAny},
               "The stick gets longer: its velocities are corrected and its positions are not. Correct them "
               "by a share "
               "of the error each step.")
      .mistake_if(trace.still(0), "starts_at_rest",
                  "The balls never move: add v dt to the position; v begins with the scene's \"velocity\".")
      .symptom_if(worst <= tolerance && spin < slowest, "The stick loses its spin.")
      .symptom_if(worst <= tolerance && spin > fastest, "The stick gains spin.")
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
  // Ends before a stick that stretches would be pulled through to the other side, after 0.43 s.
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
                  "The total momentum is not that of the push.")
      .finding();
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
  // The world does not give way, so the mass of what hangs on it makes no difference.
  constexpr double kHeavy = 100;  // kg
  const double keeps_speed = speed_left(lab, 1, kHeavy) - speed_left(lab, 1);
  const double keeps_error = lab.corrects_positions() ? error_left(lab, kHeavy) - error_left(lab, 1) : 0;
  const auto free_stick_holds = [&] {
    const Trace t = lab.run(turning_stick(), 1);
    return std::abs(length(t.last(1).position - t.last(0).position) - 1) < 0.05;
  };
  // An engine that corrects positions may lose as much as that method loses, to second order.
  const Swing slowed = swing_by_positions(amplitude, l, lab.substep(), trace.duration(), due);
  const double share = std::pow(peak * lab.dt(), 2);
  const bool by_positions = lab.first_order() &&
                            std::abs(period.value_or(0) - slowed.period) <= share * slowed.period &&
                            std::abs(high - slowed.last) <= share * slowed.last;
  const bool holds = stretched <= 0.02 * l * lab.coarseness();
  const std::optional<double> stiffness = holds ? std::nullopt : stiffness_of_joints(lab, false);
  return Judgement()
      .read("period", "s", period.value_or(0), by_positions ? slowed.period : due,
            by_positions ? share * slowed.period : due * lab.method_error(2 * kPi / due, 0.005))
      .read("last swing", "rad", high, by_positions ? slowed.last : amplitude,
            by_positions ? share * slowed.last : amplitude - lowest)
      .read("largest change of length", "m", stretched, 0, 0.02 * l * lab.coarseness())
      .read("speed along a stick of the world that 100 kg keep longer than 1 kg", "m/s", keeps_speed, 0, 0.01)
      .read("error of a stick of the world that 100 kg keep longer than 1 kg", "m", keeps_error, 0, 1e-3)
      .mistake_if(trace.still(0), "no_gravity",
                  "The bob hangs still, at 60 degrees: gravity pulls at it as well.")
      .proven_if(stiffness.has_value(), "joint_as_spring", spring_text(stiffness.value_or(0)))
      .proven_if(!period && stretched > 0.2 * l && free_stick_holds(), "joint_ignored",
                 "A stick between two balls holds, and one to \"world\" does not: the end named \"world\" is "
                 "a fixed "
                 "point, at anchor_a.")
      .symptom_if(high > 1.1 * amplitude, "It swings higher each time: energy grows.")
      .symptom_if(high < lowest, "It swings lower each time.")
      .mistake("weight_not_divided", {due / std::sqrt(3.0), kAny, kAny},
               "It swings as under three times the gravity, with 3 kg: divide the weight by the mass.")
      .mistake("gravity_divided_by_mass", {due * std::sqrt(3.0), kAny, kAny},
               "It swings as under a third of the gravity, with 3 kg: the weight is m g.")
      .mistake("gravity_twice", {due / std::sqrt(2.0), kAny, kAny}, "It swings as under twice the gravity.")
      .mistake_if(stretched > 0.02 * l * lab.coarseness(), "no_position_correction",
                  "The string stretches: correct the positions as well.")
      .finding();
}

Finding chain_swings(const Lab& lab) {
  const int links = 10;
  const double l = kLink;
  const Trace trace = lab.run(chain(links), 3);
  const auto [worst, where] = worst_stretch(trace);
  const double most = 0.25 * lab.coarseness();
  const bool short_one_holds = worst > most && worst_stretch(lab.run(chain(2), 3)).first <= most;
  // A single link needs no repetition: its impulse takes all of the speed along it at once.
  const auto one_is_held = [&] {
    const Scene one = chain(1);
    const Trace t = lab.run(one, 1.5 * lab.dt());
    const Vec2d along = 1 / kLink * one.bodies.front().position;
    return std::abs(dot(t.last(0).velocity, along)) < 0.05 * kGravity * lab.dt();
  };
  const auto depends_on_length = [&] {
    const double exact = speed_left(lab, 1);
    const double half = speed_left(lab, 0.5), fifth = speed_left(lab, 0.2);
    return std::abs(exact) < 1e-6 && half > 1e-6 && fifth > 1.1 * half;
  };
  double left = 0;
  for (const auto& states : trace.states) left = std::min(left, states.back().position.x);
  const double fallen = trace.last(links - 1).position.y - trace.first(links - 1).position.y;
  const bool falls = fallen < 0.9 * lab.way(0, -kGravity, trace.duration());
  return Judgement()
      .read("largest stretch of a link", "of its length", worst, 0, most)
      .read("farthest that the end swings to the other side", "m", left, -links * l / 2, 0.45 * links * l)
      .mistake_if(trace.still(0), "no_gravity", "It hangs in the air: gravity pulls at it.")
      .mistake_if(falls, "joint_ignored", "The chain falls freely: its links do nothing.")
      .proven_if(short_one_holds && one_is_held(), "too_few_iterations",
                 fmt::format(
                     "A chain of 2 links holds, and of 10 links number {} stretches by {:.0f} %: go over all "
                     "joints more often in a step, 20 times or more.",
                     where + 1, 100 * worst))
      .proven_if(worst > most && depends_on_length(), "normal_not_unit",
                 "A stick of 1 m holds its ball at once, and shorter ones do not: the stick's impulse "
                 "depends on its "
                 "length. Divide the way from end to end by its length to get the direction.")
      .mistake_if(left > -1e-9, "joint_ignored", "The chain does not swing through.")
      .finding();
}

}  // namespace plumb::course
