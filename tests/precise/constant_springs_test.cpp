#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/precise/support.h"

// Springs of joints have a constant stiffness, that of the effective mass where the scene starts.
namespace plumb {
namespace {

constexpr double kMass = 2, kInertia = 0.2, kArm = 0.5;  // kg, kg m^2, m

// Returns a bar whose left end a weld holds at the origin.
Scene bar_on(const WeldJoint& weld, double gravity) {
  Scene scene{.name = "bar", .gravity = {0, -gravity}};
  scene.bodies = {{.name = "bar", .position = {kArm, 0}, .mass = kMass, .inertia = kInertia}};
  scene.joints = {weld};
  return scene;
}

WeldJoint weld_at_end() {
  return {.name = "weld", .body_a = std::string(kWorld), .body_b = "bar", .anchor_b = {-kArm, 0}};
}

double energy(const BodyState& s, double linear, double angular, double gravity) {
  const Vec2d end = s.position - kArm * Vec2d{std::cos(s.angle), std::sin(s.angle)};
  return 0.5 * (kMass * length_squared(s.velocity) + kInertia * s.angular_velocity * s.angular_velocity +
                linear * length_squared(end) + angular * s.angle * s.angle) +
         kMass * gravity * s.position.y;
}

TEST(PreciseSprings, UndampedSoftWeldsOffTheCentreKeepTheEnergy) {
  const double w = 2 * kPi, gravity = 9.81, scale = kMass * gravity * kArm;
  const double across = kMass / (1 + kMass * kArm * kArm / kInertia);
  WeldJoint soft = weld_at_end(), both = weld_at_end();
  soft.linear_spring = both.linear_spring = both.angular_spring = Spring{1, 0};
  const struct {
    WeldJoint weld;
    double linear, angular;
  } table[] = {{soft, kMass * w * w, 0}, {both, (kMass + across) / 2 * w * w, kInertia * w * w}};
  for (const auto& row : table) {
    const auto driver = make_precise_driver(bar_on(row.weld, gravity), {}, {});
    double farthest = 0;
    for (int i = 0; i < 480; ++i) {
      const BodyState s = advance(*driver, 1, 1)[0];
      farthest = std::max(farthest, std::abs(s.angle));
      ASSERT_NEAR(energy(s, row.linear, row.angular, gravity) / scale, 0, 1e-8) << "step " << i;
    }
    if (row.angular > 0) {
      EXPECT_GT(farthest, 1) << "a bar that does not turn shows nothing";
    }
  }
}

TEST(PreciseSprings, PullAlikeInAllDirectionsOfAPoint) {
  // The pull at the end of a bar, along the bar and across it.
  for (const Vec2d away : {Vec2d{0.1, 0}, Vec2d{0, 0.1}}) {
    Scene scene{.name = "mouse", .gravity = {}};
    scene.bodies = {{.name = "bar", .position = {kArm, 0}, .mass = kMass, .inertia = kInertia}};
    scene.joints = {MouseJoint{.name = "mouse",
                               .body_a = std::string(kWorld),
                               .body_b = "bar",
                               .anchor_b = {-kArm, 0},
                               .target = away,
                               .spring = Spring{1, 0},
                               .max_force = 1e6}};
    const double dt = 1e-4;
    const auto driver = make_precise_driver(scene, {.tolerance = 1e-12, .max_dt = dt}, {});
    const BodyState s = advance(*driver, 1, 1)[0];
    const double across = kMass / (1 + kMass * kArm * kArm / kInertia);
    const double k = (kMass + across) / 2 * 4 * kPi * kPi;
    // After a short time t the momentum is F t, but for the square of w t.
    EXPECT_NEAR(std::sqrt(length_squared(s.velocity)) / (k * 0.1 / kMass * dt), 1, 1e-5);
  }
}

}  // namespace
}  // namespace plumb
