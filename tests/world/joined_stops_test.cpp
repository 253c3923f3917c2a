#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/world/support.h"

// Bodies with joints that continuous collision stops within a step, each on a path of its own.
namespace plumb {
namespace {

template <class Real>
class JoinedStops : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(JoinedStops, Reals);

constexpr double kDiscRadius = 0.12;

template <class Real>
void add_room(BasicWorld<Real>& world) {
  const BodyId room = world.create_body({.type = BodyType::Static});
  for (const double side : {-5.1, 5.1}) {
    world.create_shape(room, {.geometry = Box{12, 0.2}, .position = {0, side}});
    world.create_shape(room, {.geometry = Box{0.2, 12}, .position = {side, 0}});
  }
}

// Returns the widest gap of the joints, as a fraction of the length, of two discs that are thrown at 5 to 30
// m/s and 10 to 60 rad/s into a closed room without gravity. They are held by a rod, or by hinges at the ends
// of a bar.
template <class Real>
double widest_gap_of_thrown(std::mt19937& from, bool bar) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(from()) * 0x1p-32);
  };
  const auto along = [](double angle) { return Vec2d{std::cos(angle), std::sin(angle)}; };
  BasicWorld<Real> world({.gravity = {0, 0}});
  add_room(world);
  const double spin = between(10, 60), speed = between(5, 30), size = between(0.6, 1.5),
               angle = between(0, 2 * std::numbers::pi);
  const Vec2d velocity = speed * along(between(0, 2 * std::numbers::pi)), arm = (size / 2) * along(angle);
  BodyId discs[2];
  for (const int side : {0, 1}) {
    const Vec2d at = side == 0 ? arm : Vec2d{} - arm;
    discs[side] = world.create_body(
        {.position = at, .velocity = velocity + spin * Vec2d{-at.y, at.x}, .angular_velocity = spin},
        ShapeDefinition{.geometry = Circle{kDiscRadius}, .material = {.friction = 0.3, .restitution = 0.3}});
  }
  BodyId middle{};
  if (bar) {
    middle = world.create_body({.angle = angle, .velocity = velocity, .angular_velocity = spin},
                               ShapeDefinition{.geometry = Box{size - 2.5 * kDiscRadius, 0.06}});
    for (const int side : {0, 1})
      world.create_joint(middle, discs[side],
                         {.kind = RevoluteDefinition{.anchor_a = {side == 0 ? size / 2 : -size / 2, 0}}});
  } else {
    world.create_joint(discs[0], discs[1], {.kind = DistanceDefinition{.length = size}});
  }
  double widest = 0;
  for (int i = 0; i < 120; ++i) {
    world.step(1.0 / 60, 4);
    const Vec2d a = world.position(discs[0]), b = world.position(discs[1]);
    if (!bar) {
      widest = std::max(widest, std::abs(std::sqrt(length_squared(a - b)) - size));
      continue;
    }
    const Vec2d end = (size / 2) * along(world.angle(middle)), centre = world.position(middle);
    widest = std::max(
        {widest, std::sqrt(length_squared(centre + end - a)), std::sqrt(length_squared(centre - end - b))});
  }
  return widest / size;
}

// Until the time of an impact a body that turns by a within the step moves an anchor off the chord to its
// place at the step's end, by up to r (1 - cos(a / 2)): an eighth of the length at 60 rad/s.
TYPED_TEST(JoinedStops, LeaveTheJointsOfSpinningBodiesClosed) {
  for (const bool bar : {false, true}) {
    std::mt19937 from(5);
    for (int i = 0; i < 150; ++i)
      ASSERT_LT(widest_gap_of_thrown<TypeParam>(from, bar), 0.01) << (bar ? "bar " : "rod ") << i;
  }
}

}  // namespace
}  // namespace plumb
