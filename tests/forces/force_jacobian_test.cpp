#include "engine/forces/force_jacobian.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/forces/laws.h"
#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

/// Wrenches of all laws on all bodies in the given states, at t = 0.
std::vector<Wrench<double>> wrenches(const Scene& scene, const std::vector<BodyState>& states) {
  std::vector<Pose<double>> poses;
  std::vector<Twist<double>> twists;
  for (const BodyState& s : states) {
    poses.push_back({s.position, rotation_of(s.angle)});
    twists.push_back({s.velocity, s.angular_velocity});
  }
  std::vector<Wrench<double>> out(states.size());
  Forces(scene).add(0, 0, poses.data(), twists.data(), out.data());
  return out;
}

double& coordinate(BodyState& s, int i) {
  double* const all[6] = {&s.position.x, &s.position.y, &s.angle,
                          &s.velocity.x, &s.velocity.y, &s.angular_velocity};
  return *all[i];
}

double component(const Wrench<double>& w, int i) {
  return i == 0 ? w.force.x : i == 1 ? w.force.y : w.torque;
}

/// Every derivative against a central difference of the laws themselves.
void expect_derivatives(const Scene& scene) {
  const std::size_t n = scene.bodies.size();
  std::vector<BodyState> states;
  std::vector<Pose<double>> poses;
  std::vector<Twist<double>> twists;
  for (const Body& body : scene.bodies) {
    states.push_back({body.position, body.angle, body.velocity, body.angular_velocity});
    poses.push_back({body.position, rotation_of(body.angle)});
    twists.push_back({body.velocity, body.angular_velocity});
  }
  std::vector<ForceBlock> blocks;
  ForceJacobian(scene).evaluate(0, poses, twists, blocks);
  ASSERT_FALSE(blocks.empty());
  constexpr double kShift = 1e-5;
  for (std::size_t by = 0; by < n; ++by) {
    for (int j = 0; j < 6; ++j) {
      std::vector<BodyState> more = states, less = states;
      coordinate(more[by], j) += kShift;
      coordinate(less[by], j) -= kShift;
      const auto up = wrenches(scene, more), down = wrenches(scene, less);
      for (std::size_t on = 0; on < n; ++on) {
        for (int i = 0; i < 3; ++i) {
          double analytic = 0;
          for (const ForceBlock& b : blocks) {
            if (b.on == on && b.by == by) analytic += j < 3 ? b.position[i][j] : b.velocity[i][j - 3];
          }
          const double difference = (component(up[on], i) - component(down[on], i)) / (2 * kShift);
          EXPECT_NEAR(analytic, difference, 1e-7 * std::max(1.0, std::abs(difference)))
              << scene.name << ": " << i << " of " << on << " by " << j << " of " << by;
        }
      }
    }
  }
}

Scene two_bodies(const std::string& name, ForceLaw law) {
  Scene scene{.name = name};
  scene.bodies = {{.name = "a",
                   .position = {0.3, 0.7},
                   .angle = 0.4,
                   .velocity = {1.2, -0.5},
                   .angular_velocity = 0.8,
                   .mass = 2,
                   .inertia = 0.6},
                  {.name = "b",
                   .position = {2.1, -0.4},
                   .angle = -1.1,
                   .velocity = {-0.3, 0.9},
                   .angular_velocity = -1.7,
                   .mass = 0.7,
                   .inertia = 0.2}};
  scene.forces = {std::move(law)};
  return scene;
}

TEST(ForceJacobian, IsTheDerivativeOfEveryLaw) {
  expect_derivatives(two_bodies("linear drag", LinearDrag{"a", 0.7, 0.3}));
  expect_derivatives(two_bodies("quadratic drag", QuadraticDrag{"b", 0.7}));
  expect_derivatives(two_bodies("force in the body", PointForce{"a", {1, 3}, {0.5, 0.2}, Frame::Body, 0, 1}));
  expect_derivatives(
      two_bodies("force in the world", PointForce{"b", {1, 3}, {0.5, 0.2}, Frame::World, 0, 1}));
  expect_derivatives(two_bodies("spring", SpringForce{"a", "b", {0.5, 0.2}, {-0.1, 0.3}, 0.7, 3, 1.4}));
  expect_derivatives(
      two_bodies("spring to the world", SpringForce{"world", "b", {0.5, 0.2}, {-0.1, 0.3}, 0.7, 3, 1.4}));
  expect_derivatives(two_bodies("attraction", AttractionForce{"a", "b", {0.5, 0.2}, 3, 2}));
  expect_derivatives(two_bodies("attraction to a point", AttractionForce{"b", "world", {0.5, 0.2}, 3, -2}));
  expect_derivatives(two_bodies("sinusoidal force", SinusoidalForce{"a", {1, 3}, {0.5, 0.2}, 4, 0.7}));
}

}  // namespace
}  // namespace plumb
