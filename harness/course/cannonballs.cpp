// Chapter 2: forces, mass, wind, drag, springs.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "harness/course/course.h"
#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;

// Solves three linear equations by Cramer's rule; nullopt if they have no single solution.
std::optional<std::array<double, 3>> solve(const Matrix3& a, const std::array<double, 3>& b) {
  const auto determinant = [](const Matrix3& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  const double all = determinant(a);
  if (!(std::abs(all) > 1e-12 * std::abs(a[0][0] * a[1][1] * a[2][2]))) return std::nullopt;
  std::array<double, 3> out{};
  for (int column = 0; column < 3; ++column) {
    Matrix3 replaced = a;
    for (int row = 0; row < 3; ++row) replaced[row][column] = b[row];
    out[column] = determinant(replaced) / all;
  }
  return out;
}

constexpr double kGravity = 9.81;
constexpr const char* kBall = "\"shapes\":[\"circle\"], several bodies apart from each other";
constexpr const char* kPush = "\"forces\":[\"point_force\"]";

Finding force_accelerates(const Lab& lab) {
  Scene scene = scene_of("force", {}, {make(Ball{})});
  scene.forces.emplace_back(push("ball", {6, 0}));
  const Trace trace = lab.run(scene, 1);
  const double t = trace.duration(), v = 6 * t, h = lab.dt();
  const Trace finer = lab.run(scene, 1, 2);
  return Judgement()
      .read("vx after 1 s", "m/s", trace.last(0).velocity.x, v, lab.rounding(v, t))
      .read("vx/t with half of dt", "m/s^2", finer.last(0).velocity.x / finer.duration(), 6,
            lab.rounding(6, 2))
      .mistake("force_ignored", {0}, "The force does nothing: add F dt/m to the velocity each step.")
      .mistake("force_once", {6 * h},
               "The force acts for one step only: it lasts until its duration is over.")
      .mistake("force_backwards", {-v}, "The force pushes backwards: add it, do not subtract it.")
      .mistake("force_dt_twice", {v * h}, "dt enters twice: a step adds F dt/m to the velocity, once.")
      .mistake("force_twice", {2 * v},
               "The force acts twice a step: add it once, and go through forces once.")
      .mistake("force_halved", {v / 2}, "Half of the force acts: a step adds F dt/m to the velocity.")
      .mistake("force_in_kilograms", {kGravity * v},
               "9.81 times too fast: the force is in newtons already, F/m is the acceleration.")
      .mistake("force_in_kilograms", {v / kGravity},
               "9.81 times too slow: the force is in newtons already, F/m is the acceleration.")
      .mistake("force_without_dt", {v / h}, "dt is missing: a step adds F dt/m to the velocity, not F/m.")
      .mistake(
          "force_not_cleared", {6 * t * (t + h) / (2 * h)},
          "The force piles up from step to step: set the sum of forces to zero at the start of each step.")
      .finding();
}

Finding ten_times_the_mass(const Lab& lab) {
  const double mass = 10, force = 6;
  // Adds two balls, above and below, on which the force does not act.
  Scene scene =
      scene_of("mass", {},
               {make(Ball{.name = "above", .position = {0, 3}, .mass = mass}), make(Ball{.mass = mass}),
                make(Ball{.name = "below", .position = {0, -3}, .mass = mass})});
  scene.forces.emplace_back(push("ball", {force, 0}));
  const Trace trace = lab.run(scene, 1);
  const double t = trace.duration(), v = force / mass * t;
  const double other = std::max(std::abs(trace.last(0).velocity.x), std::abs(trace.last(2).velocity.x));
  return Judgement()
      .read("vx after 1 s of a ball of 10 kg", "m/s", trace.last(1).velocity.x, v, lab.rounding(v, t))
      .read("vx of a ball that nothing pushes", "m/s", other, 0, 1e-9)
      .proven_if(other > 1e-9, "force_on_wrong_body",
                 "The force moves a ball that it does not name: it acts on the body called \"body\", and on "
                 "no other.")
      .mistake("mass_not_divided", {force * t},
               "Ten times too fast: the force is not divided by the mass. a = F/m; a ball of 1 kg hides it.")
      .mistake("mass_multiplied", {force * mass * t}, "The force is multiplied by the mass: a = F/m.")
      .mistake("mass_divided_twice", {v / mass}, "The force is divided by the mass twice.")
      .mistake("force_ignored", {0}, "The force does nothing.")
      .finding();
}

Finding all_fall_alike(const Lab& lab) {
  const Body light = make(Ball{.name = "light", .position = {-3, 0}, .mass = 0.5});
  const Body heavy = make(Ball{.name = "heavy", .position = {3, 0}, .mass = 10});
  const Trace trace = lab.run(scene_of("fall", {0, -kGravity}, {light, heavy}), 1);
  const double t = trace.duration(), v = -kGravity * t, tolerance = lab.rounding(v, t);
  return Judgement()
      .read("vy of 0.5 kg after 1 s", "m/s", trace.last(0).velocity.y, v, tolerance)
      .read("vy of 10 kg after 1 s", "m/s", trace.last(1).velocity.y, v, tolerance)
      .mistake("gravity_divided_by_mass", {v / 0.5, v / 10},
               "The heavy ball falls slowly: gravity is an acceleration; if it is treated as a force it must "
               "be m g.")
      .mistake("weight_not_divided", {v * 0.5, v * 10},
               "The heavy ball falls fast: m g is a force, divide it by the mass like any other.")
      .mistake("only_the_first", {v, 0}, "Only the first body falls: loop over all of them.")
      .mistake("gravity_twice", {2 * v, 2 * v},
               "Both fall at twice g: gravity acts twice a step, or the two share one velocity.")
      .finding();
}

Finding forces_add(const Lab& lab) {
  const double mass = 2;
  const Vec2d wind{-3, 0}, thrust{8, 4}, lift{1, 2}, gravity{0, -kGravity};
  Scene scene = scene_of("forces", gravity, {make(Ball{.mass = mass})});
  for (const Vec2d force : {wind, thrust, lift}) scene.forces.emplace_back(push("ball", force));
  const Trace trace = lab.run(scene, 1);
  const double t = trace.duration(), tolerance = lab.rounding(10, t);
  const auto with = [&](Vec2d force) { return t * (1 / mass * force + gravity); };
  const auto gives = [](Vec2d v) { return std::vector<double>{v.x, v.y}; };
  const Vec2d right = with(wind + thrust + lift), v = trace.last(0).velocity;
  return Judgement()
      .read("vx after 1 s", "m/s", v.x, right.x, tolerance)
      .read("vy after 1 s", "m/s", v.y, right.y, tolerance)
      .mistake("last_force_only", gives(with(lift)),
               "Only the last force counts: add forces up (+=), do not set (=).")
      .mistake("first_force_only", gives(with(wind)), "Only the first force counts: go through all of them.")
      .mistake("first_force_lost", gives(with(thrust + lift)), "The first force, the wind, is not added.")
      .mistake("last_force_lost", gives(with(wind + thrust)), "The last force is not added.")
      .mistake("gravity_lost", gives(with(wind + thrust + lift) - t * gravity),
               "Forces replace gravity: they act beside it.")
      .mistake("forces_ignored", gives(t * gravity), "Only gravity acts: the scene's forces are not used.")
      .mistake("forces_replace_weight", gives(t / mass * lift),
               "Only the last force counts, and gravity is lost: add all of them up.")
      .finding();
}

Finding push_ends(const Lab& lab) {
  const double force = 40, mass = 4, start = 0.2, duration = 0.1;
  Scene scene = scene_of("push", {}, {make(Ball{.mass = mass})});
  PointForce law = push("ball", {force, 0});
  law.start = start;
  law.duration = duration;
  scene.forces.emplace_back(law);
  const Trace trace = lab.run(scene, 1);
  const double t = trace.duration(), v = force / mass * duration, step = force / mass * lab.dt();
  const double vx = trace.last(0).velocity.x;
  // A force that has no end comes after the push in the list.
  const double steady = 3, other_mass = 2;
  scene.bodies.push_back(make(Ball{.name = "other", .position = {0, 5}, .mass = other_mass}));
  scene.forces.emplace_back(push("other", {steady, 0}));
  const double other = lab.run(scene, 1).last(1).velocity.x, other_due = steady / other_mass * t;
  // An engine that evaluates forces only at the start of each step may apply the push for up to one step too
  // long or too short.
  return Judgement()
      .read("vx after the push", "m/s", vx, v, step + lab.rounding(v, t))
      .read("way after 1 s, at the speed that the push gave", "m", trace.last(0).position.x,
            vx * (t - start - duration / 2), 2 * std::abs(vx) * lab.dt() + 1e-6)
      .read("vx of a ball whose force has no end and comes second", "m/s", other, other_due,
            lab.rounding(other_due, t))
      .mistake("push_never_ends", {force / mass * (t - start)},
               "The push goes on: it ends at start + duration. Clear forces at the end of each step.")
      .mistake("push_starts_at_once", {force / mass * (start + duration)},
               "The push acts from the beginning: it starts at \"start\".")
      .mistake("push_always", {force / mass * t},
               "The push acts all the time: \"start\" and \"duration\" are not used.")
      .mistake("push_missed", {0},
               "The push is missed: compare the time with \"start\" and \"start\" + \"duration\".")
      .mistake("push_without_dt", {v / lab.dt()}, "The push adds F/m each step: it should add F dt/m.")
      .finding();
}

Finding drag(const Lab& lab) {
  const double c = 1.5, mass = 2.5, v0 = 4;  // not 2: a mistake in the mass must not look like a factor of 2
  Scene scene = scene_of("drag", {}, {make(Ball{.velocity = {v0, 0}, .mass = mass})});
  scene.forces.emplace_back(LinearDrag{.body = "ball", .coefficient = c});
  const Trace trace = lab.run(scene, 1);
  const double t = trace.duration(), rate = c / mass;
  const double v = v0 * std::exp(-rate * t);
  scene.bodies.front().velocity = {0, -v0};
  const double down = lab.run(scene, 1).last(0).velocity.y;
  return Judgement()
      .read("vx after 1 s", "m/s", trace.last(0).velocity.x, v,
            v * rate * t * lab.method_error(rate, 1e-4) * 1.2)
      .read("vy after 1 s of a ball that moves down", "m/s", down, -v,
            v * rate * t * lab.method_error(rate, 1e-4) * 1.2)
      .mistake("drag_pushes", {v0 * std::exp(rate * t)},
               "Drag speeds the ball up: it is -c v, against the velocity.")
      .mistake("drag_not_divided", {v0 * std::exp(-c * t)}, "Drag is a force: divide it by the mass.")
      .mistake("drag_ignored", {v0}, "Drag does nothing.")
      .mistake("drag_constant", {v0 - rate * t}, "Drag does not grow with speed: it is c v, not c.")
      .mistake("drag_quadratic", {v0 / (1 + rate * v0 * t)},
               "Drag grows with the square of the speed: linear_drag is c v.")
      .finding();
}

// A spring that was fitted to the motion: m dv/dt = -stiffness (x - rest) - damping v.
struct Acting {
  double stiffness, rest, damping;  // N/m, m, N s/m

  static bool seems(double value, double right) { return std::abs(value - right) < 0.02 * right; }
  bool damped(double k) const { return std::abs(damping) > 0.015 * k; }
};

// Fits a linear spring to the changes of velocity in the first seconds, by least squares; nullopt if another
// law acts. A method that evaluates the force half a step later shows a damping of h k/2, which is less than
// the threshold `damped`.
std::optional<Acting> acting(const Trace& trace, double mass, double rest) {
  Matrix3 sums{};
  std::array<double, 3> right{};
  double square = 0;
  struct Row {
    double x, v, force;
  };
  std::vector<Row> rows;
  for (std::size_t i = 0; i + 1 < trace.states.size() && trace.times[i] < 2.5; ++i) {
    const BodyState &now = trace.states[i][0], &next = trace.states[i + 1][0];
    const double dt = trace.times[i + 1] - trace.times[i];
    rows.push_back({now.position.x - rest, now.velocity.x, mass * (next.velocity.x - now.velocity.x) / dt});
  }
  for (const Row& row : rows) {
    const std::array<double, 3> basis{row.x, 1, row.v};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) sums[i][j] += basis[i] * basis[j];
      right[i] += basis[i] * row.force;
    }
    square += row.force * row.force;
  }
  const auto solution = solve(sums, right);
  if (!solution || square == 0) return std::nullopt;
  const auto [slope, constant, damping] = *solution;
  double off = 0;
  for (const Row& row : rows) {
    const double miss = row.force - slope * row.x - constant - damping * row.v;
    off += miss * miss;
  }
  constexpr double kSame = 0.01;  // largest root-mean-square residual, as a fraction of the force
  if (!(off <= kSame * kSame * square) || slope >= 0) return std::nullopt;
  return Acting{-slope, rest - constant / slope, -damping};
}

// Two balls at rest on a spring, at distance `first`, m. With the masses 1.6 and 0.8 kg they oscillate with a
// reduced mass of 1.6/3 kg.
constexpr double kFirstMass = 1.6, kSecondMass = 0.8, kReduced = 1.6 / 3, kApart = 2;  // kg; m at rest

Scene two_on_a_spring(double first, double stiffness, double damping) {
  const Vec2d along{0.8, 0.6}, at{-1, 0.5};
  Scene scene = scene_of("two on a spring", {},
                         {make(Ball{.name = "first", .position = at, .mass = kFirstMass}),
                          make(Ball{.name = "second", .position = at + first * along, .mass = kSecondMass})});
  SpringForce law;
  law.body_a = "first";
  law.body_b = "second";
  law.rest_length = kApart;
  law.stiffness = stiffness;
  law.damping = damping;
  scene.forces.emplace_back(law);
  return scene;
}

// The distance of the two, and how far their centre of mass has moved, m.
struct Pair {
  double apart, moved;
};

Pair pair_at(const Trace& trace, std::size_t k) {
  const auto centre = [&](std::size_t at) {
    const auto& s = trace.states[at];
    return 1 / (kFirstMass + kSecondMass) * (kFirstMass * s[0].position + kSecondMass * s[1].position);
  };
  return {length(trace.states[k][1].position - trace.states[k][0].position), length(centre(k) - centre(0))};
}

// Returns true if a force of 1 N gives the ball the acceleration 1/m.
bool weighs_right(const Lab& lab, const Body& ball) {
  Scene scene = scene_of("push", {}, {ball});
  scene.forces.emplace_back(push(ball.name, {1, 0}));
  const Trace trace = lab.run(scene, 0.5);
  return std::abs(trace.last(0).velocity.x * ball.mass / trace.duration() - 1) < 0.01;
}

Finding spring(const Lab& lab) {
  const double mass = 1.6, k = 14.4, amplitude = 0.2, rest = 1, w = std::sqrt(k / mass);
  Scene scene = scene_of("spring", {}, {make(Ball{.position = {rest + amplitude, 0}, .mass = mass})});
  SpringForce law;
  law.body_a = kWorld;
  law.body_b = "ball";
  law.rest_length = rest;
  law.stiffness = k;
  scene.forces.emplace_back(law);
  const Trace trace = lab.run(scene, 10);
  // The same spring, released from a compressed state.
  Scene shortened = scene;
  // Its end in the world is not the origin.
  const Vec2d end{-0.4, 0.3};
  std::get<SpringForce>(shortened.forces.front()).anchor_a = end;
  shortened.bodies.front().position = end + Vec2d{rest - amplitude, 0};
  const double quarter = 0.2;  // s; the period is 2.1 s
  const Trace pushed = lab.run(shortened, quarter);
  // The same with a ball at each end.
  const double swings = 3, time = 0.8, apart = 0.3;  // rad/s, s, m
  const Trace two = lab.run(two_on_a_spring(kApart + apart, swings * swings * kReduced, 0), time);
  const Pair pair = pair_at(two, two.states.size() - 1);
  const double pair_due = kApart + apart * std::cos(swings * two.duration());
  const auto energy = [&](const BodyState& s) {
    const double stretch = std::hypot(s.position.x, s.position.y) - rest;
    return mass * dot(s.velocity, s.velocity) / 2 + k * stretch * stretch / 2;
  };
  const double h = lab.substep() > 0 ? lab.substep() : lab.dt();
  std::optional<Acting> acts = acting(trace, mass, rest);
  // A wrong mass looks like a wrong spring, so the law is known only if the ball has the right mass.
  const bool acts_wrongly =
      acts && (!acts->seems(acts->stiffness, k) || !acts->seems(acts->rest, rest) || acts->damped(k));
  if (acts_wrongly && !weighs_right(lab, scene.bodies.front())) acts.reset();
  const double t = trace.duration(), n = t / h;
  const double growth = std::pow(energy(trace.last(0)) / energy(trace.first(0)), 1 / n);
  const std::size_t early = trace.states.size() / 10;
  const double te = trace.times[early];
  const auto x = [&](double frequency) { return rest + amplitude * std::cos(frequency * te); };
  // The energy of a symplectic method oscillates by at most w h around the true one.
  const double swing = std::log1p(lab.method_error(w, 1e-3) * 2 + 1e-3) / n;
  return Judgement()
      .read("growth of energy a step", "", growth, 1, swing)
      .read("x after 1 s", "m", trace.states[early][0].position.x, x(w),
            amplitude * w * te * lab.method_error(w, 1e-3) + 1e-3)
      .read("x after 0.2 s of a ball that begins too near", "m", pushed.last(0).position.x - end.x,
            rest - amplitude * std::cos(w * pushed.duration()),
            amplitude * w * quarter * lab.method_error(w, 1e-3) + 1e-3)
      .read("distance after 0.8 s of two balls on a spring", "m", pair.apart, pair_due,
            apart * swings * time * lab.method_error(swings, 1e-3) + 1e-3)
      .read("shift of the centre of mass of the two", "m", pair.moved, 0, lab.rounding(10, time) + 1e-6)
      .mistake(
          "explicit_euler", {1 + w * w * h * h, kAny},
          fmt::format("Your energy grows by 1 + w^2 h^2 = {:.6f} a step: that is explicit Euler. Update the "
                      "velocity first, then the position with the new velocity.",
                      1 + w * w * h * h))
      .mistake(
          "implicit_euler", {1 / (1 + w * w * h * h), kAny},
          "Your energy shrinks by 1/(1 + w^2 h^2) a step: that is implicit Euler, which damps every motion.")
      .mistake("mass_not_divided", {kAny, x(std::sqrt(k))}, "The spring's force is not divided by the mass.")
      .mistake(
          "spring_pushes", {kAny, rest + amplitude * std::cosh(w * te)},
          "The spring pushes where it should pull: the force on the ball points back to its rest length.")
      .mistake("rest_length_ignored", {kAny, (rest + amplitude) * std::cos(w * te)},
               "The spring pulls to its anchor: take \"rest_length\" off the length.")
      .mistake("spring_ignored", {1, rest + amplitude, kAny, kApart + apart, 0}, "The spring does nothing.")
      .proven_if(
          acts && acts->seems(acts->stiffness, k) && !acts->seems(acts->rest, rest) && !acts->damped(k),
          acts && std::abs(acts->rest) < 0.02 * rest ? "rest_length_ignored" : "rest_length_wrong",
          fmt::format("The spring acts as if it were {:.3g} m long at rest, and its \"rest_length\" is "
                      "{:.3g}: its force is stiffness (length - rest_length).",
                      acts ? std::round(1000 * acts->rest) / 1000 + 0.0 : 0, rest))
      .proven_if(
          acts && acts->seems(acts->rest, rest) && !acts->seems(acts->stiffness, k) && !acts->damped(k),
          "stiffness_wrong",
          fmt::format("The spring acts with {:.3g} N/m, and its \"stiffness\" is {:.3g}: its "
                      "force is stiffness (length - rest_length), on both ends.",
                      acts ? acts->stiffness : 0, k))
      .proven_if(acts && acts->seems(acts->stiffness, k) && acts->seems(acts->rest, rest) && acts->damped(k),
                 "spring_damped",
                 fmt::format("A force of {:.3g} N s/m times the velocity acts beside the spring: its "
                             "\"damping\" is 0 here, and nothing else acts.",
                             acts ? acts->damping : 0))
      .finding();
}

// Returns the fraction of their angular momentum that two balls keep which circle on a spring: its force is
// along the line of the two. Returns 1 if the engine refuses balls that might meet.
double angular_momentum_kept(const Lab& lab, Scene circling) try {
  circling.bodies[1].velocity = {-0.9, 1.2};
  const auto turning = [](const std::vector<BodyState>& s) {
    return cross(s[1].position - s[0].position, s[1].velocity - s[0].velocity);
  };
  const Trace circle = lab.run(circling, 1);
  return turning(circle.states.back()) / turning(circle.states.front());
} catch (const NotYet&) {
  return 1;
}

// Two balls on a damped spring: their distance decays as exp(-c t/(2 m)), m the reduced mass, and swings.
Finding damped_spring(const Lab& lab) {
  const double k = 4.8, c = 0.8, stretch = 0.5, decay = c / (2 * kReduced),
               undamped = std::sqrt(k / kReduced);
  const double w = std::sqrt(undamped * undamped - decay * decay);
  const Trace trace = lab.run(two_on_a_spring(kApart + stretch, k, c), 2);
  const auto due = [&](double t) {
    return kApart + stretch * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
  };
  const std::size_t end = trace.states.size() - 1, middle = end / 2;
  const double tolerance = stretch * undamped * lab.method_error(undamped, 1e-3) + 1e-3;
  const Pair half = pair_at(trace, middle), whole = pair_at(trace, end);
  const double t = trace.duration();
  const double kept = angular_momentum_kept(lab, two_on_a_spring(kApart + stretch, k, c));
  return Judgement()
      .read("distance after 1 s", "m", half.apart, due(trace.times[middle]), tolerance)
      .read("distance after 2 s", "m", whole.apart, due(t), tolerance)
      .read("shift of the centre of mass", "m", whole.moved, 0, lab.rounding(10, t) + 1e-6)
      .read("angular momentum that the two keep if they circle", "of all", kept, 1, 0.05)
      .mistake("damping_ignored",
               {kApart + stretch * std::cos(undamped * trace.times[middle]),
                kApart + stretch * std::cos(undamped * t), 0},
               "The spring's damping is left out: its force is stiffness (length - rest_length) + damping "
               "(speed at which the ends part).")
      .mistake("spring_ignored", {kApart + stretch, kApart + stretch, 0}, "The spring does nothing.")
      .finding();
}

}  // namespace

Chapter cannonballs() {
  return {
      .number = 2,
      .title = "Cannonballs: forces, mass, wind",
      .page = "2-cannonballs.md",
      .checks = {{"force_accelerates", "a constant force adds F dt/m a step", kPush, force_accelerates},
                 {"ten_times_the_mass", "ten times the mass, a tenth of the acceleration", kPush,
                  ten_times_the_mass},
                 {"all_fall_alike", "light and heavy fall alike", kBall, all_fall_alike},
                 {"forces_add", "wind, thrust and gravity add up", kPush, forces_add},
                 {"push_ends", "a push has a start and an end", kPush, push_ends},
                 {"drag", "drag slows by exp(-c t/m)", "\"forces\":[\"linear_drag\"]", drag},
                 {"spring", "a spring keeps its energy and its period", "\"forces\":[\"spring\"]", spring},
                 {"damped_spring", "a damped spring between two balls comes to rest",
                  "\"forces\":[\"spring\"]", damped_spring}}};
}

}  // namespace plumb::course
