#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/world/mover.h"
#include "engine/world/queries.h"
#include "tests/world/mover_scene.h"

namespace plumb {
namespace {

constexpr double kStart = 2;  // m, where the first step begins
constexpr int kSteps = 12;

// Stairs to the right of x = kStart on a floor, or to the left of -kStart.
struct Stairs {
  double radius, length, height, depth;
  double side = 1;

  double skin() const { return radius / 50; }
  double top() const { return kSteps * height; }
  // Far enough beyond the last step for the whole capsule to stand on it.
  double end() const { return kStart + kSteps * depth + 1; }
  Capsule person() const { return {{0, radius}, {0, radius + length}, radius}; }
  Vec2d at(double along, double feet) const { return {side * along, feet + skin()}; }
};

template <class Real>
class MoverOnStairs : public testing::Test {
 protected:
  // The edges of steps count as slopes of up to 6 degrees (cosine 0.995), on which its speed is along the
  // slope. On each edge, they are less wide than a tenth of the radius.
  static double way_lost(const Stairs& stairs) { return kSteps * 0.005 * 0.2 * stairs.radius + 1e-3; }

  void build(const Stairs& stairs) {
    world = BasicWorld<Real>();
    const BodyId fixed = world.create_body({.type = BodyType::Static});
    world.create_shape(fixed, {.geometry = Box{200, 2}, .position = {0, -1}});
    for (int i = 0; i < kSteps && stairs.height > 0; ++i) {
      const double middle = stairs.height * (i + 0.5);
      world.create_shape(fixed, {.geometry = Box{100, stairs.height},
                                 .position = {stairs.side * (kStart + i * stairs.depth + 50), middle}});
    }
  }
  // Moves by `way` in equal moves of about `piece` m, and checks each.
  MoverResult run(const Stairs& stairs, Vec2d from, double way, double piece) {
    const int moves = static_cast<int>(std::ceil(std::abs(way) / piece));
    MoverResult now{.position = from};
    now.on_ground = true;
    for (int i = 0; i < moves; ++i) {
      now.velocity.x = stairs.side * way / (moves * kDt);
      now.velocity.y -= kGravity * kDt;
      now = move(world, stairs.person(), now.position, now.velocity, kDt, {.step_height = 0.3});
      EXPECT_TRUE(now.on_ground) << "move " << i;
      bool overlaps = false;
      overlap_shape(world, stairs.person(), now.position, 0, {}, [&](ShapeId) { return !(overlaps = true); });
      EXPECT_FALSE(overlaps) << "move " << i;
    }
    return now;
  }
  void expect_at(Vec2d found, Vec2d expected, double way_lost) {
    EXPECT_NEAR(found.x, expected.x, way_lost);
    EXPECT_NEAR(found.y, expected.y, 2e-6 * (1 + expected.y));
  }

  BasicWorld<Real> world;
};

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(MoverOnStairs, Reals);

TYPED_TEST(MoverOnStairs, ClimbsAndDescendsAsManyStepsInAMoveAsItsSpeedNeeds) {
  for (const double radius : {0.05, 0.2, 0.3, 0.5})
    for (const double length : {0.0, 1.2})
      for (const double height : {0.1, 0.2, 0.25})
        for (const double depth : {0.3, 0.5, 1.0})
          for (const double side : {1.0, -1.0}) {
            const Stairs stairs{radius, length, height, depth, side};
            // The round end must not touch the next step before it stands on one.
            if (radius == 0.5 && height == 0.25 && depth == 0.3) continue;
            this->build(stairs);
            for (const double piece : {0.06, 0.27, 0.5, 1.1, 4.0, 20.0}) {
              SCOPED_TRACE(testing::Message() << "radius " << radius << " length " << length << " steps "
                                              << height << " x " << depth << " piece " << piece);
              const double end = stairs.end(), lost = this->way_lost(stairs);
              const MoverResult up = this->run(stairs, stairs.at(0, 0), end, piece);
              this->expect_at(up.position, stairs.at(end, stairs.top()), lost);
              const MoverResult down = this->run(stairs, stairs.at(end, stairs.top()), -end, piece);
              this->expect_at(down.position, stairs.at(0, 0), lost);
            }
          }
}

TYPED_TEST(MoverOnStairs, RunsOverSlopesBetweenSteps) {
  // A ramp on a kerb, then a step, a landing and a second ramp.
  const Stairs flat{0.3, 1.2, 0, 1};
  for (const Vec2d ramp : {Vec2d{2.4, 1}, Vec2d{2, 1.5}}) {
    const double x = kStart + ramp.x, y = 0.2 + ramp.y, far = x + 1.6 + ramp.x, top = y + 0.2 + ramp.y;
    const Vec2d surface[] = {{kStart, 0.2}, {x, y}, {x, y + 0.2}, {x + 1.6, y + 0.2}, {far, top}, {40, top}};
    this->build(flat);
    const BodyId fixed = this->world.create_body({.type = BodyType::Static});
    for (int i = 0; i + 1 < 6; ++i) {
      const Vec2d a = surface[i], b = surface[i + 1];
      if (a.x < b.x) this->world.create_shape(fixed, {.geometry = Polygon{{{a.x, -1}, {b.x, -1}, b, a}}});
    }
    for (const double piece : {0.06, 0.27, 0.5, 1.1, 4.0, 14.0}) {
      SCOPED_TRACE(testing::Message() << "ramp " << ramp.x << " x " << ramp.y << " piece " << piece);
      // The speed is along the ramps. At each of four bends and two steps, it leaves a slope or meets it up
      // to a radius early.
      const double hypotenuse = std::sqrt(length_squared(ramp)), way = 14 + 2 * (hypotenuse - ramp.x);
      const double bends = 6 * flat.radius * (1 - ramp.x / hypotenuse);
      const MoverResult up = this->run(flat, flat.at(0, 0), way, piece);
      this->expect_at(up.position, flat.at(14, top), bends);
      const MoverResult down = this->run(flat, flat.at(14, top), -way, piece);
      this->expect_at(down.position, flat.at(0, 0), bends);
    }
  }
}

TYPED_TEST(MoverOnStairs, StopsAtAWallOnStairsAtAnySpeed) {
  for (const double wall : {0.31, 0.4, 0.59, 0.61, 3.0})
    for (const double piece : {0.06, 0.27, 0.5, 1.1, 4.0, 20.0}) {
      SCOPED_TRACE(testing::Message() << wall << ' ' << piece);
      const Stairs stairs{0.3, 1.2, 0.2, 0.3};
      this->build(stairs);
      const double from = stairs.end() + 1;
      const BodyId body = this->world.create_body({.type = BodyType::Static});
      this->world.create_shape(
          body, {.geometry = Box{5, 10 + wall}, .position = {from + 2.5, stairs.top() + wall / 2 - 5}});
      const MoverResult end = this->run(stairs, stairs.at(0, 0), 20, piece);
      EXPECT_NEAR(end.position.y, stairs.top() + stairs.skin(), 1e-5);
      // A wall lower than the round end's middle is touched at its edge.
      const double reach = stairs.radius + stairs.skin(), below = std::max(0.0, reach - wall);
      EXPECT_NEAR(end.position.x, from - std::sqrt(reach * reach - below * below), stairs.skin() / 2);
    }
}

TYPED_TEST(MoverOnStairs, FliesOffALedgeFromTheHeightOfTheLedge) {
  // Faster than its radius in a move, it is nowhere near the edge when it has left.
  const Stairs stairs{0.3, 1.2, 0.2, 0.3};
  this->build(stairs);
  const BodyId body = this->world.create_body({.type = BodyType::Static});
  this->world.create_shape(body, {.geometry = Box{4, 20}, .position = {-20, 0}});
  for (const double piece : {0.6, 1.1, 2.5}) {
    SCOPED_TRACE(piece);
    const double speed = piece / kDt;
    const MoverResult off =
        move(this->world, stairs.person(), {-18.2, 10 + stairs.skin()}, {speed, -kGravity * kDt}, kDt, {});
    EXPECT_FALSE(off.on_ground);
    EXPECT_NEAR(off.position.x, -18.2 + piece, 1e-9);
    EXPECT_NEAR(off.position.y, 10 + stairs.skin(), 1e-9);
    EXPECT_EQ(off.velocity.x, speed);
  }
}

}  // namespace
}  // namespace plumb
