#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/world/passages.h"
#include "tests/world/support.h"

/// Tests that bodies which come through a chain from behind fly on, at the vertices between its segments too:
/// contacts let them pass, so continuous collision must. The flight is gravity's parabola.
namespace plumb {
namespace {

using passages::Draw;

template <class Real>
class JumpsThroughChains : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(JumpsThroughChains, Precisions);

constexpr double kStep = 1.0 / 60;

// Returns how far a body is from its parabola, at the most, until it falls.
template <class Real>
double farthest_from_flight(BasicWorld<Real>& world, BodyId body) {
  const Vec2d start = world.centre(body), velocity = {world.velocity(body).x, world.velocity(body).y};
  double farthest = 0;
  for (double time = kStep; velocity.y - kGravity * time > 0; time += kStep) {
    world.step(kStep);
    const Vec2d flown{velocity.x * time, velocity.y * time - 0.5 * kGravity * time * time};
    const Vec2d off = world.centre(body) - start - flown;
    farthest = std::max(farthest, std::hypot(off.x, off.y));
  }
  return farthest;
}

std::vector<ShapeGeometry> jumpers(double size) {
  return {Circle{size / 2}, Box{size, size}, Capsule{{0, -size / 2}, {0, size / 2}, size / 4},
          Polygon{{{-size / 2, -size / 3}, {size / 2, -size / 3}, {0, size / 2}}}};
}

TYPED_TEST(JumpsThroughChains, ABoxPassesAVertexOfAStraightChain) {
  BasicWorld<TypeParam> world;
  world.create_chain(world.create_body({.type = BodyType::Static}), {.points = {{50, 0}, {0, 0}, {-50, 0}}});
  const BodyId box = world.create_body({.position = {0.91, -2.3}, .angle = 1.7, .velocity = {-3, 12}},
                                       {.geometry = Box{1, 1}});
  EXPECT_LT(farthest_from_flight(world, box), 2e-3);
}

// Draws jumps through chains of long and short segments. `bend`: of the vertices, as a part of a segment.
// Returns the worst distance from the parabola, in sizes of the jumper.
template <class Real>
double worst_jump(BodyType type, double bend, int jumps) {
  double worst = 0;
  for (int number = 0; number < jumps; ++number) {
    Draw draw(static_cast<std::uint64_t>(number));
    const double size = draw.spread(0.1, 2), segment = size * draw.spread(0.1, 10), wave = bend * segment;
    BasicWorld<Real> world({.sleeping = false});
    const BodyId rail =
        world.create_body({.type = type, .velocity = {type == BodyType::Static ? 0.0 : draw.even(-1, 1), 0}});
    std::vector<Vec2d> points;
    const int count = std::min(200, static_cast<int>(40 * size / segment) + 4);
    for (int i = count; i >= 0; --i) points.push_back({(i - count / 2) * segment, draw.even(-wave, wave)});
    world.create_chain(rail, {.points = points});
    const double low = -1.1 * size - draw.even(0, 2) * size - wave,
                 rise = std::sqrt(2 * kGravity * (draw.even(3, 6) * size + 0.2 + 2 * wave - low));
    const ShapeGeometry shape = jumpers(size)[static_cast<std::size_t>(draw.choose(4))];
    const BodyId jumper = world.create_body({.position = {0, low},
                                             .angle = draw.even(0, 6),
                                             .velocity = {draw.even(-2, 2) * size, rise},
                                             .angular_velocity = draw.chance(0.5) ? draw.even(-4, 4) : 0},
                                            {.geometry = shape});
    worst = std::max(worst, farthest_from_flight(world, jumper) / size);
  }
  return worst;
}

TYPED_TEST(JumpsThroughChains, AnyBodyFliesOnThroughAStraightOne) {
  EXPECT_LT(worst_jump<TypeParam>(BodyType::Static, 0, 1000), 0.02);
}

TYPED_TEST(JumpsThroughChains, AnyBodyFliesOnThroughAMovingOne) {
  EXPECT_LT(worst_jump<TypeParam>(BodyType::Kinematic, 0, 500), 0.02);
}

TYPED_TEST(JumpsThroughChains, AnyBodyFliesOnThroughABentOne) {
  EXPECT_LT(worst_jump<TypeParam>(BodyType::Static, 0.05, 500), 0.02);
}

// Beside an open end, a body whose middle is behind the segment passes too.
TYPED_TEST(JumpsThroughChains, BodiesPassAnOpenEndFromBehind) {
  double worst = 0;
  for (int number = 0; number < 500; ++number) {
    Draw draw(static_cast<std::uint64_t>(number));
    BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false});
    world.create_chain(world.create_body({.type = BodyType::Static}), {.points = {{0, 0}, {-2, 0}, {-6, 0}}});
    const double speed = draw.even(5, 60);
    const BodyId body = world.create_body({.position = {draw.even(1.5, 3), draw.even(-0.45, -0.2)},
                                           .angle = draw.even(0, 6),
                                           .velocity = {-speed, 0}},
                                          {.geometry = jumpers(1)[static_cast<std::size_t>(draw.choose(4))]});
    const Vec2d start = world.centre(body);
    run(world, 20);
    worst = std::max(worst, std::abs(world.centre(body).x - start.x + speed * 20 * kStep) / speed);
  }
  EXPECT_LT(worst, 1e-5);
}

}  // namespace
}  // namespace plumb
