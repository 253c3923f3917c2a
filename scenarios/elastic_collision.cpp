#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/scenario.h"
#include "scenarios/truth/billiard.h"

// Discs that collide in free space. The velocities after an impact depend only on masses, restitution and the
// normal at the moment of contact. No contact falls on a step of 1/60 or 1/240 s.
namespace plumb::scenarios {
namespace {

constexpr double kDuration = 2;

struct Ball {
  std::string name;
  double mass, radius;
  Vec2d position, velocity;
};

Scene balls(std::string_view variant, double restitution, const std::vector<Ball>& list) {
  Scene scene{.name = "elastic_collision/" + std::string(variant), .gravity = {0, 0}};
  for (const Ball& b : list) {
    const Shape disc{.geometry = Circle{b.radius}, .friction = 0, .restitution = restitution};
    scene.bodies.push_back(
        {.name = b.name, .position = b.position, .velocity = b.velocity, .mass = b.mass, .shapes = {disc}});
  }
  return scene;
}

/// A light disc hits a heavy one, and a heavy one hits a light one: v1' = (m1 - m2)/(m1 + m2) v and v2' = 2
/// m1/(m1 + m2) v. The two pairs do not interact.
Scene head_on(std::string_view variant, double ratio) {
  return balls(variant, 1,
               {{"light", 1, 0.5, {-2.53, 3}, {2.25, 0}},
                {"heavy_target", ratio, 0.5, {0, 3}, {0, 0}},
                {"heavy", ratio, 0.5, {-2.53, -3}, {1.75, 0}},
                {"light_target", 1, 0.5, {0, -3}, {0, 0}}});
}

/// Unequal discs, off-centre: the impulse lies along the line of centres at the contact.
Scene oblique(std::string_view variant, double restitution) {
  return balls(variant, restitution,
               {{"cue", 1, 0.5, {-3, 6.3}, {3, 0}},
                {"object", 1, 0.5, {0, 6}, {0, 0}},
                {"small", 0.5, 0.25, {-2.04, 0}, {2.5, 0.4}},
                {"large", 4, 1, {1.5, 0.2}, {-0.5, 0.1}},
                {"falling", 2, 0.4, {0.2, -3}, {0.3, -2}},
                {"rising", 3, 0.6, {-0.1, -7}, {0.1, 1.2}}});
}

/// One pair head-on, both moving, and one off-centre.
Scene inelastic(std::string_view variant, double restitution) {
  return balls(variant, restitution,
               {{"chaser", 1, 0.5, {-3.01, 2}, {3.5, 0}},
                {"chased", 2, 0.25, {0, 2}, {0.5, 0}},
                {"small", 0.5, 0.25, {-2.04, -2}, {2.5, 0.4}},
                {"large", 4, 1, {1.5, -1.8}, {-0.5, 0.1}}});
}

/// Newton's cradle with gaps: equal discs in line swap their velocities, one pair after another.
Scene cradle(std::string_view variant) {
  constexpr std::array kGaps = {0.83, 0.077, 0.111, 0.053};
  std::vector<Ball> row = {{"disc0", 1, 0.25, {-2, 0.5}, {2, 0}}};
  for (const double gap : kGaps) {
    const Vec2d next = row.back().position + Vec2d{0.5 + gap, 0};
    row.push_back({"disc" + std::to_string(row.size()), 1, 0.25, next, {0, 0}});
  }
  return balls(variant, 1, row);
}

Scene scene_of(std::string_view variant) {
  if (variant == "head_on_1") return head_on(variant, 1);
  if (variant == "head_on_10") return head_on(variant, 10);
  if (variant == "head_on_1000") return head_on(variant, 1000);
  if (variant == "head_on_1e6") return head_on(variant, 1e6);
  if (variant == "restitution_0") return inelastic(variant, 0);
  if (variant == "restitution_half") return inelastic(variant, 0.5);
  if (variant == "cradle") return cradle(variant);
  return oblique(variant, 1);
}

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of(variant), .duration = kDuration};
  problem.truth = truth::billiard_truth(problem.scene, kDuration);
  const double restitution = problem.scene.bodies.front().shapes.front().restitution;
  problem.conserved = {
      .energy = restitution == 1, .momentum_x = true, .momentum_y = true, .angular_momentum = true};

  // Head-on the normal is constant, so only rounding errors remain; off-centre it depends on the time of
  // contact.
  double fastest = 0;
  for (const Body& body : problem.scene.bodies)
    fastest = std::max(fastest, std::sqrt(length_squared(body.velocity)));
  const bool in_line = variant.starts_with("head_on") || variant == "cradle";
  const double digits = in_line ? 1e-13 : 1e-12;
  problem.precise = {.position = 1e-12 * fastest * kDuration,
                     .angle = 1e-12,
                     .velocity = digits * fastest,
                     .angular_velocity = 1e-12,
                     .energy = digits,
                     .momentum = digits,
                     .angular_momentum = 1e-12,
                     .penetration = 1e-10};
  // Paths between impacts are straight, so a method that places impacts within the substep has no error of
  // the step.
  problem.second_order = {.position = 0,
                          .angle = 0,
                          .velocity = 0,
                          .angular_velocity = 0,
                          .energy = 0,
                          .momentum = 0,
                          .angular_momentum = 0};
  return problem;
}

const Register r{{.name = "elastic_collision",
                  .summary = "discs that collide: mass ratios, off-centre, restitution, Newton's cradle",
                  .variants = {"head_on_1", "head_on_10", "head_on_1000", "head_on_1e6", "oblique",
                               "restitution_0", "restitution_half", "cradle"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios
