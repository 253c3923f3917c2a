// Changes bodies and shapes after they were made, and reads chains and contacts, by way of the C interface.
#include "tests/bindings/c/fixture.h"

namespace {

using plumb::tests::C;
using plumb::tests::kDt;

TEST_F(C, ChangesWhatWasMade) {
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  const plumb_body falls = box(PLUMB_DYNAMIC, {0, 3}, 1, 1);
  plumb_shape shape;
  ASSERT_EQ(plumb_body_shapes(world, falls, &shape, 1), 1u);
  EXPECT_EQ(plumb_body_set_user_data(world, falls, 7), PLUMB_OK);
  EXPECT_EQ(plumb_shape_set_user_data(world, shape, 8), PLUMB_OK);
  EXPECT_EQ(plumb_body_set_name(world, falls, "crate"), PLUMB_OK);
  EXPECT_EQ(plumb_shape_set_density(world, shape, 3), PLUMB_OK);
  EXPECT_EQ(plumb_body_user_data(world, falls), 7u);
  EXPECT_EQ(plumb_shape_user_data(world, shape), 8u);
  EXPECT_STREQ(plumb_body_name(world, falls), "crate");
  EXPECT_EQ(plumb_body_mass(world, falls), 3);
  const plumb_box_bounds bounds = plumb_body_box(world, falls);
  EXPECT_EQ(bounds.lower.x, -0.5);
  EXPECT_EQ(plumb_shape_box(world, shape).upper.y, 3.5);
  EXPECT_TRUE(plumb_shape_contains(world, shape, {0.4, 3.4}));
  double fraction = 0;
  EXPECT_TRUE(plumb_shape_ray_cast(world, shape, {0, 5}, {0, -3}, &fraction, nullptr));
  EXPECT_NEAR(fraction, 0.5, 1e-9);
  EXPECT_EQ(plumb_shape_chain(world, shape).index, PLUMB_NO_INDEX);
  EXPECT_EQ(plumb_world_moved(world, nullptr, 0), 1u);
  EXPECT_EQ(plumb_body_set_enabled(world, falls, false), PLUMB_OK);
  plumb_world_step(world, kDt, 4);
  EXPECT_FALSE(plumb_body_enabled(world, falls));
  EXPECT_EQ(plumb_body_position(world, falls).y, 3);
  EXPECT_EQ(plumb_shape_set_sensor(world, shape, true), PLUMB_OK);
  EXPECT_TRUE(plumb_shape_sensor(world, shape));
  EXPECT_EQ(plumb_shape_set_hit_events(world, shape, false), PLUMB_OK);
  EXPECT_EQ(plumb_shape_set_pre_solve(world, shape, true), PLUMB_OK);
  EXPECT_EQ(plumb_last_error().status, PLUMB_OK);
}

TEST_F(C, ReplacesTheGeometryOfAShape) {
  const plumb_body ground = box(PLUMB_STATIC, {0, -1}, 40, 2);
  const plumb_body falls = box(PLUMB_DYNAMIC, {0, 0.5}, 1, 1);
  plumb_shape shape, floor;
  ASSERT_EQ(plumb_body_shapes(world, falls, &shape, 1), 1u);
  ASSERT_EQ(plumb_body_shapes(world, ground, &floor, 1), 1u);
  for (int i = 0; i < 90; ++i) plumb_world_step(world, kDt, 4);
  const plumb_geometry capsule = plumb_capsule({0, 0}, {1, 0}, 0.5);
  EXPECT_EQ(plumb_shape_set_geometry(world, shape, &capsule, {0, 0.5}, 0), PLUMB_OK);
  const plumb_shape_definition now = plumb_shape_get_definition(world, shape);
  EXPECT_EQ(now.geometry.kind, PLUMB_CAPSULE);
  EXPECT_NEAR(now.geometry.start.y, 0.5, 1e-6);
  EXPECT_TRUE(plumb_body_awake(world, falls));
  const plumb_vec2 corners[] = {{-20, 0}, {20, 0}, {0, -3}};
  const plumb_geometry wedge = plumb_polygon(corners, 3, 0);
  EXPECT_EQ(plumb_shape_set_geometry(world, floor, &wedge, {0, 0}, 0), PLUMB_OK);
  EXPECT_EQ(plumb_shape_box(world, floor).lower.y, -4);
  const plumb_geometry flat = plumb_box(1, 0);
  EXPECT_EQ(plumb_shape_set_geometry(world, shape, &flat, {0, 0}, 0), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().field, "height");
  EXPECT_EQ(plumb_shape_set_geometry(world, shape, nullptr, {0, 0}, 0), PLUMB_VALUE);
  EXPECT_EQ(plumb_shape_get_definition(world, shape).geometry.kind, PLUMB_CAPSULE);
  plumb_clear_error();
}

TEST_F(C, ChainsHaveAMaterialForEachSegment) {
  const plumb_body ground = box(PLUMB_STATIC, {0, -9}, 40, 2);
  const plumb_vec2 points[] = {{4, 0}, {0, 0}, {-4, 0}};
  const plumb_material materials[] = {{0, 0.5, 0, 0}, {0.75, 0, 0, 2}};
  plumb_chain_definition chain = plumb_default_chain();
  EXPECT_EQ(chain.material_count, 0u);
  chain.points = points, chain.point_count = 3;
  chain.materials = materials, chain.material_count = 2;
  const plumb_chain made = plumb_chain_create(world, ground, &chain);
  plumb_shape segments[2];
  ASSERT_EQ(plumb_chain_segments(world, made, segments, 2), 2u);
  EXPECT_EQ(plumb_shape_material(world, segments[0]).restitution, 0.5);
  EXPECT_EQ(plumb_shape_material(world, segments[1]).surface_speed, 2);
  const plumb_chain_definition now = plumb_chain_get_definition(world, made);
  ASSERT_EQ(now.material_count, 2u);
  EXPECT_EQ(now.materials[1].friction, 0.75);
  chain.material_count = 1;
  EXPECT_EQ(plumb_chain_create(world, ground, &chain).index, PLUMB_NO_INDEX);
  EXPECT_STREQ(plumb_last_error().field, "materials");
  chain.materials = nullptr;
  EXPECT_EQ(plumb_chain_create(world, ground, &chain).index, PLUMB_NO_INDEX);
  EXPECT_EQ(plumb_last_error().status, PLUMB_VALUE);
  plumb_clear_error();
}

TEST_F(C, FindsTheContactOfABeginEvent) {
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  const plumb_body falls = box(PLUMB_DYNAMIC, {0, 0.6}, 1, 1);
  plumb_shape shape;
  ASSERT_EQ(plumb_body_shapes(world, falls, &shape, 1), 1u);
  plumb_shape_set_hit_events(world, shape, true);
  size_t begun = 0;
  for (int i = 0; i < 30; ++i) {
    plumb_world_step(world, kDt, 4);
    const plumb_events events = plumb_world_events(world);
    plumb_contact contact{};
    for (size_t k = 0; k < events.begin_count; ++k, ++begun) {
      ASSERT_TRUE(plumb_shape_contact(world, events.begin[k].shape_a, events.begin[k].shape_b, &contact));
      EXPECT_FALSE(plumb_shape_contact(world, events.begin[k].shape_b, events.begin[k].shape_a, nullptr));
      EXPECT_EQ(plumb_last_error().status, PLUMB_VALUE);
      plumb_clear_error();
      EXPECT_EQ(contact.count, 2);
      EXPECT_GT(contact.step_impulse, 0);
    }
    if (events.begin_count == 0 && begun == 0) {
      EXPECT_FALSE(plumb_shape_contact(world, shape, shape, &contact));
    }
  }
  EXPECT_EQ(begun, 1u);
  EXPECT_EQ(plumb_last_error().status, PLUMB_OK);
}

}  // namespace
