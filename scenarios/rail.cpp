#include "scenarios/truth/parts.h"
#include "scenarios/truth/set_up.h"

// A box on a tilted rail slides down at g sin until a limit stops it, or is driven up by a motor at F/m - g
// sin until it reaches the motor's speed. Source: Galileo, Newton.
namespace plumb::scenarios::rail {
namespace {
using namespace truth;

constexpr double kMass = 2, kForce = 20, kSpeed = 1;  // kg, N, m/s

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("rail", variant), .duration = 1.2};
  const Vec2<Real> down = direction(-0.5L);
  PrismaticJoint joint{.name = "rail", .body_a = "world", .body_b = "box", .axis = set_up::direction(-0.5)};
  const bool stops = variant == "stops", driven = variant == "driven";
  if (stops) joint.limits = Range{-1, 1};
  if (driven) joint.motor = Motor{-kSpeed, kForce};
  problem.scene.bodies = {piece("box", {}, untouchable(Box{0.5, 0.25}), kMass)};
  problem.scene.joints = {joint};
  const Real pull = -kGravity * down.y, rate = driven ? pull - kForce / Real(kMass) : pull;
  const Real end = driven ? -kSpeed / rate : stops ? std::sqrt(2 / pull) : problem.duration;
  const auto path = [=](Real t, Moving moving) {
    moving[0] = coast_until({}, end, stops ? std::fmin(t, end) : t, {rate * down});
    if (stops && t >= end) moving[0].velocity = {};
  };
  problem.truth = follow(problem.scene, "g sin until the limit; F/m - g sin until the speed", path);
  if (stops) problem.truth.impacts = {static_cast<double>(end)};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "rail",
                  .summary = "a box on a tilted rail, with a limit and with a motor",
                  .variants = {"slides", "stops", "driven"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::rail
