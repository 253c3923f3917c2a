#include "scenarios/scenario.h"
#include "scenarios/truth/motion.h"

// Atwood's machine: two masses on a rope over two pulleys, a = (m1 - m2) g/(m1 + m2). Source: Atwood 1784.
namespace plumb::scenarios::atwood {
namespace {
using namespace truth;

constexpr double kHeavy = 3, kLight = 2, kGravity = 9.81;  // kg, m/s^2

void exact(double t, std::span<BodyState> out) {
  const Real a = (kHeavy - kLight) * Real(kGravity) / (kHeavy + kLight);
  out[0] = rounded(coast({.position = {-1, 0}}, t, {.linear = {0, -a}}));
  out[1] = rounded(coast({.position = {1, 0}}, t, {.linear = {0, a}}));
}

Problem build(std::string_view, int) {
  Problem problem{.scene = {.name = "atwood", .gravity = {0, -kGravity}}, .duration = 1};
  Scene& scene = problem.scene;
  scene.bodies = {
      {.name = "heavy", .position = {-1, 0}, .mass = kHeavy, .shapes = {untouchable(Box{0.5, 0.5})}},
      {.name = "light", .position = {1, 0}, .mass = kLight, .shapes = {untouchable(Box{0.5, 0.5})}}};
  scene.joints = {PulleyJoint{
      .name = "rope", .body_a = "heavy", .body_b = "light", .ground_a = {-1, 5}, .ground_b = {1, 5}}};
  problem.truth = {.source = "a = (m1 - m2) g/(m1 + m2)", .exact = exact};
  problem.conserved = {.energy = true};
  return problem;
}

const Register r{{.name = "atwood", .summary = "two masses on a rope over pulleys", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::atwood
