#include "scenarios/truth/parts.h"

// Two boxes welded together and thrown spinning: one rigid body, whose centre of mass flies a parabola.
// Source: Galileo, Euler.
namespace plumb::scenarios::welded_pair {
namespace {
using namespace truth;

constexpr Real kArm[] = {-0.6, 0.2};  // m from the centre of mass; m1 r1 + m2 r2 = 0
constexpr double kSpin = 3;           // rad/s
constexpr Vec2d kThrow{1, 4};         // m/s

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("welded_pair"), .duration = 1};
  problem.scene.bodies = {thrown(piece("light", {-0.6, 0}, untouchable(Box{0.4, 0.4}), 1),
                                 {kThrow.x, kThrow.y - 0.6 * kSpin}, kSpin),
                          thrown(piece("heavy", {0.2, 0}, untouchable(Box{0.8, 0.3}), 3),
                                 {kThrow.x, kThrow.y + 0.2 * kSpin}, kSpin)};
  problem.scene.joints = {WeldJoint{
      .name = "weld", .body_a = "light", .body_b = "heavy", .anchor_a = {0.4, 0}, .anchor_b = {-0.4, 0}}};
  problem.truth = follow(
      problem.scene, "parabola of the centre of mass, even rotation about it", [](Real t, Moving moving) {
        const Motion centre = coast({{}, 0, kThrow.as<Real>(), kSpin}, t, {{0, -kGravity}});
        for (int i = 0; i < 2; ++i) {
          const Vec2<Real> arm = kArm[i] * direction(kSpin * t);
          moving[i] = {centre.position + arm, centre.angle, centre.velocity + cross(Real(kSpin), arm), kSpin};
        }
      });
  problem.conserved = {.energy = true, .momentum_x = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{
    {.name = "welded_pair", .summary = "two boxes welded together, thrown spinning", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::welded_pair
