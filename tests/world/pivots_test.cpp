#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/world/support.h"

// Contacts whose geometry turns: blocks over a corner, a disc that slides off another.
namespace plumb {
namespace {

template <class Real>
class Pivots : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Pivots, Reals);

constexpr double kWidth = 0.2, kHeight = 0.8;  // m, of a block that rocks

/// A block of kWidth by kHeight that rocks from corner to corner, let go at a share of its tipping angle.
template <class Real>
struct Rocking {
  const double alpha = std::atan(kWidth / kHeight), reach = std::hypot(kWidth, kHeight) / 2;
  const double mass = kWidth * kHeight, inertia = mass * (kWidth * kWidth + kHeight * kHeight) / 12;
  BasicWorld<Real> world{without_sleep()};
  BodyId block{};

  explicit Rocking(double share) {
    add_ground(world, {.friction = 0.8});
    const double tilt = share * alpha, lean = alpha - tilt;
    block = world.create_body({.position = {-reach * std::sin(lean), reach * std::cos(lean)}, .angle = -tilt},
                              {.geometry = Box{kWidth, kHeight}, .material = {.friction = 0.8}});
  }
  /// Energy above that of the block upright at rest, J.
  double energy() const {
    const Vec2d v = world.velocity(block);
    const double w = world.angular_velocity(block), height = world.position(block).y - kHeight / 2;
    return 0.5 * mass * dot(v, v) + 0.5 * inertia * w * w + mass * kGravity * height;
  }
  double other_corner() const { return world.world_point(block, {-kWidth / 2, -kHeight / 2}).y; }
};

// A velocity along the arm at one step's middle is not along it at the next one's: the difference, w dt, is
// lost squared. The block's energy falls by no more than the turned angle times the largest w dt, here 0.16
// times 0.9 / 240, and by twice 1 mrad, by which the arms of a kept manifold lag, for each radian turned.
TYPED_TEST(Pivots, ABlockThatFallsBackOverItsCornerKeepsItsEnergy) {
  for (const double share : {0.4, 0.6, 0.8}) {
    Rocking<TypeParam> rocking(share);
    const double before = rocking.energy();
    for (int i = 0; i < 600 && rocking.other_corner() > 0.01; ++i) rocking.world.step(1.0 / 240);
    ASSERT_LE(rocking.other_corner(), 0.01);
    EXPECT_NEAR(rocking.energy() / before, 1, 4e-3) << share;
  }
}

// Housner, Bull. Seismol. Soc. Am. 53 (1963) 403: angular momentum about the corner that strikes is kept, so
// that the change of corner leaves (1 - 1.5 sin(alpha)^2)^2 of the energy of motion. It happens somewhere in
// a substep h. In that, the other corner bears up to the weight, which turns the block about the one that
// strikes: w is uncertain by g h b / (4/3 r^2), and energy by twice the fraction of w.
TYPED_TEST(Pivots, AChangeOfCornerLeavesWhatHousnerSays) {
  constexpr double kDt = 1.0 / 960, kSubstep = kDt / 4;
  for (const double share : {0.4, 0.5, 0.6, 0.7, 0.8}) {
    Rocking<TypeParam> rocking(share);
    double before = 0, spin = 0;
    for (int i = 0; i < 2000 && rocking.other_corner() > 1e-3; ++i) {
      rocking.world.step(kDt);
      before = rocking.energy(), spin = std::abs(rocking.world.angular_velocity(rocking.block));
    }
    for (int i = 0; i < 10; ++i) rocking.world.step(kDt);
    const double kept = std::pow(1 - 1.5 * std::pow(std::sin(rocking.alpha), 2), 2);
    const double doubt = 2 * kGravity * kSubstep * kWidth / (4 * rocking.reach * rocking.reach / 3 * spin);
    EXPECT_NEAR(rocking.energy() / before, kept, doubt) << share;
  }
}

// Statics: it stands iff tan(tilt) <= width/height. With high friction its first load is far below the limit
// of friction, and must not turn it all the same.
TYPED_TEST(Pivots, ABlockNearItsTippingAngleStands) {
  for (const double friction : {0.5, 2.0, 10.0}) {
    BasicWorld<TypeParam> world(without_sleep());
    const double tilt = std::atan(0.4 * 0.99);
    const Vec2d up{std::sin(tilt), std::cos(tilt)};
    const Material material{.friction = friction};
    world.create_body({.type = BodyType::Static, .position = -1.0 * up, .angle = -tilt},
                      {.geometry = Box{20, 2}, .material = material});
    const BodyId block = world.create_body({.position = 0.5 * up, .angle = -tilt},
                                           {.geometry = Box{0.4, 1}, .material = material});
    run(world, 120);
    // Contacts give way by some tenths of g h^2 under a load that comes at once.
    EXPECT_NEAR(world.angle(block), -tilt, 9.81 / 240 / 240 / 0.4) << friction;
    EXPECT_NEAR(world.angular_velocity(block), 0, 1e-5) << friction;
  }
}

// Euler: it turns about its lower corner like a pendulum, 4/3 rho^2 psi'' = -g rho cos(psi), from rest, here
// by small steps. Its other corner is still near the slope, and must bear no friction. The weight's lever
// grows from 10 to 30 mm; arms of a kept manifold lag by up to 2 mrad of 0.5 m, half of that in the mean: 2 %
// of it.
TYPED_TEST(Pivots, ABlockBeyondItsTippingAngleTurnsLikeAPendulum) {
  constexpr double kTime = 0.4;
  const double tilt = std::atan(0.4 * 1.05), rho = std::hypot(0.4, 1.0) / 2;
  double angle = std::atan2(1, -0.4) - tilt, rate = 0;
  constexpr int kParts = 100000;
  for (int i = 0; i < kParts; ++i) {
    const double h = kTime / kParts, middle = angle + 0.5 * h * rate;
    rate -= h * kGravity * 3 / 4 / rho * std::cos(middle);
    angle = middle + 0.5 * h * rate;
  }
  BasicWorld<TypeParam> world(without_sleep());
  const Vec2d up{std::sin(tilt), std::cos(tilt)};
  const Material rough{.friction = 2};
  world.create_body({.type = BodyType::Static, .position = -1.0 * up, .angle = -tilt},
                    {.geometry = Box{20, 2}, .material = rough});
  const BodyId block =
      world.create_body({.position = 0.5 * up, .angle = -tilt}, {.geometry = Box{0.4, 1}, .material = rough});
  run(world, 24);
  EXPECT_NEAR(world.angular_velocity(block) / rate, 1, 0.02);
}

// Without friction l a'' = g sin(a) until the disc leaves at cos(a) = (2/3) cos(a0), integrated here by small
// steps. A normal that stood still at the start of each step would push up to a twentieth of a radian
// askew: 8 mm.
TYPED_TEST(Pivots, ADiscSlidesOffAnotherAlongItsPath) {
  constexpr double kReach = 1.25, kFrom = 0.3, kTime = 0.6;
  double angle = kFrom, rate = 0;
  constexpr int kParts = 100000;
  for (int i = 0; i < kParts; ++i) {
    const double h = kTime / kParts, middle = angle + 0.5 * h * rate;
    rate += h * kGravity / kReach * std::sin(middle);
    angle = middle + 0.5 * h * rate;
  }
  ASSERT_GT(std::cos(angle), 2.0 / 3 * std::cos(kFrom));
  BasicWorld<TypeParam> world(without_sleep());
  const Material smooth{.friction = 0};
  world.create_body({.type = BodyType::Static}, {.geometry = Circle{1}, .material = smooth});
  const BodyId disc = add_body(world, {kReach * std::sin(kFrom), kReach * std::cos(kFrom)},
                               {.geometry = Circle{0.25}, .material = smooth});
  run(world, 36, 1.0 / 60, 32);
  const Vec2d there{kReach * std::sin(angle), kReach * std::cos(angle)};
  EXPECT_LT(length(world.position(disc) - there), 2e-3);
}

/// A rod of 12 m and 10 g that leans across the edge of a table, and a box of 10 kg that falls on its upper
/// end.
template <class Real>
struct BoxOnRod {
  static constexpr double kLength = 12, kAbove = 0.01;  // m; kAbove: of the box over the rod
  BasicWorld<Real> world{{.gravity = {0, -10}}};
  BodyId box{};
  double end = 0;  // m, height of the rod's upper end

  // `slope` in rad; `beyond`: of the rod's centre, past the edge, m.
  BoxOnRod(double thickness, double slope, double beyond, double speed) {
    const Material smooth{.friction = 0};
    world.create_body({.type = BodyType::Static, .position = {-5, -5}},
                      {.geometry = Box{10, 10}, .material = smooth});
    const Vec2d along{std::cos(slope), -std::sin(slope)}, up{std::sin(slope), std::cos(slope)};
    const Vec2d centre = beyond * along + 0.5 * thickness * up;
    world.create_body(
        {.position = centre, .angle = -slope},
        {.geometry = Box{kLength, thickness}, .density = 0.01 / (kLength * thickness), .material = smooth});
    const Vec2d tip = centre - 0.5 * kLength * along + 0.5 * thickness * up;
    end = tip.y;
    box = world.create_body({.position = {tip.x - 0.5, end + 1 + kAbove}, .velocity = {0, -speed}},
                            {.geometry = Box{4, 2}, .density = 10.0 / 8, .material = smooth});
  }
};

// The rod turns on the edge by 0.2 to 0.5 rad a step, so that its middle leaves the straight path by up to
// several hundred times its thickness. It has at most a quarter of its mass where the box pushes it, which is
// 0.03 % of the box's: the box falls freely until the rod lies on the table, within g dt h of the velocity
// (0.1 m/s at 50 m/s), and comes to rest on the table.
TYPED_TEST(Pivots, ABoxThatFallsOnARodAcrossAnEdgeTurnsItAndFallsOn) {
  constexpr double kStep = 1.0 / 30;
  for (const double thickness : {0.1, 0.02, 0.004, 0.001})
    for (const double speed : {50.0, 60.0, 80.0})
      for (const double slope : {0.5, 0.8, 1.0})
        for (const double beyond : {-0.8, 0.0, 0.8}) {
          BoxOnRod<TypeParam> scene(thickness, slope, beyond, speed);
          const double start = scene.world.position(scene.box).y;
          const auto fallen = [&](int steps) {
            const double time = steps * kStep;
            return speed * time + 5 * time * time;
          };
          int steps = 0;
          for (; fallen(steps + 1) < 0.7 * scene.end; ++steps) scene.world.step(kStep, 2);
          if (steps > 0) {
            EXPECT_NEAR((start - scene.world.position(scene.box).y) / fallen(steps), 1, 0.003)
                << thickness << " m, " << speed << " m/s, " << slope << " rad, " << beyond << " m";
          }
          run(scene.world, 30 - steps, kStep, 2);
          EXPECT_NEAR(scene.world.position(scene.box).y, 1, 2 * thickness + 0.005)
              << thickness << " m, " << speed << " m/s, " << slope << " rad, " << beyond << " m";
        }
}

}  // namespace
}  // namespace plumb
