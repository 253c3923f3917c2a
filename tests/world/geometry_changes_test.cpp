// Replaces the geometry of a shape: the same motion as if the shape were destroyed and created anew, but it
// keeps its handle.
#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "engine/scene/error.h"
#include "engine/world/queries.h"
#include "engine/world/recorder.h"
#include "engine/world/replay.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

template <class Real>
class Geometry : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Geometry, Reals);

const std::vector<ShapeGeometry> kAll = {Circle{0.4}, Box{1.6, 0.6}, Capsule{{-0.5, 0}, {0.5, 0}, 0.25},
                                         Polygon{{{-0.7, -0.4}, {0.7, -0.4}, {0, 0.9}}, 0.05},
                                         Segment{{-1, 0.1}, {1, 0.1}}};

TYPED_TEST(Geometry, KeepsAllElse) {
  BasicWorld<TypeParam> w;
  const ShapeDefinition crate{.geometry = Box{1, 1},
                              .density = 2,
                              .material = {0.25, 0.5, 0.125, 1},
                              .filter = {2, 5, -1},
                              .hit_events = true,
                              .pre_solve = true,
                              .user_data = 7};
  const BodyId body = w.create_body({.name = "crate", .position = {0, 3}}, crate);
  const ShapeId shape = w.shapes(body)[0];
  w.set_geometry(shape, Capsule{{0, 0}, {1, 0}, 0.5}, {0.5, 0}, 0);
  EXPECT_TRUE(w.valid(shape));
  const ShapeDefinition now = w.definition(shape);
  const auto& capsule = std::get<Capsule>(now.geometry);
  EXPECT_NEAR(length(capsule.start - Vec2d{0.5, 0}) + length(capsule.end - Vec2d{1.5, 0}), 0, 1e-6);
  EXPECT_EQ(capsule.radius, 0.5);
  EXPECT_EQ(now.density, 2);
  EXPECT_EQ(now.material, crate.material);
  EXPECT_EQ(now.filter, crate.filter);
  EXPECT_TRUE(now.hit_events && now.pre_solve && !now.sensor);
  EXPECT_EQ(now.user_data, 7u);
  EXPECT_EQ(w.name(body), "crate");
}

TYPED_TEST(Geometry, GivesTheBodyItsMassUnlessThatWasGiven) {
  BasicWorld<TypeParam> w(weightless());
  const double pi = 3.14159265358979;
  const BodyId body = w.create_body({.velocity = {1, 0}, .angular_velocity = 2}, {.geometry = Box{1, 1}});
  w.set_geometry(w.shapes(body)[0], Circle{0.5}, {2, 0}, 1);
  EXPECT_NEAR(w.mass(body), pi / 4, 1e-6);
  EXPECT_NEAR(w.inertia(body), pi / 32, 1e-6);
  EXPECT_NEAR(w.centre(body).x, 2, 1e-6);
  // The body moves on as it did: the velocity of its new centre is v + w x r.
  EXPECT_NEAR(length(w.velocity(body) - Vec2d{1, 4}), 0, 1e-6);
  w.set_geometry(w.shapes(body)[0], Segment{{0, 0}, {1, 0}});
  EXPECT_EQ(w.mass(body), 1) << "without area";
  w.set_mass(body, {.mass = 7, .inertia = 2});
  w.set_geometry(w.shapes(body)[0], Box{3, 3});
  w.step();
  EXPECT_EQ(w.mass(body), 7);
  EXPECT_EQ(w.inertia(body), 2);
}

// The index of a shape that is destroyed is used again, so both worlds number their shapes alike.
TYPED_TEST(Geometry, MovesLikeAShapeThatIsCreatedAnew) {
  for (const BodyType type : {BodyType::Static, BodyType::Kinematic, BodyType::Dynamic}) {
    for (const ShapeGeometry& geometry : kAll) {
      for (const int before : {3, 200}) {
        const auto result = [&](bool in_place) {
          BasicWorld<TypeParam> w;
          add_ground(w);
          const BodyId changed = w.create_body({.type = type, .position = {0, 0.5}}, {.geometry = Box{1, 1}});
          add_box(w, {0.2, 1.5}), add_box(w, {1.05, 0.5}), add_box(w, {-9, 0.5});
          add_body(w, {-30, 0.7}, {.geometry = Circle{0.1}}, {before == 3 ? 150.0 : 0.0, 3});
          run(w, before);
          ShapeDefinition d = w.definition(w.shapes(changed)[0]);
          d.geometry = geometry, d.position = {0.1, 0.2}, d.angle = 0.3;
          if (in_place) {
            w.set_geometry(w.shapes(changed)[0], geometry, d.position, d.angle);
          } else {
            w.destroy(w.shapes(changed)[0]);
            w.create_shape(changed, d);
          }
          run(w, 120);
          return w.hash();
        };
        EXPECT_EQ(result(true), result(false))
            << "type " << static_cast<int>(type) << ", geometry " << geometry.index() << ", step " << before;
      }
    }
  }
}

TYPED_TEST(Geometry, EndsContactsAndBeginsThemAnew) {
  BasicWorld<TypeParam> w;
  const ShapeId floor = w.shapes(add_ground(w))[0];
  const BodyId box = add_box(w, {0, 0.5});
  run(w, 90);
  ASSERT_FALSE(w.awake(box));
  w.set_geometry(floor, Box{100, 2}, {0, -1});
  EXPECT_TRUE(w.awake(box));
  w.step();
  ASSERT_THAT(w.events().end, SizeIs(1));
  ASSERT_THAT(w.events().begin, SizeIs(1));
  EXPECT_EQ(w.events().begin[0].shape_a, floor) << "the handle is the same";
  run(w, 90);
  EXPECT_NEAR(w.position(box).y, 0.5, 0.006);
  EXPECT_FALSE(w.awake(box));
  w.set_geometry(floor, Box{100, 2}, {0, -3});
  w.step();
  EXPECT_THAT(w.events().end, SizeIs(1));
  EXPECT_THAT(w.events().begin, IsEmpty());
  run(w, 120);
  EXPECT_NEAR(w.position(box).y, -1.5, 0.006);
}

TYPED_TEST(Geometry, LetsOverlapsWithSensorsGoOn) {
  BasicWorld<TypeParam> w(weightless());
  const BodyId door = w.create_body({.type = BodyType::Static}, {.geometry = Box{2, 2}, .sensor = true});
  const BodyId visitor = w.create_body({.position = {0.5, 0}}, {.geometry = Circle{0.2}});
  const ShapeId sensor = w.shapes(door)[0], seen = w.shapes(visitor)[0];
  run(w, 2);
  ASSERT_THAT(w.overlapping(sensor), testing::ElementsAre(seen));
  w.set_geometry(sensor, Circle{3});
  w.set_geometry(seen, Box{0.3, 0.3});
  w.step();
  EXPECT_TRUE(w.sensor(sensor));
  EXPECT_THAT(w.overlapping(sensor), testing::ElementsAre(seen));
  EXPECT_THAT(w.events().sensor_begin, IsEmpty());
  EXPECT_THAT(w.events().sensor_end, IsEmpty());
  w.set_geometry(sensor, Box{0.2, 0.2}, {-1, 0});
  w.step();
  EXPECT_THAT(w.overlapping(sensor), IsEmpty());
  EXPECT_THAT(w.events().sensor_end, SizeIs(1));
  w.set_geometry(seen, Box{3, 0.3});
  w.step();
  EXPECT_THAT(w.events().sensor_begin, SizeIs(1));
}

TYPED_TEST(Geometry, IsSeenAtOnceByQueriesAndStopsWhatIsFast) {
  BasicWorld<TypeParam> w(weightless());
  const BodyId wall = w.create_body({.type = BodyType::Static, .position = {10, 0}}, {.geometry = Box{1, 1}});
  const ShapeId shape = w.shapes(wall)[0];
  w.step();
  w.set_geometry(shape, Segment{{0, -20}, {0, 20}});
  EXPECT_NEAR(ray_cast_closest(w, {0, 15}, {20, 0})->fraction, 0.5, 1e-6);
  EXPECT_NEAR(w.box(shape).upper.y, 20, 1e-5);
  const BodyId bullet = add_body(w, {0, 15}, {.geometry = Circle{0.05}}, {2000, 0});
  run(w, 10);
  EXPECT_LT(w.position(bullet).x, 10);
  // A thin rod does not tunnel as the box that it was might: its width is its own.
  const BodyId rod = w.create_body({.position = {0, -15}, .velocity = {2000, 0}}, {.geometry = Box{60, 60}});
  w.set_geometry(w.shapes(rod)[0], Box{0.02, 2});
  run(w, 10);
  EXPECT_LT(w.position(rod).x, 10);
}

// A box slides over replaced tiles and their neighbours, and catches on nothing.
TYPED_TEST(Geometry, OfATileLeavesTheFloorEven) {
  BasicWorld<TypeParam> w;
  const BodyId floor = w.create_body({.type = BodyType::Static});
  std::vector<ShapeId> tiles;
  for (int i = 0; i < 12; ++i)
    tiles.push_back(w.create_shape(
        floor, {.geometry = Box{1, 1}, .position = {i + 0.5, -0.5}, .material = {.friction = 0}}));
  const BodyId box =
      add_body(w, {0.6, 0.25}, {.geometry = Box{0.5, 0.5}, .material = {.friction = 0}}, {3, 0});
  run(w, 20);
  w.set_geometry(tiles[2], Box{1, 3}, {2.5, -1.5});
  w.set_geometry(tiles[5], Polygon{{{5, 0}, {6, 0}, {6, -2}, {5, -1}}});
  for (int i = 0; i < 150; ++i) {
    w.step();
    ASSERT_NEAR(w.velocity(box).x, 3, 1e-3) << w.position(box).x;
    ASSERT_LT(std::abs(w.angle(box)), 1e-3);
  }
  EXPECT_GT(w.position(box).x, 8);
}

TYPED_TEST(Geometry, OfADisabledBodyIsThereWhenItIsEnabled) {
  BasicWorld<TypeParam> w;
  const BodyId pillar = w.create_body({.type = BodyType::Static}, {.geometry = Box{1, 1}});
  w.set_enabled(pillar, false);
  w.set_geometry(w.shapes(pillar)[0], Box{4, 4});
  EXPECT_FALSE(ray_cast_closest(w, {-5, 1}, {10, 0}).has_value());
  w.set_enabled(pillar, true);
  const BodyId box = add_box(w, {1, 4});
  run(w, 90);
  EXPECT_NEAR(w.position(box).y, 2.5, 0.006);
}

TYPED_TEST(Geometry, IsRefusedAndChangesNothing) {
  BasicWorld<TypeParam> w;
  const BodyId ground = add_ground(w);
  const BodyId box = w.create_body({.name = "box", .position = {0, 0.5}}, {.geometry = Box{1, 1}});
  const ShapeId shape = w.shapes(box)[0];
  const ChainId chain = w.create_chain(ground, {.points = {{2, 5}, {-2, 5}}});
  run(w, 90);
  const std::uint64_t before = full_hash(w);
  const double nan = std::nan("");
  const auto refused = [&](const ShapeGeometry& geometry, Vec2d position, double angle, const char* field) {
    try {
      w.set_geometry(shape, geometry, position, angle);
      ADD_FAILURE() << field;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Value);
      EXPECT_EQ(error.field(), field);
      EXPECT_EQ(error.subject(), "shape 1 of body 'box'");
    }
  };
  refused(Circle{0}, {}, 0, "radius");
  refused(Box{1, -1}, {}, 0, "height");
  refused(Box{1, 1}, {nan, 0}, 0, "position");
  refused(Box{1, 1}, {}, 1e13, "angle");
  refused(Polygon{{{0, 0}, {1, 0}}}, {}, 0, "points");
  refused(Segment{{1, 1}, {1, 1}}, {}, 0, "end");
  if (std::is_same_v<TypeParam, float>) refused(Box{1e12, 1e12}, {}, 0, "density");
  EXPECT_THROW(w.set_geometry(w.segments(chain)[0], Segment{{2, 4}, {-2, 4}}), Error);
  EXPECT_EQ(full_hash(w), before);
  EXPECT_FALSE(w.awake(box));
  w.on_filter([&](ShapeId, ShapeId) {
    EXPECT_THROW(w.set_geometry(shape, Circle{1}), Error);
    return true;
  });
  w.set_geometry(shape, Circle{0.5});
  run(w, 3);
}

TYPED_TEST(Geometry, IsInSnapshotsAndRecordings) {
  const std::string file = testing::TempDir() + "geometry." + std::to_string(sizeof(TypeParam));
  std::uint64_t hash = 0;
  {
    RecordedWorld<TypeParam> w(file);
    w.create_body({.type = BodyType::Static}, {.geometry = Box{40, 1}, .position = {0, -0.5}});
    std::vector<BodyId> bodies;
    for (std::size_t i = 0; i < kAll.size(); ++i)
      bodies.push_back(
          w.create_body({.position = {0, 0.5 + static_cast<double>(i)}}, {.geometry = Box{1, 1}}));
    for (int i = 0; i < 20; ++i) w.step();
    for (std::size_t i = 0; i < kAll.size(); ++i)
      w.set_geometry(w->shapes(bodies[i])[0], kAll[i], {0.1, 0}, 0.2);
    BasicWorld<TypeParam> again;
    restore(again, save(*w));
    for (int i = 0; i < 40; ++i) w.step(), again.step();
    hash = full_hash(*w);
    EXPECT_EQ(full_hash(again), hash);
  }
  Replay<TypeParam> replayed(file);
  while (replayed.step()) {
  }
  EXPECT_FALSE(replayed.report().first_difference.has_value()) << replayed.report().message;
  EXPECT_EQ(full_hash(replayed.world()), hash);
}

// Corners that two shapes share stay with the other one.
TYPED_TEST(Geometry, ChangesNoOtherShapeOfTheSameForm) {
  BasicWorld<TypeParam> w(weightless());
  const BodyId one = add_box(w, {0, 0}), other = add_box(w, {5, 0});
  for (int i = 0; i < 50; ++i) {
    w.set_geometry(w.shapes(one)[0], i % 2 == 0 ? ShapeGeometry(Circle{1}) : ShapeGeometry(Box{1, 1}));
    w.step();
  }
  EXPECT_NEAR(w.box(w.shapes(other)[0]).upper.x, 5.5, 1e-6);
  EXPECT_EQ(w.box(w.shapes(one)[0]).upper.x, 0.5);
  EXPECT_EQ(w.mass(other), 1);
}

}  // namespace
}  // namespace plumb
