// Rows that contradict each other, as the direct solver of contacts meets them.
#include "engine/world/joint_solver/direct_rows.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb {
namespace {

constexpr float kPush = 3;  // m/s

/// A body of 1 kg that falls with `speed` onto a ground, and is pushed by a wall on its left and, unless
/// `free`, by one on its right.
struct Squeeze {
  Squeeze(float speed, bool free) {
    bodies[1].inverse_mass = 1, bodies[1].inverse_inertia = 6;
    bodies[1].velocity = {0, -speed};
    add({1, 0}, -kPush);
    if (!free) add({-1, 0}, -kPush);
    add({0, 1}, 0);
    system.order(bodies);
    system.assemble(bodies);
  }

  void add(Vec2<float> normal, float bias) {
    DirectRow<float> row;
    row.a = 0, row.b = 1;
    row.linear_a = -normal, row.linear_b = normal;
    row.bias = bias;
    row.impulse = &impulses[system.rows.size()];
    row.unilateral = true;
    row.block = static_cast<int>(system.rows.size());
    system.rows.push_back(row);
  }

  SolverBody<float> bodies[2];
  float impulses[3] = {};
  DirectRows<float> system;
};

TEST(DirectRows, ContradictionsAreSeenBesideAnImpact) {
  for (const float speed : {0.0f, 30.0f, 3000.0f}) {
    Squeeze squeezed(speed, false);
    EXPECT_FALSE(squeezed.system.solve_impulses(squeezed.bodies, true)) << speed;
    EXPECT_TRUE(squeezed.system.is_infeasible()) << speed;
    Squeeze pushed(speed, true);
    ASSERT_TRUE(pushed.system.solve_impulses(pushed.bodies, true)) << speed;
    pushed.system.apply(pushed.bodies);
    EXPECT_NEAR(pushed.bodies[1].velocity.x, kPush, 1e-6);
    EXPECT_NEAR(pushed.bodies[1].velocity.y, 0, 1e-6 * speed);
  }
}

}  // namespace
}  // namespace plumb
