#include <gtest/gtest.h>

#include <cmath>

#include "tests/world/support.h"

// A wedge on wheels is pushed under a pin that slides up and down in a guide. With the slope s and friction
// mu the contact force points A = atan(s) + atan(mu) away from the vertical: from 90 degrees on the wedge is
// self-locking, and close to it a small error of the friction's direction decides over the whole load.
namespace plumb {
namespace {

constexpr double kGravity = 9.81, kRadius = 0.3;

struct Wedge {
  double slope, friction;
  // tan(A)
  double leverage() const { return (slope + friction) / (1 - slope * friction); }
};

// Slopes and friction for which A is 60 to 84 degrees.
constexpr Wedge kWedges[] = {{0.4, 1.0}, {0.5, 1.2}, {0.726, 0.9}, {0.726, 1.0},
                             {1.0, 0.6}, {1.0, 0.8}, {0.4, 1.5}};

template <class Real>
struct Lift {
  Lift(const Wedge& wedge, const BodyDefinition& of_wedge, const WorldDefinition& definition)
      : world(definition),
        ground(world.create_body({.type = BodyType::Static})),
        body(world.create_body(of_wedge,
                               {.geometry = Polygon{{{0, 0}, {10, 10 * wedge.slope}, {10, -1}, {0, -1}}},
                                .material = {.friction = wedge.friction}})),
        pin(world.create_body({.position = {1, wedge.slope + kRadius * std::hypot(1, wedge.slope)},
                               .velocity = {0, -of_wedge.velocity.x * wedge.slope},
                               .may_sleep = false},
                              {.geometry = Circle{kRadius}, .material = {.friction = wedge.friction}})),
        guide(world.create_joint(ground, pin,
                                 {.kind = PrismaticDefinition{.anchor_a = {1, 0}, .axis = {0, 1}}})) {}

  BasicWorld<Real> world;
  BodyId ground, body, pin;
  JointId guide;
};

template <class Real>
class WedgeLift : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(WedgeLift, Precisions);

// The pin goes up at the wedge's speed times its slope, reports that velocity, and presses against its guide
// with m g tan(A).
TYPED_TEST(WedgeLift, CarriesAPinAtTheSpeedOfItsSlope) {
  constexpr double kSpeed = 0.34;
  for (const Solver solver : {Solver::SoftSteps, Solver::Direct}) {
    for (const Wedge& wedge : kWedges) {
      SCOPED_TRACE(testing::Message() << "slope " << wedge.slope << " friction " << wedge.friction);
      Lift<TypeParam> lift(wedge, {.type = BodyType::Kinematic, .velocity = {-kSpeed, 0}},
                           {.solver = solver});
      const double start = lift.world.position(lift.pin).y,
                   load = lift.world.mass(lift.pin) * kGravity * wedge.leverage();
      double sum = 0;
      for (int i = 1; i <= 180; ++i) {
        lift.world.step();
        EXPECT_NEAR(lift.world.position(lift.pin).y - start, kSpeed * wedge.slope * i / 60, 2e-3) << i;
        if (i < 10) continue;  // its load comes upon the wedge
        EXPECT_NEAR(lift.world.velocity(lift.pin).y, kSpeed * wedge.slope, 0.05 * kSpeed) << i;
        sum += lift.world.read(lift.guide).force / 171;
      }
      EXPECT_NEAR(sum, load, 0.02 * load);
    }
  }
}

// The wedge (M) is pushed with a force F along: M a = F - m (g + s a) tan(A).
TYPED_TEST(WedgeLift, AcceleratesByWhatTheLoadLeavesOfItsForce) {
  for (const Wedge& wedge : kWedges) {
    SCOPED_TRACE(testing::Message() << "slope " << wedge.slope << " friction " << wedge.friction);
    Lift<TypeParam> lift(wedge, {.velocity = {-0.1, 0}, .may_sleep = false}, {});
    lift.world.create_joint(lift.ground, lift.body, {.kind = PrismaticDefinition{}});
    const double wedge_mass = lift.world.mass(lift.body), mass = lift.world.mass(lift.pin),
                 force = 2 * mass * kGravity * wedge.leverage(),
                 acceleration = (force - mass * kGravity * wedge.leverage()) /
                                (wedge_mass + mass * wedge.slope * wedge.leverage());
    for (int i = 0; i < 120; ++i) {
      lift.world.apply_force(lift.body, {-force, 0});
      lift.world.step();
    }
    const double speed = 0.1 + 2 * acceleration;
    EXPECT_NEAR(-lift.world.velocity(lift.body).x, speed, 0.03 * speed);
    EXPECT_NEAR(lift.world.velocity(lift.pin).y, speed * wedge.slope, 0.05 * speed);
  }
}

}  // namespace
}  // namespace plumb
