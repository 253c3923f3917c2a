// Numbers of elements and pushes that the C interface refuses before it reads or changes anything.
#include <cstdint>
#include <limits>
#include <vector>

#include "tests/bindings/c/fixture.h"

namespace {

using plumb::tests::C;

TEST_F(C, NumbersOfElementsThatCannotBeAreRefusedByNameAndValue) {
  const plumb_body ground = box(PLUMB_STATIC, {0, 0}, 1, 1);
  const plumb_vec2 points[3] = {{0, 0}, {1, 0}, {0, 1}};
  const auto expect = [](const char* subject, const char* field, const char* value) {
    const plumb_error error = plumb_last_error();
    EXPECT_EQ(error.status, PLUMB_VALUE) << error.message;
    EXPECT_STREQ(error.subject, subject);
    EXPECT_STREQ(error.field, field);
    EXPECT_STREQ(error.value, value);
    plumb_clear_error();
  };
  const char* const all = "18446744073709551615";
  plumb_shape_definition shape = plumb_default_shape();
  shape.geometry = plumb_polygon(points, size_t{1} << 60, 0);
  EXPECT_EQ(plumb_shape_create(world, ground, &shape).index, PLUMB_NO_INDEX);
  expect("polygon", "point_count", "1152921504606846976");
  plumb_chain_definition chain = plumb_default_chain();
  chain.points = points, chain.point_count = SIZE_MAX;
  EXPECT_EQ(plumb_chain_create(world, ground, &chain).index, PLUMB_NO_INDEX);
  expect("chain", "point_count", all);
  const plumb_body_definition body = plumb_default_body();
  shape.geometry = plumb_circle(1);
  EXPECT_EQ(plumb_body_create(world, &body, &shape, SIZE_MAX).index, PLUMB_NO_INDEX);
  expect("body", "shape_count", all);
  const plumb_mover_hit hit{};
  EXPECT_EQ(plumb_apply_pushes(world, &hit, SIZE_MAX), PLUMB_VALUE);
  expect("pushes", "count", all);
  EXPECT_EQ(plumb_world_restore(world, &hit, SIZE_MAX), PLUMB_VALUE);
  expect("snapshot", "count", all);
  EXPECT_EQ(plumb_world_counts(world).bodies, 1);
}

TEST_F(C, PushesAreAppliedAllOrNone) {
  const plumb_body pushed = box(PLUMB_DYNAMIC, {0, 0}, 1, 1), gone = box(PLUMB_DYNAMIC, {3, 0}, 1, 1);
  plumb_body_destroy(world, gone);
  const plumb_mover_hit good{{}, pushed, {0, 0}, {-1, 0}, 2};
  std::vector<plumb_mover_hit> bad(6, good);
  bad[0].impulse = -1, bad[1].impulse = std::numeric_limits<double>::quiet_NaN();
  bad[2].impulse = std::numeric_limits<double>::infinity();
  bad[3].normal.x = std::numeric_limits<double>::quiet_NaN(), bad[4].point.y = 1e300;
  bad[5].body = gone;
  for (size_t i = 0; i < bad.size(); ++i) {
    const plumb_mover_hit hits[2] = {good, bad[i]};
    EXPECT_EQ(plumb_apply_pushes(world, hits, 2), i == 5 ? PLUMB_NAME : PLUMB_VALUE) << i;
    if (i < 5) {
      EXPECT_STREQ(plumb_last_error().subject, "push 1");
    }
    EXPECT_EQ(plumb_body_velocity(world, pushed).x, 0) << i;
  }
  EXPECT_EQ(plumb_apply_pushes(world, &good, 1), PLUMB_OK);
  EXPECT_EQ(plumb_body_velocity(world, pushed).x, 2);  // 2 N s on 1 kg
}

TEST_F(C, APolygonTakesAnyNumberOfPointsWithAHullOf64Corners) {
  const plumb_body body = box(PLUMB_DYNAMIC, {0, 0}, 1, 1);
  std::vector<plumb_vec2> grid;
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k < 20; ++k) grid.push_back({0.1 * i, 0.1 * k});
  plumb_shape_definition shape = plumb_default_shape();
  shape.geometry = plumb_polygon(grid.data(), grid.size(), 0);
  const plumb_shape made = plumb_shape_create(world, body, &shape);
  EXPECT_EQ(plumb_shape_get_definition(world, made).geometry.point_count, 4u);
}

TEST_F(C, ANameThatIsNullIsNone) {
  const plumb_body body = box(PLUMB_DYNAMIC, {0, 0}, 1, 1);
  EXPECT_EQ(plumb_body_set_name(world, body, "ball"), PLUMB_OK);
  EXPECT_STREQ(plumb_body_name(world, body), "ball");
  EXPECT_EQ(plumb_body_set_name(world, body, nullptr), PLUMB_OK);
  EXPECT_STREQ(plumb_body_name(world, body), "");
}

}  // namespace
