#include "engine/world/invariant_monitor.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/world/support.h"

namespace plumb {
namespace {

/// Returns the first violation in `steps` steps.
template <class Real>
std::optional<Error> first_violation(BasicWorld<Real>& world, int steps, double dt = 1.0 / 60,
                                     int substeps = 4) {
  InvariantMonitor<Real> monitor(world);
  for (int i = 0; i < steps; ++i) {
    monitor.begin_step();
    world.step(dt, substeps);
    if (auto error = monitor.end_step()) return error;
  }
  return {};
}

template <class Real>
BasicWorld<Real> stack_of(int boxes, double top_mass) {
  BasicWorld<Real> world({.sleeping = false});
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{40, 2}});
  for (int i = 0; i < boxes; ++i)
    world.create_body({.name = "box " + std::to_string(i),
                       .position = {0, i + 0.5},
                       .mass = MassProperties{i + 1 == boxes ? top_mass : 1, {}, 1.0 / 6}},
                      {.geometry = Box{1, 1}});
  return world;
}

/// A pendulum of one rod of 1 m, released from the horizontal.
template <class Real>
BasicWorld<Real> pendulum(const RevoluteDefinition& hinge = {.anchor_b = {-0.5, 0}}) {
  BasicWorld<Real> world({.sleeping = false});
  const BodyId frame = world.create_body({.type = BodyType::Static});
  const BodyId rod =
      world.create_body({.name = "rod", .position = {0.5, 0}, .mass = MassProperties{1, {}, 1.0 / 12}});
  world.create_joint(frame, rod, {.kind = hinge});
  return world;
}

template <class Real>
class Monitor : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Monitor, Reals);

TYPED_TEST(Monitor, FindsNothingInStacksPendulumsAndBounces) {
  auto stack = stack_of<TypeParam>(10, 1);
  EXPECT_FALSE(first_violation(stack, 300));
  auto swing = pendulum<TypeParam>();
  EXPECT_FALSE(first_violation(swing, 600));
  BasicWorld<TypeParam> bounce({.sleeping = false});
  bounce.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{40, 2}});
  bounce.create_body({.position = {0, 3}}, {.geometry = Circle{0.5}, .material = {.restitution = 1}});
  EXPECT_FALSE(first_violation(bounce, 600));
}

TYPED_TEST(Monitor, NamesTheBodiesThatOverlap) {
  // Static bodies hold a box between them that is wider than their gap.
  BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
  for (const double side : {-1.0, 1.0})
    world.create_body({.type = BodyType::Static, .position = {side, 0}}, {.geometry = Box{1.2, 4}});
  world.create_body({.name = "jammed"}, {.geometry = Box{1, 1}});
  const std::optional<Error> error = first_violation(world, 120);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->field(), "overlap");
  EXPECT_NE(error->subject().find("body 'jammed'"), std::string::npos) << error->subject();
}

TYPED_TEST(Monitor, NamesTheJointThatIsOpen) {
  // Two hinges hold one body at points farther apart than its anchors.
  BasicWorld<TypeParam> world({.sleeping = false});
  const BodyId frame = world.create_body({.type = BodyType::Static});
  const BodyId bar = world.create_body({.name = "bar", .mass = MassProperties{1, {}, 1.0 / 12}});
  for (const double side : {-1.0, 1.0})
    world.create_joint(
        frame, bar, {.kind = RevoluteDefinition{.anchor_a = {0.6 * side, 0}, .anchor_b = {0.5 * side, 0}}});
  const std::optional<Error> error = first_violation(world, 120);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->field(), "gap");
  EXPECT_NE(error->subject().find("body 'bar'"), std::string::npos) << error->subject();
}

TYPED_TEST(Monitor, FindsEnergyThatAStepMakes) {
  // Explicit Euler multiplies the energy of an oscillator by 1 + (w h)^2 each step; the spring's force is
  // applied by hand, so its work is accounted for, and the rest is the method's.
  BasicWorld<TypeParam> world(
      {.gravity = {0, 0}, .sleeping = false, .integrator = Integrator::ExplicitEuler});
  const BodyId mass =
      world.create_body({.name = "mass", .position = {1, 0}, .mass = MassProperties{1, {}, 1}});
  InvariantMonitor<TypeParam> monitor(world);
  std::optional<Error> error;
  for (int i = 0; i < 600 && !error; ++i) {
    world.apply_force(mass, {-100 * world.position(mass).x, 0});
    monitor.begin_step();
    world.step(1.0 / 60, 1);
    error = monitor.end_step();
  }
  ASSERT_TRUE(error);
  EXPECT_EQ(error->field(), "energy");
}

TYPED_TEST(Monitor, SaysNothingOfTheEnergyOfDrives) {
  auto driven = pendulum<TypeParam>({.anchor_b = {-0.5, 0}, .motor = Motor{5, 100}});
  EXPECT_FALSE(first_violation(driven, 300));
}

TYPED_TEST(Monitor, AcceptsTheStateAtAReset) {
  auto world = stack_of<TypeParam>(2, 1);
  InvariantMonitor<TypeParam> monitor(world);
  world.set_position(world.bodies()[2], {0, 1.2}, 0);  // an overlap of 30 %, which dissolves
  monitor.reset();
  for (int i = 0; i < 240; ++i) {
    monitor.begin_step();
    world.step();
    EXPECT_FALSE(monitor.end_step()) << i;
  }
}

}  // namespace
}  // namespace plumb
