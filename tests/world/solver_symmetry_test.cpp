#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/world/solver_scenes.h"

// Checks what no solver may depend on: left and right, and the order in which bodies came.
namespace plumb {
namespace {

using test::with;

struct View {
  double sign = 1;    ///< of x
  bool late = false;  ///< the last thing is built first
  Vec2d at(Vec2d p) const { return {sign * p.x, p.y}; }
};

// Things that do not meet: a box that is thrown onto the ground and slides, a ball that bounces and spins, a
// pendulum of three rods, a tower.
std::vector<BodyId> build(DoubleWorld& world, const View& v) {
  world.create_body(
      {.type = BodyType::Static},
      ShapeDefinition{.geometry = Box{100, 2}, .position = {0, -1}, .material = {.restitution = 0.5}});
  std::vector<BodyId> things[4];
  const auto make = [&](int thing) {
    if (thing == 0) {
      things[0] = {
          world.create_body({.position = v.at({0, 1.2}), .angle = 0.3 * v.sign, .velocity = {3 * v.sign, 0}},
                            ShapeDefinition{.geometry = Box{1, 0.6}})};
    } else if (thing == 1) {
      things[1] = {
          world.create_body({.position = v.at({8, 2}), .angular_velocity = 9 * v.sign},
                            ShapeDefinition{.geometry = Circle{0.4}, .material = {.restitution = 0.5}})};
    } else if (thing == 2) {
      BodyId last = test::add_hook(world, v.at({-8, 6}));
      for (int i = 0; i < 3; ++i) {
        const BodyId rod = test::add_mass(world, v.at({-7.5 + i, 6}), 1, 1.0 / 12);
        const double out = 0.5 * v.sign;
        world.create_joint(
            last, rod,
            {.kind = RevoluteDefinition{.anchor_a = {i == 0 ? 0 : out, 0}, .anchor_b = {-out, 0}}});
        things[2].push_back(last = rod);
      }
    } else {
      for (int i = 0; i < 3; ++i) things[3].push_back(add_box(world, v.at({-15, 0.5 + i})));
    }
  };
  for (int i = 0; i < 4; ++i) make(v.late ? 3 - i : i);
  std::vector<BodyId> all;
  for (const auto& thing : things) all.insert(all.end(), thing.begin(), thing.end());
  return all;
}

// The largest difference between two views of one world over `steps`, m.
double difference(Solver solver, const View& view, int steps) {
  DoubleWorld plain(with(solver)), seen(with(solver));
  const std::vector<BodyId> a = build(plain, {}), b = build(seen, view);
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    plain.step(), seen.step();
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Vec2d apart = view.at(plain.position(a[k])) - seen.position(b[k]);
      worst = std::max(worst, std::sqrt(length_squared(apart)));
    }
  }
  return worst;
}

class SolverSymmetry : public testing::TestWithParam<Solver> {};
INSTANTIATE_TEST_SUITE_P(, SolverSymmetry, test::all_solvers(), test::solver_name);

// Rounding, 1e-16 of 10 m a substep, grows as a double pendulum's errors do: by exp(3 t) in a second and a
// half.
TEST_P(SolverSymmetry, LeftAndRightAreAlike) { EXPECT_LT(difference(GetParam(), {.sign = -1}, 90), 1e-11); }

TEST_P(SolverSymmetry, TheOrderOfThingsDoesNotMatter) {
  EXPECT_LT(difference(GetParam(), {.late = true}, 90), 1e-11);
}

}  // namespace
}  // namespace plumb
