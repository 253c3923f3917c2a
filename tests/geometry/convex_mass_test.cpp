#include "engine/geometry/convex_mass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/geometry/convex_hull.h"

namespace plumb {
namespace {

ConvexMass mass_of(const Corners& corners, double radius, double density = 1) {
  return convex_mass({corners.data(), static_cast<int>(corners.size()), radius}, density);
}

/// Within a few roundings; `places` in units of 2^-52 of the value.
void expect_mass(const ConvexMass& found, double mass, Vec2d centroid, double inertia, double size,
                 double places = 4) {
  const double rounding = places * 0x1p-52;
  EXPECT_NEAR(found.mass, mass, rounding * mass);
  EXPECT_NEAR(found.inertia, inertia, rounding * inertia);
  EXPECT_NEAR(found.centroid.x, centroid.x, rounding * size);
  EXPECT_NEAR(found.centroid.y, centroid.y, rounding * size);
}

constexpr double kSizes[] = {1e-3, 1.0, 1e3};

TEST(ConvexMass, Disc) {
  for (const double r : kSizes)
    expect_mass(mass_of(disc_corner({3 * r, -r}), r, 7), 7 * M_PI * r * r, {3 * r, -r},
                7 * M_PI * r * r * r * r / 2, r);
}

TEST(ConvexMass, BoxAnywhereAtAnyAngle) {
  for (const double size : kSizes) {
    const double w = 2 * size, h = size, mass = 3 * w * h;
    expect_mass(mass_of(box_corners(w / 2, h / 2), 0, 3), mass, {0, 0}, mass * (w * w + h * h) / 12, size);
    const Vec2d center{20 * size, -5 * size};
    expect_mass(mass_of(box_corners(w / 2, h / 2, center, {0.8, 0.6}), 0, 3), mass, center,
                mass * (w * w + h * h) / 12, 20 * size, 40);
  }
}

// I of a right triangle about its centroid: m (a^2 + b^2) / 18.
TEST(ConvexMass, RightTriangle) {
  for (const double size : kSizes) {
    const double a = 3 * size, b = 4 * size, mass = a * b / 2;
    const Corners triangle = convex_hull(std::vector<Vec2d>{{0, 0}, {a, 0}, {0, b}});
    expect_mass(mass_of(triangle, 0), mass, {a / 3, b / 3}, mass * (a * a + b * b) / 18, size, 8);
  }
}

// I of a regular n-gon of circumradius R: m R^2 (2 + cos(2 pi/n)) / 6.
TEST(ConvexMass, RegularPolygons) {
  for (const int n : {3, 5, 8, 17, 64}) {
    std::vector<Vec2d> points;
    for (int i = 0; i < n; ++i) points.push_back({std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n)});
    const double mass = n * std::sin(2 * M_PI / n) / 2;
    expect_mass(mass_of(convex_hull(points), 0), mass, {0, 0}, mass * (2 + std::cos(2 * M_PI / n)) / 6, 1,
                12);
  }
}

// A rectangle and two half-discs, whose centroids lie 4 r / (3 pi) from their flat sides.
TEST(ConvexMass, Capsule) {
  for (const double size : kSizes) {
    const double r = 0.3 * size, length = 2 * size;
    const double middle = length * 2 * r, caps = M_PI * r * r;
    const double offset = 4 * r / (3 * M_PI);
    const double half_disc = r * r / 2 - offset * offset;  // about its own centroid, of unit mass
    const double out = length / 2 + offset;
    const double inertia = middle * (length * length + 4 * r * r) / 12 + caps * (half_disc + out * out);
    const Vec2d first{size, size}, second{size + 1.2 * size, size + 1.6 * size};
    expect_mass(mass_of(capsule_corners(first, second), r), middle + caps, 0.5 * (first + second), inertia,
                3 * size, 8);
  }
}

// A rounded box: a cross of rectangles and four quarter discs. About the quarter's corner I = pi r^4 / 8.
TEST(ConvexMass, RoundedBox) {
  const double w = 1.2, h = 0.7, r = 0.25;
  const double core = w * h, sides = 2 * w * r, ends = 2 * h * r, corners = M_PI * r * r;
  const double offset = 4 * r / (3 * M_PI);  // a quarter disc's centroid, along x and along y
  const double quarter = r * r / 2 - 2 * offset * offset;
  const double x = w / 2 + offset, y = h / 2 + offset;
  const double inertia =
      core * (w * w + h * h) / 12 + sides * ((w * w + r * r) / 12 + (h / 2 + r / 2) * (h / 2 + r / 2)) +
      ends * ((h * h + r * r) / 12 + (w / 2 + r / 2) * (w / 2 + r / 2)) + corners * (quarter + x * x + y * y);
  expect_mass(mass_of(box_corners(w / 2, h / 2, {1, 2}, {0.6, 0.8}), r, 2),
              2 * (core + sides + ends + corners), {1, 2}, 2 * inertia, 2, 8);
}

/// The length of the shape along a vertical line, and moments along it, by the distance to its outline.
bool inside(const Corners& corners, double radius, Vec2d p) {
  bool within = true;
  double nearest = INFINITY;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2d u = corners[i].point, edge = corners[(i + 1) % corners.size()].point - u;
    if (cross(edge, p - u) < 0) within = false;
    const double share = std::clamp(dot(p - u, edge) / length_squared(edge), 0.0, 1.0);
    nearest = std::min(nearest, length_squared(p - u - share * edge));
  }
  return within || nearest <= radius * radius;
}

// An irregular shape: truth is a fine midpoint sum, which converges as the square of the mesh for smooth
// parts and meets the outline with an error of about mesh^1.5.
TEST(ConvexMass, IrregularRoundedPolygonByDenseSampling) {
  const Corners corners =
      convex_hull(std::vector<Vec2d>{{0, 0}, {1, -0.2}, {1.5, 0.6}, {0.7, 1.1}, {-0.1, 0.8}});
  const double radius = 0.2, mesh = 1e-3;
  double area = 0, polar = 0;
  Vec2d first{};
  for (double x = -0.5 + mesh / 2; x < 2; x += mesh)
    for (double y = -0.5 + mesh / 2; y < 1.5; y += mesh)
      if (inside(corners, radius, {x, y})) {
        area += mesh * mesh;
        first += mesh * mesh * Vec2d{x, y};
        polar += mesh * mesh * (x * x + y * y);
      }
  const Vec2d centroid = (1 / area) * first;
  const ConvexMass found = mass_of(corners, radius);
  EXPECT_NEAR(found.mass, area, 1e-4);
  EXPECT_NEAR(found.centroid.x, centroid.x, 1e-4);
  EXPECT_NEAR(found.centroid.y, centroid.y, 1e-4);
  EXPECT_NEAR(found.inertia, polar - area * length_squared(centroid), 1e-4);
}

// The rounded polygon of radius r has the area A + L r + pi r^2 (Steiner's formula).
TEST(ConvexMass, SteinersFormula) {
  const std::vector<Vec2d> points{{0, 0}, {1, -0.2}, {1.5, 0.6}, {0.7, 1.1}, {-0.1, 0.8}};
  double perimeter = 0;
  for (std::size_t i = 0; i < 5; ++i) perimeter += std::sqrt(length_squared(points[(i + 1) % 5] - points[i]));
  const Corners corners = convex_hull(points);
  const double area = mass_of(corners, 0).mass;
  for (const double r : {1e-3, 0.1, 10.0})
    EXPECT_NEAR(mass_of(corners, r).mass, area + perimeter * r + M_PI * r * r,
                1e-15 * (2 + 2 * M_PI * r * r));
}

TEST(ConvexMass, WithoutAreaThereIsNoMass) {
  const ConvexMass segment = mass_of(capsule_corners({0, 0}, {2, 4}), 0);
  EXPECT_EQ(segment.mass, 0);
  EXPECT_EQ(segment.inertia, 0);
  EXPECT_EQ(segment.centroid, (Vec2d{1, 2}));
  const ConvexMass point = mass_of(disc_corner({1, 2}), 0);
  EXPECT_EQ(point.mass, 0);
  EXPECT_EQ(point.centroid, (Vec2d{1, 2}));
}

}  // namespace
}  // namespace plumb
