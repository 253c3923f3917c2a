#include "harness/course/circle_contacts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/course/circle_pairs.h"
#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

// Returns the separation speed of two balls that overlap at the start; nothing should drive them apart.
// Returns 0 for an engine that refuses such a start.
double kick(const Lab& lab, int finer) try {
  const double r = 0.5, deep = 0.1;
  const Trace trace = head_on(lab, {.position = {-r + deep / 2, 0}, .radius = r, .restitution = 0},
                              {.position = {r - deep / 2, 0}, .radius = r, .restitution = 0}, 2, finer);
  return trace.last(1).velocity.x - trace.last(0).velocity.x;
} catch (const Error& error) {
  if (error.field() == "overlap") return 0;
  throw;
}

// Returns true if a ball that rests falls freely in many single steps, because its contact is not found in
// them.
bool loses_contact(const Lab& lab, const Trace& trace, double g) {
  const std::size_t n = trace.states.size(), from = n - n / 3;
  std::size_t falls = 0;
  for (std::size_t k = from; k < n; ++k) {
    const double gain = trace.states[k][0].velocity.y - trace.states[k - 1][0].velocity.y;
    falls += gain < -0.5 * g * lab.dt();
  }
  return 4 * falls > n - from && 4 * falls < 3 * (n - from);
}

struct Sleeper {
  double vx = 0;        ///< m/s
  double vy = 0;        ///< m/s
  double farthest = 0;  ///< m, from where it lay at the start
};

// Lets a ball hit another that has lain on the floor for more than a second.
Sleeper sleeper_after_hit(const Lab& lab) {
  const double r = 0.5;
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}));
  const Body hits =
      make(Ball{.name = "hits", .position = {-3.9, r}, .velocity = {2, 0}, .radius = r, .restitution = 0});
  const Body lies = make(Ball{.name = "lies", .position = {0, r}, .radius = r, .restitution = 0});
  const Trace trace = lab.run(scene_of("sleeper", {0, -9.81}, {hits, floor, lies}), 2);
  Sleeper out{.vx = trace.last(2).velocity.x, .vy = trace.last(2).velocity.y};
  for (const auto& states : trace.states)
    out.farthest = std::max(out.farthest, std::hypot(states[2].position.x, states[2].position.y - r));
  return out;
}

// Returns how much is left after a second, m, of 10 cm that a ball overlaps a static post. A static body does
// not give way, so the ball's mass makes no difference. Returns 0 for an engine that refuses such a start.
double overlap_left_at_post(const Lab& lab, double mass) try {
  constexpr double kDeep = 0.1, kRadius = 0.4;  // m
  const Body ball =
      make(Ball{.position = {-2 * kRadius + kDeep, 0}, .mass = mass, .radius = kRadius, .restitution = 0});
  const Body post = fixed(make(Ball{.name = "post", .radius = kRadius, .restitution = 0}));
  const Trace trace = lab.run(scene_of("overlap of a post", {}, {ball, post}), 1);
  return 2 * kRadius - distance(trace, trace.states.size() - 1);
} catch (const Error& error) {
  if (error.field() == "overlap") return 0;
  throw;
}

// Returns how far a ball that touches a post is pushed into it, m, by one that hits it at `v`. Both contacts
// exist from the start, without gravity, so that the second one closes only by the impulse of the first.
// Returns 0 for an engine that refuses such a start.
double pushed_into_post(const Lab& lab, double v) try {
  constexpr double kRadius = 0.4, kDeep = 0.002;  // m
  const auto ball = [&](const char* name, double place, double speed) {
    return make(Ball{.name = name,
                     .position = {place * (2 * kRadius - kDeep), 0},
                     .velocity = {speed, 0},
                     .radius = kRadius,
                     .restitution = 0});
  };
  const Trace trace = lab.run(
      scene_of("hit at a post", {}, {ball("hits", -2, v), ball("between", -1, 0), fixed(ball("post", 0, 0))}),
      0.3);
  double farthest = 0;
  for (const auto& states : trace.states)
    farthest = std::max(farthest, states[1].position.x - trace.first(1).position.x);
  return farthest;
} catch (const Error& error) {
  if (error.field() == "overlap") return 0;
  throw;
}

}  // namespace

Finding post(const Lab& lab) {
  const double v = 2, start = -2;
  const Body ball = make(Ball{.position = {start, 0}, .velocity = {v, 0}});
  const Trace trace = lab.run(scene_of("post", {}, {ball, fixed(make(Ball{.name = "post"}))}), 1.5);
  const double t = trace.duration(), touches = -2 * Ball{}.radius, late = v * lab.dt();
  // A static body of finite mass would still turn a light ball back, if the impulses of many sweeps add up.
  constexpr double kHeavy = 20;  // kg
  const Trace heavy =
      lab.run(scene_of("heavy on post", {},
                       {make(Ball{.position = {start, 0}, .velocity = {v, 0}, .mass = kHeavy}),
                        fixed(make(Ball{.name = "post"}))}),
              1.5);
  const BodyState& fixed_end = trace.last(1);
  const bool moves = std::hypot(fixed_end.position.x, fixed_end.position.y) > 1e-9;
  bool has_velocity = false;
  for (const auto& states : trace.states) has_velocity = has_velocity || states[1].velocity != Vec2d{};
  return Judgement()
      .read("vx of the ball", "m/s", trace.last(0).velocity.x, -v, kShare * v)
      .read("vy of the ball", "m/s", trace.last(0).velocity.y, 0, kShare * v)
      .read("x of the ball", "m", trace.last(0).position.x, touches - (v * t - (touches - start)), 3 * late)
      .read("x of the post", "m", fixed_end.position.x, 0, 1e-9)
      .read("vx of the post", "m/s", fixed_end.velocity.x, 0, 1e-9)
      .read("vx of a ball of 20 kg", "m/s", heavy.last(0).velocity.x, -v, kShare * v)
      .read("overlap of the post that 20 kg keep longer than 1 kg", "m",
            overlap_left_at_post(lab, kHeavy) - overlap_left_at_post(lab, 1), 0, 0.005)
      .read("way that a ball at a post is pushed into it by another, at 2 m/s", "m", pushed_into_post(lab, v),
            0, 0.25 * v * lab.dt())
      .proven_if(
          moves, "static_moves",
          "The static post moves: a static body stays where it is, with an inverse mass of 0 in impulses and "
          "in corrections of position.")
      .proven_if(
          has_velocity && !moves, "static_has_mass",
          "The static post gets a velocity, though it does not move: its inverse mass is 0, so that no "
          "impulse changes its velocity.")
      .mistake_if(pulled_back(trace, v), "no_test_of_parting", kPulledBack)
      .mistake_if(trace.still(0), "starts_at_rest", "The ball never moves.")
      .mistake("static_has_mass", {0, 0, touches, kAny, kAny, kAny},
               "The ball stops at the post, as at a free ball of 1 kg: a static body's inverse mass is 0. Or "
               "no collision "
               "bounces, as the checks before would say.")
      .mistake("no_collision", {v, 0, start + v * t, 0, 0, v}, "The ball goes through the static post.")
      .finding();
}

Finding break_shot(const Lab& lab) {
  const double r = 0.2, gap = 0.06, v = 2;  // crosses less than a gap per step: collisions are separate
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
  double deepest = 0;  // in any step
  for (const auto& states : trace.states)
    for (std::size_t i = 0; i < bodies.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vec2d way = states[i].position - states[j].position;
        deepest = std::max(deepest, 2 * r - std::hypot(way.x, way.y));
      }
  const auto two_alone_touch = [&] {
    const Trace two = lab.run(scene_of("two", {}, {bodies[0], bodies[1]}), 1);
    double nearest = distance(two, 0);
    for (std::size_t k = 0; k < two.states.size(); ++k) nearest = std::min(nearest, distance(two, k));
    return two.last(1).velocity.x > 0.1 * v && nearest > r;
  };
  // Correcting a fraction of the overlap over dt is faster the shorter the step; the speed of a stiff spring
  // does not depend on the step.
  const double parting = kick(lab, 1);
  const bool by_step = std::abs(parting) > 0.05 && kick(lab, 2) > 1.5 * parting;
  return Judgement()
      .read("momentum lost", "of all", p, 0, lab.rounding(20, 3))
      .read("energy kept", "of all", ratio, 1, 0.02)
      .read("overlap at the end", "m", overlap, 0, v * lab.dt())
      .read("speed apart of two that overlap", "m/s", parting, 0, 0.05)
      .read("deepest overlap on the way", "m", deepest, 0, 3 * v * lab.dt() + 0.05 * r)
      .symptom_if(p > 0.01, "Momentum is lost or gained.")
      .proven_if(by_step, "correction_adds_energy",
                 "Two balls that overlap and do not move fly apart: correct positions, and leave velocities "
                 "as they are.")
      .symptom_if(ratio > 1.02, fmt::format("Energy grows to {:.2f} times.", ratio))
      .symptom_if(ratio < 0.98, "Elastic balls lose energy.")
      .proven_if(deepest > r && two_alone_touch(), "pairs_missed",
                 "Two balls alone bounce, and among others balls go through each other: find the contacts of "
                 "all pairs, not only of some.")
      .symptom_if(overlap > v * lab.dt(), "Balls stay in each other.")
      .finding();
}

// Lets 10 kg and 1 kg overlap at rest, and measures how far each is moved: it should be in proportion to its
// inverse mass, which leaves the centre of mass in place.
Finding overlap_is_shared(const Lab& lab) try {
  const double heavy = 10, light = 1, deep = 0.1, r = 0.4;
  const Trace trace =
      head_on(lab, {.position = {-r + deep / 2, 0}, .mass = heavy, .radius = r, .restitution = 0},
              {.position = {r - deep / 2, 0}, .mass = light, .radius = r, .restitution = 0}, 1);
  const double a = trace.last(0).position.x - trace.first(0).position.x;
  const double b = trace.last(1).position.x - trace.first(1).position.x;
  const double centre = (heavy * a + light * b) / (heavy + light), most = 0.05 * deep;
  const double overlap = 2 * r - distance(trace, trace.states.size() - 1);
  // Inverse masses that add up to 15 show a correction that is not divided by their sum.
  const Trace light_pair =
      head_on(lab, {.position = {-r + deep / 2, 0}, .mass = 0.2, .radius = r, .restitution = 0},
              {.position = {r - deep / 2, 0}, .mass = 0.1, .radius = r, .restitution = 0}, 1);
  const double light_overlap = 2 * r - distance(light_pair, light_pair.states.size() - 1);
  const bool alike =
      b > most && std::abs(a + b)<0.1 * b, swapped = b> most && std::abs(a + heavy * b) < 0.1 * -a;
  return Judgement()
      .read("shift of the centre of mass", "m", centre, 0, most)
      .read("overlap that is left", "m", overlap, 0, deep)
      .read("overlap that is left of 0.2 kg and 0.1 kg", "m", light_overlap, 0, deep)
      .proven_if(
          overlap > 1.01 * deep && two_bounce(lab), "pushed_together",
          "The overlap grows: the correction pushes the two into each other. a moves against the normal, b "
          "along it.")
      .proven_if(
          alike, "correction_split_evenly",
          "10 kg and 1 kg are moved equally far: each moves by its inverse mass over the sum of both, here 1 "
          "and 10 parts of 11.")
      .proven_if(
          swapped, "correction_shares_swapped",
          "The heavy ball is moved ten times as far as the light one: the shares are swapped. Each moves by "
          "its inverse mass over the sum of both.")
      .proven_if(std::abs(a) < 1e-12 && b > most, "correction_of_one_only",
                 "Only the second ball is moved: both move, each by its share of the inverse masses.")
      .proven_if(std::abs(b) < 1e-12 && -a > most, "correction_of_one_only",
                 "Only the first ball is moved: both move, each by its share of the inverse masses.")
      .finding();
} catch (const Error& error) {
  if (error.field() == "overlap") return {};  // an engine that refuses such a start corrects nothing
  throw;
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
  const Sleeper sleeper = sleeper_after_hit(lab);
  const bool through = height < -2 * r || gap < -2 * r;
  const auto rests_alone = [&] {
    return std::abs(lab.run(scene_of("one", {0, -g}, {lower, floor}), 1.5).last(0).position.y - r) <
           tolerance;
  };
  const bool missed = through && rests_alone() && two_bounce(lab);
  // Distinguishes a ball that keeps sinking from one that rests too deep.
  const auto sinks_on = [&] {
    const Trace longer = lab.run(scene_of("pile", {0, -g}, {lower, upper, floor}), 3);
    const double low = longer.last(0).position.y, high = longer.last(1).position.y;
    return low - r < 1.5 * std::min(height, -tolerance) ||
           high - low - 2 * r < 1.5 * std::min(gap, -tolerance);
  };
  const bool deep = height < -tolerance || gap < -tolerance;
  const bool lost = !deep && loses_contact(lab, trace, g);
  return Judgement()
      .read("lower ball above the floor", "m", height, 0, tolerance)
      .read("upper ball above the lower", "m", gap, 0, tolerance)
      .read("vy of the upper", "m/s", trace.last(1).velocity.y, 0, 2 * g * lab.dt())
      .read("vx of a ball that lies still for a second and is hit", "m/s", sleeper.vx, 1, 0.05)
      .read("vy of this ball, on the floor", "m/s", sleeper.vy, 0, 0.5 * g * lab.dt())
      .proven_if(
          sleeper.vx == 0 && sleeper.farthest < tolerance && two_bounce(lab), "sleeps_and_is_not_woken",
          "A ball that has lain still does not move when another hits it: wake a body that is touched, "
          "or let none sleep.")
      .mistake_if(trace.still(0), "no_gravity", "It hangs in the air: gravity pulls at it.")
      .proven_if(missed, "pairs_missed",
                 "A ball rests on the floor when it is alone, and falls through when there are two: find the "
                 "contacts of all pairs, not only of some.")
      .proven_if(
          lost, "contact_lost",
          "The lower ball is stopped in one step and falls in the next: what was pushed apart by all of "
          "its overlap does not touch in the next step. Remove a share of the overlap a step, and leave "
          "the last half millimetre.")
      .mistake_if(through, "falls_through",
                  "A ball sinks through what it rests on: apply an impulse in each step in which two overlap "
                  "and close.")
      .mistake_if(deep && sinks_on(), "sinks",
                  "The pile sinks: correct positions as well as velocities, each ball by its share of the "
                  "inverse masses.")
      .symptom_if(deep, "The pile rests too deep.")
      .symptom_if(height > tolerance || gap > tolerance, "The pile does not come to rest.")
      .finding();
}

}  // namespace plumb::course
