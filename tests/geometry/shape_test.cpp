#include "engine/geometry/shape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb {
namespace {

Scene scene_with(Shape shape) {
  Body body;
  body.name = "body";
  body.shapes = {shape};
  Scene scene;
  scene.name = "scene";
  scene.bodies = {body};
  return scene;
}

TEST(Aabb, ContainsOverlapsMerges) {
  const Aabb<double> a{{0, 0}, {2, 1}}, b{{1, 0.5}, {3, 4}}, far{{5, 5}, {6, 6}};
  EXPECT_TRUE(a.overlaps(b));
  EXPECT_FALSE(a.overlaps(far));
  EXPECT_FALSE(a.contains(b));
  EXPECT_TRUE(merged(a, far).contains(far));
  EXPECT_EQ(merged(a, b).upper, (Vec2d{3, 4}));
  EXPECT_EQ(a.half_perimeter(), 3);
  EXPECT_TRUE(a.overlaps(Aabb<double>{{2, 1}, {3, 3}})) << "touching corners overlap";
}

TEST(Shape, CircleBoundsFollowItsOffset) {
  const auto shapes = compile_shapes<double>(scene_with({Circle{0.5}, {1, 0}}));
  Pose<double> pose;
  pose.position = {10, 20};
  pose.rotation = {0, 1};  // a quarter turn: the offset (1, 0) becomes (0, 1)
  const Aabb<double> box = bounds_of(shapes[0], place(shapes[0], pose));
  EXPECT_EQ(box.lower, (Vec2d{9.5, 20.5}));
  EXPECT_EQ(box.upper, (Vec2d{10.5, 21.5}));
}

// A 2 x 1 box turned by 30 degrees reaches 1 cos + 0.5 sin along x and 1 sin + 0.5 cos along y.
TEST(Shape, BoxBoundsTurnWithBodyAndShape) {
  const double degrees30 = 0.52359877559829887;
  for (const double in_body : {0.0, degrees30}) {
    const auto shapes = compile_shapes<double>(scene_with({Box{2, 1}, {}, in_body}));
    Pose<double> pose;
    if (in_body == 0) pose.rotation = {std::sqrt(3.0) / 2, 0.5};
    const Aabb<double> box = bounds_of(shapes[0], place(shapes[0], pose));
    EXPECT_NEAR(box.upper.x, std::sqrt(3.0) / 2 + 0.25, 1e-15);
    EXPECT_NEAR(box.upper.y, 0.5 + std::sqrt(3.0) / 4, 1e-15);
    EXPECT_NEAR(shapes[0].reach, std::sqrt(1.25), 1e-15);
  }
}

TEST(Shape, ShapesComeBodyByBody) {
  Scene scene = scene_with({Circle{1}});
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].shapes.push_back({Box{1, 1}});
  const auto shapes = compile_shapes<float>(scene);
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0].body, 0);
  EXPECT_EQ(shapes[1].body, 1);
  EXPECT_EQ(shapes[2].body, 1);
  EXPECT_EQ(shapes[2].kind, ShapeKind::Box);
}

}  // namespace
}  // namespace plumb
