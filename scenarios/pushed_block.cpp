#include <cmath>

#include "scenarios/truth/parts.h"

// A block on level ground is pushed for a limited time: it stays iff F <= mu m g; otherwise it accelerates at
// F/m - mu g, and then decelerates at mu g to rest. Source: Coulomb.
namespace plumb::scenarios::pushed_block {
namespace {
using namespace truth;

constexpr double kFriction = 0.5, kMass = 2, kPush = 0.5;  // kg, s

Problem build(std::string_view variant, int) {
  const double part = choose(variant, {{"holds", 0.999}, {"barely_slips", 1.001}, {"slips", 1.5}});
  Problem problem{.scene = scene_of("pushed_block", variant), .duration = 1.2};
  problem.scene.bodies = {ground(kFriction),
                          piece("block", {0, 0.125}, solid(Box{0.75, 0.25}, kFriction), kMass)};
  const double force = part * kFriction * kMass * kGravity;
  problem.scene.forces = {PointForce{.body = "block", .force = {force, 0}, .duration = kPush}};
  const Real rub = Real(kFriction) * kGravity, gain = std::fmax(Real(force) / kMass - rub, Real(0));
  const Real stop = gain * kPush / rub;  // s, after the push
  problem.truth = follow_in_contact(problem.scene, "slips iff F > mu m g, then a = F/m - mu g (Coulomb)",
                                    [=](Real t, Moving moving) {
                                      moving[0] = coast(moving[0], std::fmin(t, Real(kPush)), {{gain, 0}});
                                      const Real after = std::fmin(std::fmax(t - kPush, Real(0)), stop);
                                      moving[0] = coast(moving[0], after, {{-rub, 0}});
                                      if (after == stop) moving[0].velocity = {};
                                    });
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "pushed_block",
                  .summary = "a block pushed along the ground with less or more force than friction can hold",
                  .variants = {"holds", "barely_slips", "slips"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::pushed_block
