#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "tests/world/support.h"

// A rhombus of four hinged bars falls flat onto a slab, two bars side by side on each side. From a step on
// one bar collides with the bar opposite, which it overlaps by its end: contact and hinges then hold each
// other along the bars, so that friction at the ends raises the pressure that bounds it. Truth: it lies
// there, and overlaps come apart at no more than the speed at which they are pushed out. The hunter found it
// (seed 333, scene 39): half of the instants ended at 1e12 m/s.
namespace plumb {
namespace {

template <class Real>
class JammedLinks : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(JammedLinks, Reals);

constexpr double kLength = 2.66, kStep = 1.0 / 60;

template <class Real>
struct Rhombus {
  explicit Rhombus(double thick) : world({.gravity = {0, -10}, .sleeping = false}) {
    world.create_body({.type = BodyType::Static, .position = {0, -1}},
                      {.geometry = Box{40, 2}, .material = {.friction = 0}});
    const double width[] = {kLength / 10, thick, kLength / 10, kLength / 10};
    const double x[] = {1, -1, -1, 1}, y[] = {1, 1, -1, -1};
    for (int i = 0; i < 4; ++i) {
      bars[i] = world.create_body(
          {.position = {0.94 * x[i], 2.45 + 0.94 * y[i]}, .angle = (3 + 2 * i) * std::numbers::pi / 4},
          {.geometry = Box{kLength, width[i]},
           .material = {.friction = i % 2 == 0 ? 0 : 0.6},
           .filter = {.group = -2}});
    }
    for (int i = 0; i < 4; ++i)
      world.create_joint(
          bars[i], bars[(i + 1) % 4],
          {.kind = RevoluteDefinition{.anchor_a = {kLength / 2, 0}, .anchor_b = {-kLength / 2, 0}}});
  }

  double fastest() const {
    double speed = 0;
    for (const BodyId bar : bars) speed = std::max(speed, double(length(world.velocity(bar))));
    return speed;
  }

  BasicWorld<Real> world;
  std::array<BodyId, 4> bars;
};

TYPED_TEST(JammedLinks, LieWhereFrictionAndHingesHoldEachOther) {
  for (const double thick : {0.5, 0.532, 0.6, 0.7}) {
    for (int begins = 200; begins < 224; ++begins) {
      Rhombus<TypeParam> it(thick);
      for (int step = 0; step < begins; ++step) it.world.step(kStep);
      const ShapeId end = it.world.shapes(it.bars[1])[0];
      it.world.set_filter(end, Filter{});
      double speed = 0;
      for (int step = 0; step < 100; ++step) it.world.step(kStep), speed = std::max(speed, it.fastest());
      EXPECT_LT(speed, 3) << thick << " m thick, from step " << begins;
    }
  }
}

}  // namespace
}  // namespace plumb
