#include "engine/world/queries.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "engine/scene/error.h"
#include "tests/world/query_truth.h"

namespace {
long allocations = 0;
}

// Counts what a query allocates, unless another file of the program counts in its own way.
__attribute__((weak)) void* operator new(std::size_t size) {
  ++allocations;
  if (void* place = std::malloc(size == 0 ? 1 : size)) return place;
  throw std::bad_alloc();
}
__attribute__((weak)) void operator delete(void* place) noexcept { std::free(place); }
__attribute__((weak)) void operator delete(void* place, std::size_t) noexcept { std::free(place); }

namespace plumb {
namespace {

using namespace query_truth;

/// A crowd of bodies about `centre` with all kinds of shapes, and what the test knows of them.
template <class Real>
struct Crowd {
  struct Known {
    ShapeId id;
    BodyId body;
    ShapeDefinition shape;
    bool chain = false;
  };

  // Corners and rotations are rounded to Real: relative to sizes of a few metres.
  static constexpr double kTolerance = sizeof(Real) == 4 ? 3e-6 : 1e-8;

  Crowd(unsigned seed, Vec2d middle, int bodies = 60) : random(seed), centre(middle) {
    for (int i = 0; i < bodies; ++i) add_body();
  }

  void add_body() {
    BodyDefinition body;
    body.type = static_cast<BodyType>(random.below(3));
    body.position = centre + random.within(15);
    body.angle = random.uniform(-7, 7);
    body.velocity = random.within(5);
    body.angular_velocity = random.uniform(-3, 3);
    const BodyId id = world.create_body(body);
    for (int i = random.chance(0.3) ? 3 : 1; i > 0; --i) {
      ShapeDefinition shape;
      shape.geometry = random_geometry(random);
      shape.position = random.within(1);
      shape.angle = random.uniform(-4, 4);
      shape.filter = {1u << random.below(3), random.chance(0.8) ? 0xFFFFFFFFu : 2u, 0};
      shape.sensor = random.chance(0.15);
      known.push_back({world.create_shape(id, shape), id, shape});
    }
    if (!random.chance(0.15)) return;
    const ChainDefinition chain{.points = {random.within(2), random.within(2)}};
    const ChainId chain_id = world.create_chain(id, chain);
    ShapeDefinition line{.geometry = Segment{chain.points[0], chain.points[1]}};
    known.push_back({world.segments(chain_id)[0], id, line, true});
  }

  /// Seen from `origin`.
  Outline outline(const Known& shape, Vec2d origin) const {
    const Outline in_body =
        placed(outline_of(shape.shape.geometry), shape.shape.position.template as<Wide>(), shape.shape.angle);
    // The body's angle counts turns; its axes are what it is drawn by.
    const Vec2d at = world.position(shape.body), axis = world.world_point(shape.body, {1, 0}) - at;
    return placed(in_body, (at - origin).template as<Wide>(), std::atan2(Wide(axis.y), Wide(axis.x)));
  }

  bool seen(const Known& shape, const QueryFilter& filter) const {
    const Filter& own = shape.shape.filter;
    return (own.category & filter.mask) != 0 && (own.mask & filter.category) != 0 &&
           (!shape.shape.sensor || filter.sensors) && !(shape.body == filter.ignore);
  }

  QueryFilter random_filter() {
    QueryFilter filter;
    if (random.chance(0.4)) filter.mask = static_cast<std::uint32_t>(1 + random.below(7));
    if (random.chance(0.2)) filter.category = 1;
    filter.sensors = random.chance(0.3);
    if (random.chance(0.3)) filter.ignore = known[random.below(static_cast<int>(known.size()))].body;
    return filter;
  }

  /// Steps, then takes out every third body and puts every fourth one somewhere else.
  void stir() {
    for (int i = 0; i < 30; ++i) world.step();
    const std::vector<BodyId> bodies = world.bodies();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (i % 3 == 0) {
        world.destroy(bodies[i]);
      } else if (i % 4 == 0) {
        world.set_position(bodies[i], centre + random.within(15), random.uniform(-7, 7));
      }
    }
    std::erase_if(known, [&](const Known& shape) { return !world.valid(shape.id); });
    for (int i = 0; i < 10; ++i) add_body();
  }

  Random random;
  Vec2d centre;
  BasicWorld<Real> world;
  std::vector<Known> known;
};

Point corner_side(const Outline& line) { return -perpendicular(line.corners[1] - line.corners[0]); }

Point middle_of(const Outline& shape) {
  Point sum{};
  for (const Point corner : shape.corners) sum += corner;
  return (Wide(1) / static_cast<Wide>(shape.corners.size())) * sum;
}

template <class Real>
class Queries : public testing::Test {
 protected:
  // Calls check(crowd) for fresh and stirred crowds, at the origin and far away.
  template <class Check>
  void for_each_crowd(const Check& check) {
    unsigned seed = 1;
    for (const Vec2d centre : {Vec2d{0, 0}, Vec2d{1e7, -3e6}, Vec2d{-2e4, 5e5}}) {
      Crowd<Real> crowd(seed++, centre);
      SCOPED_TRACE(testing::Message() << "about " << centre.x << ", " << centre.y);
      check(crowd);
      SCOPED_TRACE("stirred");
      crowd.stir();
      check(crowd);
    }
  }
};

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Queries, Reals);

TYPED_TEST(Queries, RaysHitWhatBruteForceSays) {
  int hits_checked = 0;
  this->for_each_crowd([&](Crowd<TypeParam>& crowd) {
    const Wide tolerance = crowd.kTolerance;
    for (int i = 0; i < 300; ++i) {
      const Vec2d origin = crowd.centre + crowd.random.within(20);
      const Vec2d way = crowd.random.within(i % 3 == 0 ? 1000 : 20);
      const QueryFilter filter = crowd.random_filter();
      std::vector<RayResult> hits;
      ray_cast_all(crowd.world, origin, way, filter, hits);
      for (std::size_t k = 1; k < hits.size(); ++k) EXPECT_LE(hits[k - 1].fraction, hits[k].fraction);
      std::size_t found = 0;
      Wide first = kNever;
      for (const auto& shape : crowd.known) {
        const auto hit = std::find_if(hits.begin(), hits.end(),
                                      [&](const RayResult& result) { return result.shape == shape.id; });
        const Outline outline = crowd.outline(shape, origin);
        Wide expected = ray_fraction(outline, {}, way.as<Wide>());
        if (shape.chain) {
          const Point front = corner_side(outline);
          if (!(dot(front, outline.corners[0]) < 0) || !(dot(front, way.as<Wide>()) < 0)) expected = kNever;
        }
        if (!crowd.seen(shape, filter)) expected = kNever;
        EXPECT_EQ(hit != hits.end(), expected < kNever) << "ray " << i << " shape " << shape.id.index;
        if (hit == hits.end() || !(expected < kNever)) continue;
        ++found, ++hits_checked;
        EXPECT_EQ(hit->body, shape.body);
        const Point normal = hit->normal.template as<Wide>(), direction = way.as<Wide>();
        const Wide steepness = -dot(normal, direction) / norm(direction);
        EXPECT_GT(steepness, 0);
        if (steepness < 1e-3) continue;
        first = std::min(first, expected);
        EXPECT_LE(std::abs(hit->fraction - expected) * norm(way.as<Wide>()), tolerance / steepness);
        const Point point = (hit->point - origin).template as<Wide>();
        EXPECT_LE(std::abs(signed_distance(outline, point)), tolerance / steepness + 3e-9L);
        const Wide out = 1e-3L;
        EXPECT_LE(std::abs(signed_distance(outline, point + out * normal) - out), 2 * tolerance + 3e-9L);
        EXPECT_LE(std::abs(length_squared(normal) - 1), 1e-12L);
      }
      EXPECT_EQ(found, hits.size());
      const auto closest = ray_cast_closest(crowd.world, origin, way, filter);
      ASSERT_EQ(closest.has_value(), !hits.empty());
      if (closest) {
        EXPECT_EQ(closest->shape, hits[0].shape);
        EXPECT_EQ(closest->fraction, hits[0].fraction);
      }
    }
  });
  EXPECT_GT(hits_checked, 1000);
}

TYPED_TEST(Queries, CastsHitWhatBruteForceSays) {
  int hits_checked = 0, chains_checked = 0;
  this->for_each_crowd([&](Crowd<TypeParam>& crowd) {
    const Wide tolerance = crowd.kTolerance;
    for (int i = 0; i < 200; ++i) {
      const Vec2d position = crowd.centre + crowd.random.within(20), way = crowd.random.within(20);
      const double angle = crowd.random.uniform(-4, 4);
      const ShapeGeometry geometry = random_geometry(crowd.random);
      const Outline moving = placed(outline_of(geometry), {}, angle);
      const QueryFilter filter = crowd.random_filter();
      std::vector<CastShapeResult> hits;
      cast_shape(crowd.world, geometry, position, angle, way, filter, [&](const CastShapeResult& hit) {
        hits.push_back(hit);
        return 1.0;
      });
      for (const auto& shape : crowd.known) {
        const auto hit = std::find_if(hits.begin(), hits.end(), [&](const CastShapeResult& result) {
          return result.shape == shape.id;
        });
        const Outline outline = crowd.outline(shape, position);
        Wide expected = crowd.seen(shape, filter) ? cast_fraction(outline, moving, way.as<Wide>()) : kNever;
        if (shape.chain && expected < kNever) {
          ++chains_checked;
          const Point front = corner_side(outline);
          if (dot(front, middle_of(moving) - outline.corners[0]) < 0) expected = kNever;
          // From the front: the moving shape, brought to the touch and a little out along the front, is free.
          Outline out = placed(moving, expected * way.as<Wide>() + (Wide(1e-4) / norm(front)) * front, 0);
          if (0 < expected && expected < kNever && gap(outline, out) <= 0) expected = kNever;
        }
        EXPECT_EQ(hit != hits.end(), expected < kNever) << "cast " << i << " shape " << shape.id.index;
        if (hit == hits.end() || !(expected < kNever)) continue;
        ++hits_checked;
        EXPECT_EQ(hit->overlapped, expected == 0);
        if (hit->overlapped) {
          EXPECT_EQ(hit->fraction, 0);
          continue;
        }
        const Point direction = way.as<Wide>();
        const Wide steepness = -dot(hit->normal.template as<Wide>(), direction) / norm(direction);
        EXPECT_GT(steepness, 0);
        if (steepness < 1e-3) continue;
        EXPECT_LE(std::abs(hit->fraction - expected) * norm(way.as<Wide>()), tolerance / steepness);
        const Point point = (hit->point - position).template as<Wide>();
        EXPECT_LE(std::abs(signed_distance(outline, point)), tolerance / steepness + 3e-9L);
      }
      const auto closest = cast_shape_closest(crowd.world, geometry, position, angle, way, filter);
      ASSERT_EQ(closest.has_value(), !hits.empty());
      for (const CastShapeResult& hit : hits) {
        EXPECT_TRUE(hit.fraction > closest->fraction ||
                    (hit.fraction == closest->fraction && hit.shape.index >= closest->shape.index));
      }
    }
  });
  EXPECT_GT(hits_checked, 1000);
  EXPECT_GT(chains_checked, 20);
}

TYPED_TEST(Queries, OverlapsAreWhatBruteForceSays) {
  int found_in_all = 0;
  this->for_each_crowd([&](Crowd<TypeParam>& crowd) {
    const auto compare = [&](const Outline& area, Vec2d position, const QueryFilter& filter,
                             const std::vector<ShapeId>& found) {
      for (std::size_t k = 1; k < found.size(); ++k) EXPECT_LT(found[k - 1].index, found[k].index);
      for (const auto& shape : crowd.known) {
        const bool has = std::find(found.begin(), found.end(), shape.id) != found.end();
        const Wide apart = gap(crowd.outline(shape, position), area);
        found_in_all += has;
        if (crowd.seen(shape, filter) && std::abs(apart) < crowd.kTolerance) continue;
        EXPECT_EQ(has, crowd.seen(shape, filter) && apart <= 0) << shape.id.index << " at " << apart;
      }
    };
    std::vector<ShapeId> found;
    for (int i = 0; i < 200; ++i) {
      const Vec2d position = crowd.centre + crowd.random.within(20);
      const QueryFilter filter = crowd.random_filter();
      const double angle = crowd.random.uniform(-4, 4);
      const ShapeGeometry geometry = random_geometry(crowd.random);
      overlap_shape(crowd.world, geometry, position, angle, filter, found);
      compare(placed(outline_of(geometry), {}, angle), position, filter, found);

      const Vec2d half{crowd.random.uniform(0, 3), i % 5 == 0 ? 0 : crowd.random.uniform(0, 3)};
      overlap_box(crowd.world, {position - half, position + half}, filter, found);
      const Point h = half.as<Wide>();
      compare({{-h, {h.x, -h.y}, h, {-h.x, h.y}}, 0}, position, filter, found);

      shapes_at(crowd.world, position, filter, found);
      compare({{{0, 0}}, 0}, position, filter, found);
    }
  });
  EXPECT_GT(found_in_all, 1000);
}

TYPED_TEST(Queries, TheNearestShapeIsThatOfBruteForce) {
  this->for_each_crowd([&](Crowd<TypeParam>& crowd) {
    for (int i = 0; i < 300; ++i) {
      const Vec2d point = crowd.centre + crowd.random.within(i % 2 == 0 ? 20 : 200);
      const double most = i % 4 == 0 ? crowd.random.uniform(0, 3) : 1e4;
      const QueryFilter filter = crowd.random_filter();
      Wide least = kNever;
      for (const auto& shape : crowd.known) {
        if (crowd.seen(shape, filter))
          least = std::min(least, signed_distance(crowd.outline(shape, point), {}));
      }
      const auto found = nearest(crowd.world, point, most, filter);
      if (std::abs(least - most) > crowd.kTolerance) {
        ASSERT_EQ(found.has_value(), least <= most);
      }
      if (!found) continue;
      EXPECT_LE(std::abs(found->distance - least), crowd.kTolerance);
      const auto shape = std::find_if(crowd.known.begin(), crowd.known.end(),
                                      [&](const auto& known) { return known.id == found->shape; });
      ASSERT_NE(shape, crowd.known.end());
      EXPECT_EQ(shape->body, found->body);
      const Outline outline = crowd.outline(*shape, point);
      const Point on_surface = (found->point - point).template as<Wide>();
      EXPECT_LE(std::abs(signed_distance(outline, on_surface)), crowd.kTolerance + 3e-9L);
      EXPECT_LE(norm(on_surface + Wide(found->distance) * found->normal.template as<Wide>()), 1e-8L);
    }
  });
}

TYPED_TEST(Queries, DistancesOfShapesAreThoseOfBruteForce) {
  this->for_each_crowd([&](Crowd<TypeParam>& crowd) {
    const int count = static_cast<int>(crowd.known.size());
    for (int i = 0; i < 300; ++i) {
      const auto &a = crowd.known[crowd.random.below(count)], &b = crowd.known[crowd.random.below(count)];
      if (a.id == b.id) continue;
      const Vec2d here = crowd.world.position(a.body);
      const Outline outline_a = crowd.outline(a, here), outline_b = crowd.outline(b, here);
      const Wide expected = gap(outline_a, outline_b);
      const ShapeDistance found = distance(crowd.world, a.id, b.id);
      if (expected > 0) {
        EXPECT_LE(std::abs(found.distance - expected), 2 * crowd.kTolerance);
        EXPECT_LE(std::abs(signed_distance(outline_a, (found.point_a - here).template as<Wide>())),
                  crowd.kTolerance + 3e-9L);
        EXPECT_LE(std::abs(signed_distance(outline_b, (found.point_b - here).template as<Wide>())),
                  crowd.kTolerance + 3e-9L);
      } else if (found.distance < -1e-5) {
        // The least way out: a little less leaves them overlapping, a little more does not.
        const Point way = (-found.distance) * found.normal.template as<Wide>();
        EXPECT_LE(gap(outline_a, placed(outline_b, Wide(0.999) * way, 0)), crowd.kTolerance);
        EXPECT_GE(gap(outline_a, placed(outline_b, Wide(1.001) * way, 0)), -crowd.kTolerance);
      }
    }
  });
}

// Boxes in float are a metre coarse at 1e7 m, shapes and queries are not: a body that creeps through its
// stored box is found wherever it is.
TYPED_TEST(Queries, MissNothingWhereBoxesAreCoarse) {
  BasicWorld<TypeParam> world({.gravity = {0, 0}});
  for (const Vec2d way : {Vec2d{1, 0.1}, Vec2d{-0.9, 0.3}, Vec2d{0.2, -1}}) {
    const BodyId body =
        world.create_body({.type = BodyType::Kinematic, .position = {1.2e7, -0.7e7}, .velocity = 3.0 * way},
                          ShapeDefinition{.geometry = Circle{0.3}});
    for (int i = 0; i < 1000; ++i) {
      world.step();
      const Vec2d centre = world.position(body);
      for (const Vec2d to : {Vec2d{0.29, 0}, Vec2d{-0.29, 0}, Vec2d{0, 0.29}, Vec2d{0, -0.29}}) {
        int found = 0;
        const auto count = [&](ShapeId) { return ++found, true; };
        shapes_at(world, centre + to, {}, count);
        overlap_box(world, {centre + to, centre + to + Vec2d{0.001, 0.001}}, {}, count);
        overlap_shape(world, Circle{0.001}, centre + to, 0, {}, count);
        found += ray_cast_closest(world, centre + 2.0 * to, -1.1 * to).has_value();
        found += cast_shape_closest(world, Circle{0.01}, centre + 2.0 * to, 0, -1.1 * to).has_value();
        found += nearest(world, centre + 2.0 * to, 0.29).has_value();
        ASSERT_EQ(found, 6) << "after step " << i;
      }
    }
    world.destroy(body);
  }
}

TEST(QueriesVisitors, ClipStopAndIgnore) {
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

TEST(QueriesVisitors, ACondition) {
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

TEST(QueriesVisitors, TiesGoToTheSmallerIndex) {
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

TEST(QueriesVisitors, RefuseWhatIsNotANumberAndWhatIsGone) {
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

TEST(QueriesVisitors, AllocateNothing) {
  Crowd<float> crowd(7, {});
  const QueryShape shape = Polygon{{{-1, 0}, {1, 0}, {0, 1}}, 0.2};
  int met = 0;
  const long at_first = allocations;
  delete new Crowd<float>(7, {}, 1);
  if (allocations == at_first) GTEST_SKIP() << "allocations are counted elsewhere in this program";
  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    const Vec2d from = crowd.random.within(15), way = crowd.random.within(30);
    met += ray_cast_closest(crowd.world, from, way).has_value();
    met += cast_shape_closest(crowd.world, shape, from, 1, way).has_value();
    met += cast_shape_closest(crowd.world, Capsule{{0, 0}, {0, 1}, 0.5}, from, 1, way).has_value();
    met += nearest(crowd.world, from, 100).has_value();
    overlap_box(crowd.world, {from, from + Vec2d{1, 1}}, {}, [&](ShapeId) { return ++met, true; });
    shapes_at(crowd.world, from, {}, [&](ShapeId) { return ++met, true; });
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(met, 200);
}

}  // namespace
}  // namespace plumb
