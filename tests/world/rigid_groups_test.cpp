#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/world.h"

// Boxes that welds join to one rigid body, of which some touch without a joint of their own. Such contacts
// have nothing to carry.
namespace plumb {
namespace {

constexpr double kSize = 0.6;  // m
constexpr double kGravity = 9.80665, kDt = 1.0 / 60;

template <class Real>
struct Wall {
  BasicWorld<Real> world{};
  std::vector<BodyId> boxes{};
  std::vector<JointId> joints{};

  // Joins neighbours of a wall of columns x rows, tilted and lifted by a height above the floor, by welds or
  // by a hinge in the middle of each shared side.
  Wall(int columns, int rows, double tilt, double height, bool hinged = false) {
    world.create_body({.type = BodyType::Static, .position = {0, -5}}, {.geometry = Box{200, 10}});
    const Vec2d along{std::cos(tilt), std::sin(tilt)}, up{-along.y, along.x};
    const double lift = 0.5 * kSize * (std::cos(tilt) + std::abs(std::sin(tilt))) +
                        std::max(-(columns - 1) * kSize * std::sin(tilt), 0.0) + height;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const Vec2d at = Vec2d{0, lift} + kSize * (column * along + row * up);
        boxes.push_back(world.create_body({.position = at, .angle = tilt}, {.geometry = Box{kSize, kSize}}));
      }
    }
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const int i = row * columns + column;
        if (column + 1 < columns) join(i, i + 1, hinged);
        if (row + 1 < rows) join(i, i + columns, hinged);
      }
    }
  }

  void join(int a, int b, bool hinged) {
    const Vec2d middle = 0.5 * (world.position(boxes[a]) + world.position(boxes[b]));
    const Vec2d at_a = world.local_point(boxes[a], middle), at_b = world.local_point(boxes[b], middle);
    const JointKind kind = hinged ? JointKind{RevoluteDefinition{.anchor_a = at_a, .anchor_b = at_b}}
                                  : JointKind{WeldDefinition{.anchor_a = at_a, .anchor_b = at_b}};
    joints.push_back(world.create_joint(boxes[a], boxes[b], {.kind = kind}));
  }

  double weight() const {
    double mass = 0;
    for (const BodyId box : boxes) mass += double(world.mass(box));
    return mass * kGravity;
  }
  double largest_force() const {
    double force = 0;
    for (const JointId joint : joints) force = std::max(force, double(world.read(joint).force));
    return force;
  }
  double energy() const {
    double sum = 0;
    for (const BodyId box : boxes) {
      const double w = world.angular_velocity(box);
      sum += 0.5 * double(world.mass(box)) * length_squared(world.velocity(box)) +
             0.5 * double(world.inertia(box)) * w * w +
             double(world.mass(box)) * kGravity * world.centre(box).y;
    }
    return sum;
  }
};

template <class Real>
class RigidGroups : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(RigidGroups, Reals);

constexpr std::pair<int, int> kWalls[] = {{2, 2}, {3, 2}, {2, 3}, {4, 2}, {3, 3}};

// A wall that a floor stops within a step from a speed v takes its momentum m v, so welds carry at most
// m v / dt and the weight, and at a corner twice that, because the wall also starts to rotate.
TYPED_TEST(RigidGroups, WeldsCarryTheLandingAndTheWeight) {
  for (const auto& [columns, rows] : kWalls) {
    for (int fall = 0; fall < 6; ++fall) {
      const double tilt = -0.05 + 0.02 * fall, height = 0.03 * fall;
      SCOPED_TRACE(std::to_string(columns) + " x " + std::to_string(rows) + ", tilt " + std::to_string(tilt));
      Wall<TypeParam> wall(columns, rows, tilt, height);
      const double drop = height + columns * kSize * std::abs(std::sin(tilt));
      const double speed = std::sqrt(2 * kGravity * drop);
      double landing = 0, rest = 0;
      for (int i = 0; i < 240; ++i) {
        wall.world.step(kDt);
        (i < 120 ? landing : rest) = std::max(i < 120 ? landing : rest, wall.largest_force());
      }
      EXPECT_LT(landing, 2 * wall.weight() * (1 + speed / (kGravity * kDt)));
      EXPECT_LT(rest, 2 * wall.weight());
    }
  }
}

// No energy is stored where the joints were.
TYPED_TEST(RigidGroups, PiecesGainNoEnergyWhenJointsAreDestroyed) {
  for (const bool hinged : {false, true}) {
    for (const auto& [columns, rows] : kWalls) {
      for (const int wait : {0, 1, 8, 60}) {
        SCOPED_TRACE(std::to_string(columns) + " x " + std::to_string(rows) + ", " + std::to_string(wait) +
                     (hinged ? ", hinged" : ""));
        Wall<TypeParam> wall(columns, rows, 0.02, 0.01, hinged);
        for (int i = 0; i < 12 + wait; ++i) wall.world.step(kDt);
        // Gaps of hinges, up to 1 % of a box, leave overlaps that contacts remove in some 4 steps.
        constexpr double kPushedApart = 0.01 * kSize / (4 * kDt);  // m/s
        const double before = wall.energy();
        for (const JointId joint : wall.joints) wall.world.destroy(joint);
        for (int i = 0; i < 10; ++i) {
          wall.world.step(kDt);
          EXPECT_LT(wall.energy() - before, 0.5 * wall.weight() / kGravity * kPushedApart * kPushedApart);
        }
      }
    }
  }
}

}  // namespace
}  // namespace plumb
