#include "bench/field/mass.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "bench/field/gap.h"

namespace plumb::field {
namespace {

MassProperties mass_of_one(const Geometry& geometry, double density = 1) {
  const ShapeDefinition shape{.geometry = geometry, .density = density};
  return mass_of(std::span(&shape, 1));
}

TEST(MassOf, BoxAndDisc) {
  const MassProperties square = mass_of_one(box(0.5, 1, {3, -2}), 2);
  EXPECT_NEAR(square.mass, 4, 1e-14);
  EXPECT_NEAR(square.centre.x, 3, 1e-14);
  EXPECT_NEAR(square.centre.y, -2, 1e-14);
  EXPECT_NEAR(square.inertia, 4.0 / 12 * (1 + 4), 1e-13);
  const MassProperties disc = mass_of_one(Circle{{1, 0}, 2}, 3);
  EXPECT_NEAR(disc.mass, 12 * std::numbers::pi, 1e-13);
  EXPECT_NEAR(disc.inertia, disc.mass * 2, 1e-12);
}

TEST(MassOf, StaticThingsHaveNone) { EXPECT_EQ(mass_of_one(Segment{{0, 0}, {1, 0}}).mass, 0); }

/// Computes the mass by counting the midpoints of a fine grid that lie inside.
MassProperties by_counting(const Geometry& geometry) {
  const PlacedShape shape = place(geometry, {});
  const int n = 1200;
  const double side = 3.0 / n;
  long double mass = 0, x = 0, y = 0, polar = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Vec2d p{-1.5 + (i + 0.5) * side, -1.5 + (j + 0.5) * side};
      if (gap(shape, {{p}, 0}) > 0) continue;
      mass += 1, x += p.x, y += p.y, polar += length_squared(p) + side * side / 6;
    }
  }
  const double cell = side * side;
  const Vec2d centre{static_cast<double>(x / mass), static_cast<double>(y / mass)};
  return {static_cast<double>(mass) * cell, centre,
          static_cast<double>(polar) * cell - static_cast<double>(mass) * cell * length_squared(centre)};
}

TEST(MassOf, RoundedShapesAgreeWithCounting) {
  for (const Geometry& geometry :
       {Geometry(Capsule{{-0.6, 0.1}, {0.5, 0.4}, 0.3}), Geometry(box(0.4, 0.7, {0.2, 0}, 0.2)),
        Geometry(Polygon{{{-0.8, -0.5}, {0.6, -0.6}, {0.1, 0.7}}, 0.25}),
        Geometry(Polygon{{{-0.8, -0.5}, {0.6, -0.6}, {0.1, 0.7}}, 0})}) {
    const MassProperties exact = mass_of_one(geometry), counted = by_counting(geometry);
    // Cells cut by the edge err by half a cell each way; most of it cancels.
    EXPECT_NEAR(exact.mass, counted.mass, 4e-4);
    EXPECT_NEAR(exact.centre.x, counted.centre.x, 3e-4);
    EXPECT_NEAR(exact.centre.y, counted.centre.y, 3e-4);
    EXPECT_NEAR(exact.inertia, counted.inertia, 4e-4);
  }
}

TEST(MassOf, PartsOfACompoundAddUp) {
  const std::vector<ShapeDefinition> halves{{.geometry = box(0.5, 0.5, {-0.5, 0}), .density = 2},
                                            {.geometry = box(0.5, 0.5, {0.5, 0}), .density = 2}};
  const MassProperties whole = mass_of_one(box(1, 0.5), 2), sum = mass_of(halves);
  EXPECT_NEAR(sum.mass, whole.mass, 1e-14);
  EXPECT_NEAR(sum.centre.x, 0, 1e-14);
  EXPECT_NEAR(sum.inertia, whole.inertia, 1e-14);
}

}  // namespace
}  // namespace plumb::field
