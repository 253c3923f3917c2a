#include "scenarios/truth/bounces.h"
#include "scenarios/truth/parts.h"

// Balls dropped from two heights: one is faster than the threshold and bounces, the other is slower and
// stays. Source: Galileo; the scene's rule.
namespace plumb::scenarios::restitution_threshold {
namespace {
using namespace truth;

constexpr double kRestitution = 0.5, kRadius = 0.2;  // m

Problem build(std::string_view variant, int) {
  const double height = choose(variant, {{"slower", 0.12}, {"faster", 0.32}});  // 1.53 and 2.51 m/s
  Problem problem{.scene = scene_of("restitution_threshold", variant), .duration = 0.35};
  problem.scene.contact_rules.restitution_threshold = 2;
  problem.scene.bodies = {ground(0, kRestitution),
                          piece("ball", {0, kRadius + height}, solid(Circle{kRadius}, 0, kRestitution))};
  const Bounces bounces(height, kGravity, variant == "faster" ? kRestitution : 0, problem.duration);
  const auto path = [bounces](Real t, Moving moving) {
    moving[0].position.y = kRadius + bounces.at(t).place;
    moving[0].velocity.y = bounces.at(t).rate;
  };
  problem.truth = follow_in_contact(problem.scene, "impacts slower than the threshold do not bounce", path,
                                    bounces.impacts());
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "restitution_threshold",
                  .summary = "balls slower and faster than the restitution threshold",
                  .variants = {"slower", "faster"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::restitution_threshold
