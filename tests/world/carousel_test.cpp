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

TYPED_TEST(Carousel, ThinRidersDoNotFallThroughTheFloor) {
  for (const double rate : {-8.0, -4.0, 4.0, 8.0}) {
    const Ride ride{Box{0.14, 0.0044}, 0.0022, 0.07, rate};
    EXPECT_LT(sinks<TypeParam>(ride), 0.0022) << rate << " rad/s";
  }
}

}  // namespace
}  // namespace plumb
