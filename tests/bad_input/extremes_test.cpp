// Tries values that are valid by themselves at their extremes together: refused with a reason, or in motion
// with finite states.
#include <gtest/gtest.h>

#include "tests/bad_input/refusal.h"

namespace plumb::bad_input {
namespace {

constexpr double kSmall = 1e-12, kLarge = 1e12;

std::vector<ShapeGeometry> geometries(double a, double b) {
  return {Circle{a},
          Box{a, b},
          Capsule{{-a, 0}, {a, 0}, b},
          Polygon{{{0, 0}, {a, 0}, {0, b}}, 0},
          Polygon{{{0, 0}, {a, 0}, {0, a}}, b},
          Segment{{0, 0}, {a, b}}};
}

template <class Real>
class ValidExtremes : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ValidExtremes, Reals);

/// Refused before anything changed, or done.
template <class Real, class Run>
bool done(BasicWorld<Real>& world, Run&& run) {
  const std::vector<std::byte> before = save(world);
  try {
    run();
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value) << error.what();
    EXPECT_TRUE(save(world) == before) << "something has changed: " << error.what();
    return false;
  }
}

TYPED_TEST(ValidExtremes, OfShapesWithTheirDensities) {
  int moved = 0, refused = 0;
  for (const double a : {kSmall, 1.0, kLarge}) {
    for (const double b : {kSmall, 1.0, kLarge}) {
      for (const ShapeGeometry& geometry : geometries(a, b)) {
        for (const double density : {0.0, kSmall, 1.0, kLarge}) {
          for (const double away : {0.0, kLarge}) {
            SCOPED_TRACE(testing::Message() << geometry.index() << " of " << a << " and " << b << " with "
                                            << density << " at " << away);
            BasicWorld<TypeParam> world;
            world.create_body({.type = BodyType::Static}, ShapeDefinition{.geometry = Box{10, 1}});
            const ShapeDefinition shape{.geometry = geometry, .position = {away, 0}, .density = density};
            BodyId body;
            const bool made = done(world, [&] {
              body =
                  world.create_body({.position = {0, 2}, .velocity = {1, -1}, .angular_velocity = 1}, shape);
            });
            (made ? moved : refused) += 1;
            expect_finite_steps(world);
            // By way of a static body, which may weigh anything.
            BasicWorld<TypeParam> other;
            BodyId still;
            if (!done(other, [&] { still = other.create_body({.type = BodyType::Static}, shape); })) {
              EXPECT_FALSE(made);  // a polygon as thin as a line
              continue;
            }
            expect_finite_steps(other);
            done(other, [&] { other.set_type(still, BodyType::Dynamic); });
            expect_finite_steps(other);
            const BodyId late = other.create_body({.position = {0, 5}});
            EXPECT_EQ(done(other, [&] { other.create_shape(late, shape); }), made);
            const BodyId given = other.create_body({.position = {9, 5}, .mass = MassProperties{}}, shape);
            done(other, [&] { other.use_densities(given); });
            expect_finite_steps(other);
          }
        }
      }
    }
  }
  EXPECT_GT(moved, 200);
  EXPECT_GT(refused, (std::is_same_v<TypeParam, float> ? 50 : 0));
}

TYPED_TEST(ValidExtremes, OfMotionAndMass) {
  for (const double mass : {kSmall, kLarge}) {
    for (const double inertia : {kSmall, kLarge}) {
      for (const double speed : {-kLarge, 0.0, kLarge}) {
        for (const double spin : {-kLarge, kLarge}) {
          for (const double size : {kSmall, 1.0, kLarge}) {
            BasicWorld<TypeParam> world;
            world.create_body({.type = BodyType::Static}, ShapeDefinition{.geometry = Box{10, 1}});
            world.create_body({.position = {0, 3},
                               .velocity = {speed, -speed},
                               .angular_velocity = spin,
                               .mass = MassProperties{mass, {0.25, 0}, inertia}},
                              ShapeDefinition{.geometry = Box{size, 1}, .material = {.friction = kLarge}});
            world.create_body({.position = {0.5, 3}}, ShapeDefinition{});
            expect_finite_steps(world);
          }
        }
      }
    }
  }
}

// Nothing has changed when what follows from the arguments is beyond what a world takes.
TYPED_TEST(ValidExtremes, OfMovingThere) {
  BasicWorld<TypeParam> world;
  const BodyId lift = world.create_body({.type = BodyType::Kinematic}, ShapeDefinition{});
  expect_refused(world, {"body 0", "angular_velocity", "5e+12"}, [&] {
    world.move_towards(lift, {0.5, 0}, 5, 1e-12);
  });
}

}  // namespace
}  // namespace plumb::bad_input
