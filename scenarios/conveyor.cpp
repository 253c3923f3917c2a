#include <cmath>

#include "scenarios/truth/parts.h"

// A block laid on a belt that moves at u: it gains mu g until it moves with the belt, at u/(mu g). Source:
// Coulomb, in the frame of the belt.
namespace plumb::scenarios::conveyor {
namespace {
using namespace truth;

constexpr double kFriction = 0.3, kSpeed = 1.5;  // m/s

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("conveyor"), .duration = 1};
  problem.scene.bodies = {
      {.name = "belt",
       .type = BodyType::Kinematic,
       .position = {0, -0.5},
       .velocity = {kSpeed, 0},
       .shapes = {solid(Box{20, 1}, kFriction)}},
      {.name = "block", .position = {0, 0.125}, .shapes = {solid(Box{0.5, 0.25}, kFriction)}}};
  const Real rub = Real(kFriction) * kGravity;
  problem.truth = follow_in_contact(problem.scene, "a = mu g until the belt's speed (Coulomb)",
                                    [=](Real t, Moving moving) {
                                      moving[0] = coast_until(moving[0], kSpeed / rub, t, {{rub, 0}});
                                    });
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "conveyor", .summary = "a block laid on a moving belt", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::conveyor
