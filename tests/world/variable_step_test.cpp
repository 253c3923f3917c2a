#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include "tests/world/solver_scenes.h"
#include "tests/world/support.h"

// Steps whose length changes from one to the next.
namespace plumb {
namespace {

template <class Real>
class VariableSteps : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(VariableSteps, Reals);

int cases(int usual) {
  const char* times = std::getenv("PLUMB_PROPERTY_CASES");
  return times == nullptr ? usual : usual * std::atoi(times);
}

// m, the farthest that a box of a pyramid that stands has moved after steps of `dt(i)` for `time`, s.
template <class Real>
double moved(int rows, double time, const std::function<double(int)>& dt) {
  BasicWorld<Real> world({.sleeping = false});
  add_ground(world);
  std::vector<BodyId> boxes;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < rows - y; ++x) boxes.push_back(add_box(world, {x * 1.02 + y * 0.51 - 6, 0.5 + y}));
  run(world, 400);
  std::vector<Vec2d> before;
  for (const BodyId box : boxes) before.push_back(world.position(box));
  double passed = 0;
  for (int i = 0; passed < time; ++i) world.step(dt(i)), passed += dt(i);
  double most = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    most = std::max(most, std::sqrt(length_squared(world.position(boxes[i]) - before[i])));
  return most;
}

// Bodies that stand still under equal steps do so under any: within a millimetre of the overlaps, which go
// with the substep.
TYPED_TEST(VariableSteps, LetPyramidsRest) {
  const double equal = moved<TypeParam>(10, 10, [](int) { return 1.0 / 60; });
  for (const double factor : {1e-7, 1e-5, 1e-3, 1e-2, 0.1, 1.5, 2.0, 3.0, 4.0, 10.0}) {
    const double far = moved<TypeParam>(10, 10, [=](int i) { return (i % 2 == 0 ? factor : 1) / 60; });
    EXPECT_LT(far, 2 * equal + 1e-3) << factor;
  }
}

TYPED_TEST(VariableSteps, OfRandomLengthsLetPyramidsRest) {
  const double equal = moved<TypeParam>(8, 10, [](int) { return 1.0 / 60; });
  for (int seed = 1; seed <= cases(2); ++seed) {
    std::mt19937 draw(static_cast<std::uint32_t>(seed));
    std::vector<double> lengths(2000);
    const double most = seed % 2 == 0 ? 10 : 3;
    for (double& length : lengths) length = std::uniform_real_distribution<double>(1, most)(draw) / 60;
    const double far = moved<TypeParam>(8, 10, [&](int i) { return lengths[static_cast<std::size_t>(i)]; });
    EXPECT_LT(far, 2 * equal + 1e-3) << "seed " << seed;
  }
}

// Steps of games that measure time with a clock: from 10 ns to a thirtieth of a second, each length as likely
// as its double.
TYPED_TEST(VariableSteps, OfAllMagnitudesLetPyramidsRest) {
  const double equal = moved<TypeParam>(8, 3, [](int) { return 1.0 / 60; });
  for (int seed = 1; seed <= cases(2); ++seed) {
    std::mt19937 draw(static_cast<std::uint32_t>(seed));
    const double far = moved<TypeParam>(8, 3, [&](int) {
      return std::exp(std::uniform_real_distribution<double>(std::log(1e-8), std::log(1.0 / 30))(draw));
    });
    EXPECT_LT(far, 2 * equal + 1e-3) << "seed " << seed;
  }
}

// Contacts report the impulses of the last substep, however short: the weight times its length.
TYPED_TEST(VariableSteps, ReportTheImpulsesOfTheirOwnLength) {
  BasicWorld<TypeParam> world({.sleeping = false});
  add_ground(world);
  const BodyId box = add_box(world, {0, 0.5});
  const double weight = 9.81, h = 1.0 / 60 / 4;
  const auto pressed = [&] {
    double sum = 0;
    for (const ContactReading& contact : world.contacts(box))
      for (int i = 0; i < contact.count; ++i) sum += contact.impulses[i];
    return sum;
  };
  run(world, 60);
  EXPECT_NEAR(pressed(), weight * h, 1e-3 * weight * h);
  for (const double ratio : {0.5, 1e-2, 1e-5}) {
    world.step(ratio / 60);
    EXPECT_NEAR(pressed(), ratio * weight * h, 1e-3 * ratio * weight * h) << ratio;
    run(world, 20);
  }
}

// A load that arrives in slow motion presses as it does at full speed: a box lands on a tower, and the tower
// stands.
TYPED_TEST(VariableSteps, GoOverToSlowMotionWithinOneStep) {
  BasicWorld<TypeParam> world({.sleeping = false});
  add_ground(world);
  std::vector<BodyId> tower;
  for (int i = 0; i < 6; ++i) tower.push_back(add_box(world, {0, 0.5 + i}));
  run(world, 60);
  const BodyId load = add_box(world, {0, 6.6});
  for (int i = 0; i < 1500; ++i) world.step(1.0 / 600);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(world.position(tower[i]).y, 0.5 + i, 1e-3);
    EXPECT_NEAR(world.position(tower[i]).x, 0, 1e-3);
  }
  EXPECT_NEAR(world.position(load).y, 6.5, 1e-3);
}

// A chain that hangs across does not swing for it.
TYPED_TEST(VariableSteps, LetChainsHang) {
  BasicWorld<TypeParam> world({.sleeping = false});
  const BodyId hook = test::add_hook(world);
  BodyId last = hook;
  std::vector<BodyId> links;
  for (int i = 0; i < 12; ++i) {
    const BodyId link = test::add_mass(world, {0, -0.5 - i}, 1, 0.1);
    world.create_joint(
        last, link, {.kind = RevoluteDefinition{.anchor_a = {0, i > 0 ? -0.5 : 0.0}, .anchor_b = {0, 0.5}}});
    links.push_back(last = link);
  }
  run(world, 300);
  for (const double factor : {1e-7, 1e-4, 1e-2, 3.0}) {
    const Vec2d before = world.position(links.back());
    for (int i = 0; i < 600; ++i) world.step((i % 2 == 0 ? factor : 1.0) / 60);
    EXPECT_LT(std::sqrt(length_squared(world.position(links.back()) - before)), 2e-3) << factor;
  }
}

}  // namespace
}  // namespace plumb
