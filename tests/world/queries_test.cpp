#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "engine/world/queries.h"

#include <gtest/gtest.h>

#include "tests/world/query_crowd.h"

namespace plumb {
namespace {

using namespace query_truth;

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

// Tiles whose sides coincide up to rounding: a ray along their common side meets the top of one of them, and
// never the gap. Shapes of one body and bodies side by side, boxes, polygons and segments, turned by any
// angle.
TYPED_TEST(Queries, RaysDoNotSlipThroughSeams) {
  std::mt19937 from(3);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(from()) * 0x1p-32);
  };
  for (int run = 0; run < 600; ++run) {
    BasicWorld<TypeParam> world;
    const double pitch = between(0.1, 3), first = between(-50, 50),
                 angle = run % 2 == 0 ? 0 : between(0, 6.3);
    const int kind = run / 2 % 3;
    const double half = kind == 2 ? 0 : between(0.05, 1), side = pitch / 2;
    const bool one_body = run / 6 % 2 == 0;
    const ShapeGeometry kinds[] = {Box{pitch, 2 * half},
                                   Polygon{{{-side, -half}, {side, -half}, {side, half}, {-side, half}}},
                                   Segment{{-side, 0}, {side, 0}}};
    const Vec2d along{std::cos(angle), std::sin(angle)}, up{-along.y, along.x};
    const BodyId body = world.create_body({.type = BodyType::Static, .angle = angle});
    for (int i = 0; i < 10; ++i) {
      const double at = first + i * pitch;
      if (!one_body) {
        world.create_body({.type = BodyType::Static, .position = at * along, .angle = angle},
                          ShapeDefinition{.geometry = kinds[kind]});
      } else if (kind == 0) {
        world.create_shape(body, {.geometry = kinds[kind], .position = {at, 0}});
      } else if (kind == 1) {
        world.create_shape(
            body, {.geometry = Polygon{
                       {{at - side, -half}, {at + side, -half}, {at + side, half}, {at - side, half}}}});
      } else {
        world.create_shape(body, {.geometry = Segment{{at - side, 0}, {at + side, 0}}});
      }
    }
    for (int i = 0; i < 9; ++i) {
      const Vec2d seam = (first + (i + 0.5) * pitch) * along;
      const auto hit = ray_cast_closest(world, seam + 5.0 * up, -10.0 * up);
      ASSERT_TRUE(hit.has_value()) << "run " << run << " seam " << i;
      const double rounding = 8 * std::numeric_limits<TypeParam>::epsilon() * 80;  // corners up to 80 m away
      ASSERT_NEAR(10 * hit->fraction, 5 - half, rounding) << "run " << run << " seam " << i;
      ASSERT_GT(dot(hit->normal, up), 0.999) << "run " << run << " seam " << i;
    }
  }
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

}  // namespace
}  // namespace plumb
