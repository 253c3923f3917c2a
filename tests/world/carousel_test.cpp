#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/world/world.h"

// Bodies that ride on the inner side of a wheel: the wheel turns the contact's plane within a step.
namespace plumb {
namespace {

constexpr double kDt = 1.0 / 60, kRadius = 2;
constexpr int kSubsteps = 4;

template <class Real>
class Carousel : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Carousel, Reals);

enum class Drive { Kinematic, FreeWheel, FarAxis };

struct Ride {
  ShapeGeometry passenger;
  double height = 0;  // m, of the passenger's centre above the floor
  double extent = 0;  // m, of its farthest point from its centre
  double rate = 0;    // rad/s
  Drive drive = Drive::Kinematic;
  double friction = 0.5;
};

// Returns the largest distance of the passenger from where it began, across the floor, in 2 s, m.
template <class Real>
double sinks(const Ride& ride) {
  BasicWorld<Real> world({.gravity = {}});
  const Material material{.friction = ride.friction};
  const double out = kRadius - ride.height;
  // Turned about an axis 5 m beside it, the floor moves on a circle, too.
  const Vec2d axis = ride.drive == Drive::FarAxis ? Vec2d{5, 0} : Vec2d{};
  const auto velocity_at = [&](Vec2d at) {
    return Vec2d{-ride.rate * (at.y - axis.y), ride.rate * (at.x - axis.x)};
  };
  BodyDefinition wheel{.type = ride.drive == Drive::FreeWheel ? BodyType::Dynamic : BodyType::Kinematic,
                       .velocity = velocity_at({}),
                       .angular_velocity = ride.rate};
  if (ride.drive == Drive::FreeWheel) wheel.mass = MassProperties{1e6, {}, 4e6};
  std::vector<ShapeDefinition> floors;
  for (const double side : {-1.0, 1.0})
    floors.push_back(
        {.geometry = Box{4, 0.5}, .position = {0, side * (kRadius + 0.25)}, .material = material});
  const BodyId room = world.create_body(wheel, floors);
  const Vec2d start{0, -out};
  const BodyId rider =
      world.create_body({.position = start, .velocity = velocity_at(start), .angular_velocity = ride.rate},
                        ShapeDefinition{.geometry = ride.passenger, .density = 1000, .material = material});
  double most = 0;
  for (int step = 0; step < 120; ++step) {
    world.step(kDt, kSubsteps);
    const double angle = world.angle(room);
    const Vec2d d = world.position(rider) - world.position(room);
    most = std::max(most, std::abs(-std::sin(angle) * d.x + std::cos(angle) * d.y + out));
  }
  return most;
}

// A load of acceleration g sinks by at most g h^2 at rest, h the substep, and manifolds are recycled until
// their shapes have moved by 0.002 of the smaller one's extent (docs/limits.md).
double allowed(const Ride& ride) {
  const double substep = kDt / kSubsteps, distance = kRadius + (ride.drive == Drive::FarAxis ? 5 : 0);
  return ride.rate * ride.rate * distance * substep * substep + 0.002 * ride.extent;
}

TYPED_TEST(Carousel, RidersNeitherSinkNorRise) {
  for (const double rate : {-4.0, -1.0, 0.5, 1.0, 2.0, 4.0}) {
    for (const Drive drive : {Drive::Kinematic, Drive::FreeWheel, Drive::FarAxis}) {
      for (const Ride& ride :
           {Ride{Box{0.14, 0.05}, 0.025, 0.074, rate, drive}, Ride{Box{0.14, 0.2}, 0.1, 0.122, rate, drive},
            Ride{Box{0.6, 0.2}, 0.1, 0.316, rate, drive},
            Ride{Capsule{{-0.1, 0}, {0.1, 0}, 0.05}, 0.05, 0.15, rate, drive}}) {
        EXPECT_LT(sinks<TypeParam>(ride), allowed(ride))
            << ride.height << " m above the floor, " << rate << " rad/s, drive " << static_cast<int>(drive);
      }
    }
  }
}

// A box that is created on a turning plate, from touching it to 0.1 mm above it, moves along with it. A
// contact whose plane is that of a step's start would let it sink by r x^2 / 2 in each step, x the rotation
// in it.
TYPED_TEST(Carousel, WhatIsCreatedOnATurningPlateRidesFromTheFirstStepOn) {
  constexpr double kFloor = 4.8, kSize = 0.5;
  for (const double rate : {-6.0, 1.0, 6.0}) {
    for (const double dt : {1 / 60.0, 1 / 240.0}) {
      for (const double gap : {0.0, 1e-6, 1e-4}) {
        for (const double gravity : {0.0, 9.81}) {
          BasicWorld<TypeParam> world({.gravity = {0, -gravity}});
          const BodyId plate = world.create_body(
              {.type = BodyType::Kinematic, .angular_velocity = rate},
              ShapeDefinition{.geometry = Box{3.2, 0.4}, .position = {0, -5}, .material = {.friction = 1}});
          const double out = kFloor - kSize / 2 - gap, x = rate * dt;
          const BodyId box = world.create_body(
              {.position = {0, -out}, .velocity = {rate * out, 0}, .angular_velocity = rate},
              ShapeDefinition{.geometry = Box{kSize, kSize}, .material = {.friction = 1}});
          double deepest = 0;
          for (double turned = 0; turned < 1; turned += std::abs(x)) {
            world.step(dt);
            const double angle = world.angle(plate);
            const Vec2d at = world.position(box);
            deepest = std::max(deepest, std::sin(angle) * at.x - std::cos(angle) * at.y + kSize / 2 - kFloor);
          }
          EXPECT_LT(deepest, 0.5 * out * x * x)
              << rate << " rad/s, dt " << dt << ", gap " << gap << ", gravity " << gravity;
        }
      }
    }
  }
}

TYPED_TEST(Carousel, ThinRidersDoNotFallThroughTheFloor) {
  for (const double rate : {-8.0, -4.0, 4.0, 8.0}) {
    const Ride ride{Box{0.14, 0.0044}, 0.0022, 0.07, rate};
    EXPECT_LT(sinks<TypeParam>(ride), 0.0022) << rate << " rad/s";
  }
}

// A body on a smooth arm that turns at w slides outwards as s = s0 cosh(w t) and stays on the arm: it needs
// the force 2 m w ds/dt. It begins there with the speed at which it does not lift off first: ds/dt > w h / 2.
TYPED_TEST(Carousel, WhatSlidesAlongATurningArmStaysOnIt) {
  constexpr double kRate = 2, kHeight = 0.1, kStart = 0.5, kTime = 1.5;
  const Material smooth{.friction = 0};
  for (const ShapeGeometry& passenger : {ShapeGeometry{Box{0.2, 0.2}}, ShapeGeometry{Circle{0.1}}}) {
    BasicWorld<TypeParam> world({.gravity = {}});
    const BodyId arm = world.create_body(
        {.type = BodyType::Kinematic, .angular_velocity = kRate},
        ShapeDefinition{.geometry = Box{40, 0.1}, .position = {0, -0.05}, .material = smooth});
    // s = s0 cosh(w t) + (u / w) sinh(w t) with u = w h.
    const double u = kRate * kHeight;
    const BodyId rider =
        world.create_body({.position = {kStart, kHeight},
                           .velocity = {u - kRate * kHeight, kRate * kStart},
                           .angular_velocity = kRate},
                          ShapeDefinition{.geometry = passenger, .density = 1000, .material = smooth});
    double most = 0;
    const int steps = static_cast<int>(std::lround(kTime / kDt));
    for (int step = 0; step < steps; ++step) {
      world.step(kDt, kSubsteps);
      const double angle = world.angle(arm);
      const Vec2d at = world.position(rider);
      most = std::max(most, std::abs(-std::sin(angle) * at.x + std::cos(angle) * at.y - kHeight));
    }
    const double angle = world.angle(arm), x = kRate * kTime;
    const Vec2d at = world.position(rider);
    const double exact = kStart * std::cosh(x) + u / kRate * std::sinh(x);
    // The force grows to 2 w ds/dt = 43 m/s^2, which sinks the body by at most a h^2 (0.75 mm), and by twice
    // that where it is still found at the start of a step.
    EXPECT_LT(most, 2 * 2 * kRate * kRate * exact * kDt * kDt / kSubsteps / kSubsteps);
    // Velocities that lag by half a step: 1 - exp(-w dt) of the distance.
    EXPECT_NEAR(std::cos(angle) * at.x + std::sin(angle) * at.y, exact, kRate * kDt * exact);
  }
}

}  // namespace
}  // namespace plumb
