#include <gtest/gtest.h>

#include <limits>

#include "engine/scene/error.h"
#include "engine/world/queries.h"
#include "tests/world/allocations.h"
#include "tests/world/query_crowd.h"

namespace plumb {
namespace {

using query_truth::Crowd;

TEST(QueriesUse, ClipStopAndIgnore) {
  World world;
  for (int i = 0; i < 5; ++i) {
    world.create_body({.type = i % 2 == 0 ? BodyType::Static : BodyType::Dynamic, .position = {2.0 * i, 0}},
                      ShapeDefinition{.geometry = Circle{0.5}});
  }
  int seen = 0;
  ray_cast(world, {-2, 0}, {20, 0}, {}, [&](const RayResult&) { return ++seen, 1.0; });
  EXPECT_EQ(seen, 5);
  seen = 0;
  ray_cast(world, {-2, 0}, {20, 0}, {}, [&](const RayResult&) { return ++seen, 0.0; });
  EXPECT_EQ(seen, 1);
  double last = 1;
  ray_cast(world, {-2, 0}, {20, 0}, {}, [&](const RayResult& hit) { return last = hit.fraction; });
  EXPECT_NEAR(last, 1.5 / 20, 1e-9);
  int shapes = 0;
  shapes_at(world, {2, 0}, {}, [&](ShapeId) { return ++shapes, true; });
  EXPECT_EQ(shapes, 1);
  overlap_box(world, {{-1, -1}, {9, 1}}, {}, [&](ShapeId) { return ++shapes < 3; });
  EXPECT_EQ(shapes, 3);
}

TEST(QueriesUse, ACondition) {
  World world;
  std::vector<ShapeId> ids;
  for (int i = 0; i < 3; ++i) {
    const BodyId body = world.create_body({.position = {2.0 * i, 0}});
    ids.push_back(world.create_shape(body, {.geometry = Circle{0.5}}));
  }
  const auto not_first = [&](ShapeId shape) { return !(shape == ids[0]); };
  const auto hit = ray_cast_closest(world, {-2, 0}, {20, 0}, {.condition = not_first});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->shape, ids[1]);
}

TEST(QueriesUse, TiesGoToTheSmallerIndex) {
  for (const bool static_first : {false, true}) {
    World world;
    for (int i = 0; i < 4; ++i) {
      const BodyType type = (i % 2 == 0) == static_first ? BodyType::Static : BodyType::Dynamic;
      world.create_body({.type = type, .position = {3, 0}}, ShapeDefinition{.geometry = Circle{0.5}});
    }
    EXPECT_EQ(ray_cast_closest(world, {}, {5, 0})->shape.index, 0u);
    EXPECT_EQ(cast_shape_closest(world, Circle{0.25}, {}, 0, {5, 0})->shape.index, 0u);
    EXPECT_EQ(cast_shape_closest(world, Circle{0.25}, {3, 0}, 0, {5, 0})->shape.index, 0u);  // all overlapped
    EXPECT_EQ(nearest(world, {}, 10)->shape.index, 0u);
  }
}

TEST(QueriesUse, RefuseWhatIsNotANumberAndWhatIsGone) {
  World world;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ray_cast_closest(world, {nan, 0}, {1, 0}), Error);
  EXPECT_THROW(ray_cast_closest(world, {}, {1, nan}), Error);
  EXPECT_THROW(cast_shape_closest(world, Circle{0.5}, {}, nan, {1, 0}), Error);
  EXPECT_THROW(cast_shape_closest(world, Circle{-1}, {}, 0, {1, 0}), Error);
  EXPECT_THROW(nearest(world, {}, -1), Error);
  std::vector<ShapeId> found;
  EXPECT_THROW(overlap_box(world, {{1, 0}, {0, 1}}, {}, found), Error);
  EXPECT_THROW(shapes_at(world, {0, nan}, {}, found), Error);
  const BodyId body = world.create_body({});
  const ShapeId a = world.create_shape(body, {}), b = world.create_shape(body, {});
  EXPECT_NO_THROW(distance(world, a, b));
  world.destroy(b);
  EXPECT_THROW(distance(world, a, b), Error);
}

// Ignoring what is gone would ignore nothing, or the body that has its index now.
TEST(QueriesUse, RefuseToIgnoreABodyThatIsGone) {
  World world;
  const BodyId gone = world.create_body({});
  world.destroy(gone);
  world.create_body({}, ShapeDefinition{.geometry = Circle{0.5}});
  const QueryFilter filter{.ignore = gone}, none{.ignore = BodyId{}};
  std::vector<RayResult> hits;
  std::vector<ShapeId> found;
  const QueryShape disc = Circle{0.5};
  const Aabb<double> box{{-1, -1}, {1, 1}};
  const auto visit = [](ShapeId) { return true; };
  EXPECT_THROW(ray_cast_closest(world, {-5, 0}, {9, 0}, filter), Error);
  EXPECT_THROW(ray_cast(world, {-5, 0}, {9, 0}, filter, [](const RayResult&) { return 1.0; }), Error);
  EXPECT_THROW(ray_cast_all(world, {-5, 0}, {9, 0}, filter, hits), Error);
  EXPECT_THROW(cast_shape_closest(world, disc, {-5, 0}, 0, {9, 0}, filter), Error);
  EXPECT_THROW(cast_shape(world, disc, {}, 0, {9, 0}, filter, [](const CastShapeResult&) { return 1.0; }),
               Error);
  EXPECT_THROW(overlap_shape(world, disc, {}, 0, filter, visit), Error);
  EXPECT_THROW(overlap_shape(world, disc, {}, 0, filter, found), Error);
  EXPECT_THROW(overlap_box(world, box, filter, visit), Error);
  EXPECT_THROW(overlap_box(world, box, filter, found), Error);
  EXPECT_THROW(shapes_at(world, {}, filter, visit), Error);
  EXPECT_THROW(shapes_at(world, {}, filter, found), Error);
  EXPECT_THROW(nearest(world, {}, 1, filter), Error);
  EXPECT_TRUE(ray_cast_closest(world, {-5, 0}, {9, 0}, none).has_value());
}

TEST(QueriesUse, AllocateNothing) {
  Crowd<float> crowd(7, {});
  const QueryShape shape = Polygon{{{-1, 0}, {1, 0}, {0, 1}}, 0.2};
  int met = 0;
  const long before = test::allocations();
  for (int i = 0; i < 100; ++i) {
    const Vec2d from = crowd.random.within(15), way = crowd.random.within(30);
    met += ray_cast_closest(crowd.world, from, way).has_value();
    met += cast_shape_closest(crowd.world, shape, from, 1, way).has_value();
    met += cast_shape_closest(crowd.world, Capsule{{0, 0}, {0, 1}, 0.5}, from, 1, way).has_value();
    met += nearest(crowd.world, from, 100).has_value();
    overlap_box(crowd.world, {from, from + Vec2d{1, 1}}, {}, [&](ShapeId) { return ++met, true; });
    shapes_at(crowd.world, from, {}, [&](ShapeId) { return ++met, true; });
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(met, 200);
}

}  // namespace
}  // namespace plumb
