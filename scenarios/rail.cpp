#include <cmath>

#include "scenarios/truth/parts.h"

// A box on a tilted rail: it slides freely at g sin, until a limit stops it, or up against gravity by a
// motor, at F/m - g sin until it has the motor's speed. Source: Galileo, Newton.
namespace plumb::scenarios {
namespace {

using namespace truth;

constexpr double kTilt = 0.5, kMass = 2, kForce = 20, kSpeed = 1, kLimit = 1;  // rad, kg, N, m/s, m

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("rail", variant), .duration = 1.2};
  const Vec2<Real> down = direction(-Real(kTilt));
  PrismaticJoint joint{
      .name = "rail", .body_a = std::string(kWorld), .body_b = "box", .axis = down.as<double>()};
  if (variant == "stops") joint.limits = Range{-1, kLimit};
  if (variant == "driven") joint.motor = Motor{-kSpeed, kForce};
  problem.scene.bodies = {piece("box", {}, untouchable(Box{0.5, 0.25}), kMass)};
  problem.scene.joints = {joint};
  const Real pull = -kGravity * down.y, drive = pull - kForce / Real(kMass);
  const Real stop = std::sqrt(2 * kLimit / pull);
  problem.truth = follow(problem.scene, "g sin; until the limit, or F/m - g sin until the speed",
                         [=](Real t, Moving moving) {
                           if (variant == "driven") {
                             moving[0] = coast_until({}, -kSpeed / drive, t, {drive * down});
                           } else if (variant == "stops" && t >= stop) {
                             moving[0].position = kLimit * down;
                           } else {
                             moving[0] = coast({}, t, {pull * down});
                           }
                         });
  if (variant == "stops") problem.truth.impacts = {static_cast<double>(stop)};
  problem.conserved = {.energy = variant == "slides"};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "rail",
                  .summary = "a box on a tilted rail, with a limit and with a motor",
                  .variants = {"slides", "stops", "driven"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios
