#include <cmath>

#include "scenarios/truth/parts.h"

// A block slides to rest: t = v0/(mu g) and x = v0^2/(2 mu g). Source: Coulomb.
namespace plumb::scenarios::sliding_stop {
namespace {
using namespace truth;

constexpr double kFriction = 0.4, kSpeed = 3;  // m/s

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("sliding_stop"), .duration = 1.5};
  problem.scene.bodies = {ground(kFriction),
                          {.name = "block",
                           .position = {-1, 0.125},
                           .velocity = {kSpeed, 0},
                           .mass = 3,
                           .shapes = {solid(Box{0.5, 0.25}, kFriction)}}};
  const Real rub = Real(kFriction) * kGravity;
  problem.truth = follow_in_contact(problem.scene, "t = v0/(mu g), x = v0^2/(2 mu g) (Coulomb)",
                                    [=](Real t, Moving moving) {
                                      moving[0] = coast_until(moving[0], kSpeed / rub, t, {{-rub, 0}});
                                      if (t > kSpeed / rub) moving[0].velocity = {};
                                    });
  problem.precise = within(1e-10);
  return problem;
}

const Register r{
    {.name = "sliding_stop", .summary = "a block slides to rest on level ground", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::sliding_stop
