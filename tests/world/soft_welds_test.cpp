#include <gtest/gtest.h>

#include "engine/world/world.h"

namespace plumb {
namespace {

// A weld's linear spring is meant to stretch: unlike a rigid joint that an impact has opened, it takes no
// contact from a body that passes between its ends.
template <class Real>
class SoftWelds : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(SoftWelds, Precisions);

TYPED_TEST(SoftWelds, StretchedSpringsLeaveContactsBetweenTheirEnds) {
  WorldDefinition definition;
  definition.gravity = {0, 0};
  BasicWorld<TypeParam> w(definition);
  const BodyId post = w.create_body({.type = BodyType::Static});
  const BodyId plate = w.create_body({.position = {3, 0}}, ShapeDefinition{.geometry = Box{1, 1}});
  WeldDefinition weld;
  weld.linear_spring = Spring{.hertz = 0.01, .damping_ratio = 0};
  w.create_joint(post, plate, {.kind = weld});
  // Flies to the plate along the spring, so that it touches the plate at the spring's end.
  const BodyId ball =
      w.create_body({.position = {1.5, 0.1}, .velocity = {3, 0}}, ShapeDefinition{.geometry = Circle{0.5}});
  int begins = 0;
  for (int i = 0; i < 60; ++i) {
    w.step(1.0 / 60, 4);
    begins += static_cast<int>(w.events().begin.size());
  }
  EXPECT_EQ(begins, 1);
  EXPECT_LT(w.position(ball).x, w.position(plate).x - 0.9);
  EXPECT_GT(w.velocity(plate).x, 0.5);
}

}  // namespace
}  // namespace plumb
