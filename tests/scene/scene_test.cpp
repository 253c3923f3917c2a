#include "engine/scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "engine/scene/json.h"

namespace plumb {
namespace {

TEST(Inertia, OfOneShape) {
  Body body{.name = "b", .mass = 3};
  body.shapes = {Shape{.geometry = Circle{0.5}}};
  EXPECT_DOUBLE_EQ(inertia_of(body), 0.375);  // m r^2 / 2
  body.shapes = {Shape{.geometry = Box{3, 4}}};
  EXPECT_DOUBLE_EQ(inertia_of(body), 6.25);  // m (w^2 + h^2) / 12
  body.shapes[0].angle = 0.7;
  EXPECT_DOUBLE_EQ(inertia_of(body), 6.25);
  body.shapes[0].position = {3, 4};
  EXPECT_DOUBLE_EQ(inertia_of(body), 81.25);  // + m d^2
}

TEST(Inertia, GivenFixedOrOfABodyThatForcesDoNotTurn) {
  Body body{.name = "b", .mass = 3, .shapes = {Shape{.geometry = Circle{0.5}}}};
  body.inertia = 7;
  EXPECT_EQ(inertia_of(body), 7);
  body.type = BodyType::Static;
  EXPECT_EQ(inertia_of(body), 0);
  body.type = BodyType::Kinematic;
  EXPECT_EQ(inertia_of(body), 0);
  body.type = BodyType::Dynamic;
  body.fixed_rotation = true;
  EXPECT_EQ(inertia_of(body), 0);
}

TEST(Inertia, OverlapsCountTwice) {
  Body body{
      .name = "b", .mass = 3, .shapes = {Shape{.geometry = Circle{0.5}}, Shape{.geometry = Circle{0.5}}}};
  EXPECT_DOUBLE_EQ(inertia_of(body), 0.375);
}

struct Moments {
  double area = 0;
  double second = 0;  ///< integral of |r|^2 over the area, about the body's origin
};

/// Gauss's rule with three points on [-1, 1], exact up to degree 5.
constexpr double kNodes[] = {-0.774596669241483377, 0, 0.774596669241483377};
constexpr double kWeights[] = {5.0 / 9, 8.0 / 9, 5.0 / 9};

Vec2d placed(const Shape& shape, double x, double y) {
  const double c = std::cos(shape.angle), s = std::sin(shape.angle);
  return shape.position + Vec2d{c * x - s * y, s * x + c * y};
}

Moments quadrature(const Shape& shape, const Box& box) {
  Moments sum;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double weight = kWeights[i] * kWeights[j] * box.width * box.height / 4;
      sum.area += weight;
      sum.second +=
          weight * length_squared(placed(shape, kNodes[i] * box.width / 2, kNodes[j] * box.height / 2));
    }
  }
  return sum;
}

/// Polar coordinates: r^3 is exact in Gauss's rule, and eight equal angles integrate the harmonics up to 7.
Moments quadrature(const Shape& shape, const Circle& circle) {
  Moments sum;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 8; ++j) {
      const double r = circle.radius * (1 + kNodes[i]) / 2, angle = std::numbers::pi * j / 4;
      const double weight = kWeights[i] * circle.radius / 2 * r * std::numbers::pi / 4;
      sum.area += weight;
      sum.second += weight * length_squared(placed(shape, r * std::cos(angle), r * std::sin(angle)));
    }
  }
  return sum;
}

TEST(Inertia, AgreesWithQuadrature) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> size(0.1, 3), place(-5, 5);
  for (int i = 0; i < 1000; ++i) {
    Body body{.name = "b", .mass = size(random)};
    Moments sum;
    for (std::uint64_t n = 1 + random() % 5; n > 0; --n) {
      Shape shape{.geometry = {}, .position = {place(random), place(random)}, .angle = place(random)};
      if (random() % 2 == 0) {
        shape.geometry = Circle{size(random)};
      } else {
        shape.geometry = Box{size(random), size(random)};
      }
      const Circle* circle = std::get_if<Circle>(&shape.geometry);
      const Moments more =
          circle ? quadrature(shape, *circle) : quadrature(shape, std::get<Box>(shape.geometry));
      sum.area += more.area;
      sum.second += more.second;
      body.shapes.push_back(shape);
    }
    const double expected = body.mass / sum.area * sum.second;
    // Up to 5 x 24 terms, all positive, with a few roundings of 1.1e-16 each, mostly cancelling;
    // seen: 6.7e-16.
    EXPECT_NEAR(inertia_of(body), expected, 2e-15 * expected);
  }
}

/// Sums over strips of 1/2000 of the height, each from the distance to the shape itself: whether a point is
/// in.
Extent brute_force(double low, double high, const std::function<bool(Vec2d)>& inside) {
  constexpr int kStrips = 1000;
  const double step = (high - low) / kStrips;
  double area = 0, second = 0;
  Vec2d first{};
  for (int i = 0; i < kStrips; ++i) {
    for (int j = 0; j < kStrips; ++j) {
      const Vec2d at{low + (i + 0.5) * step, low + (j + 0.5) * step};
      if (!inside(at)) continue;
      area += step * step;
      first += step * step * at;
      second += step * step * length_squared(at);
    }
  }
  const Vec2d centroid = (1 / area) * first;
  return {area, centroid, second / area - length_squared(centroid)};
}

double distance_to(Vec2d point, Vec2d a, Vec2d b) {
  const double share = std::clamp(dot(point - a, b - a) / length_squared(b - a), 0.0, 1.0);
  return std::sqrt(length_squared(point - a - share * (b - a)));
}

/// Squares of side 0.006 that the outline of 15 m cuts are counted whole or not: 2500 of them, of random
/// sign.
void expect_extent(const Geometry& geometry, const std::function<bool(Vec2d)>& inside) {
  const Extent expected = brute_force(-3, 3, inside), given = extent_of(geometry);
  EXPECT_NEAR(given.area, expected.area, 2e-3);
  EXPECT_NEAR(given.centroid.x, expected.centroid.x, 5e-4);
  EXPECT_NEAR(given.centroid.y, expected.centroid.y, 5e-4);
  EXPECT_NEAR(given.gyration_squared, expected.gyration_squared, 1e-3);
}

TEST(Extent, IsThatOfThePointsInside) {
  const Vec2d a{-1, 0.5}, b{1.5, -0.25};
  expect_extent(Capsule{a, b, 0.75}, [&](Vec2d p) { return distance_to(p, a, b) <= 0.75; });
  const Vec2d corners[] = {{-1, -1}, {1.5, -0.5}, {0.5, 1.25}};
  for (const double radius : {0.0, 0.5}) {
    expect_extent(Polygon{{corners[2], corners[0], corners[1], {0, 0}}, radius}, [&](Vec2d p) {
      bool inside = true;
      double nearest = 10;
      for (int i = 0; i < 3; ++i) {
        const Vec2d from = corners[i], to = corners[(i + 1) % 3];
        inside = inside && cross(to - from, p - from) >= 0;
        nearest = std::min(nearest, distance_to(p, from, to));
      }
      return inside || nearest <= radius;
    });
  }
}

/// Known closed forms: a polygon that is a box, and a capsule without length.
TEST(Extent, AgreesWithSimplerShapes) {
  const Extent box = extent_of(Box{3, 2}),
               polygon = extent_of(Polygon{{{-1.5, -1}, {1.5, -1}, {1.5, 1}, {-1.5, 1}}});
  EXPECT_NEAR(polygon.area, box.area, 1e-14);
  EXPECT_NEAR(polygon.gyration_squared, box.gyration_squared, 1e-14);
  const Extent disc = extent_of(Circle{0.7}), dot = extent_of(Capsule{{1, 2}, {1, 2}, 0.7});
  EXPECT_NEAR(dot.area, disc.area, 1e-15);
  EXPECT_EQ(dot.centroid, (Vec2d{1, 2}));
  EXPECT_NEAR(dot.gyration_squared, disc.gyration_squared, 1e-15);
  for (const Geometry& line : {Geometry(Segment{{0, 0}, {1, 0}}), Geometry(Chain{{{0, 0}, {1, 0}}})})
    EXPECT_EQ(extent_of(line).area, 0);
}

/// A lollipop of two densities: masses and parallel axes by hand.
TEST(Inertia, FollowsDensities) {
  Body body{.name = "b"};
  body.shapes = {{.geometry = Circle{1}, .position = {0, 2}, .density = 3},
                 {.geometry = Box{0.5, 2}, .position = {0, 0.5}, .density = 7}};
  const double disc = 3 * std::numbers::pi, stick = 7;
  EXPECT_NEAR(*mass_by_density(body), disc + stick, 1e-14);
  body.mass = *mass_by_density(body);
  EXPECT_NEAR(inertia_of(body), disc * (0.5 + 4) + stick * ((0.25 + 4) / 12 + 0.25), 1e-13);
}

TEST(Combine, Rules) {
  EXPECT_DOUBLE_EQ(combine(Combine::GeometricMean, 0.2, 0.8), 0.4);
  EXPECT_EQ(combine(Combine::GeometricMean, 0, 0.8), 0);
  EXPECT_DOUBLE_EQ(combine(Combine::Product, 0.5, 0.8), 0.4);
  EXPECT_EQ(combine(Combine::Maximum, 0.2, 0.8), 0.8);
  EXPECT_EQ(combine(Combine::Minimum, 0.2, 0.8), 0.2);
  EXPECT_DOUBLE_EQ(combine(Combine::Average, 0.2, 0.8), 0.5);
}

TEST(Combine, KnowsNoOrder) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> coefficient(0, 2);
  for (const Combine rule :
       {Combine::GeometricMean, Combine::Product, Combine::Maximum, Combine::Minimum, Combine::Average}) {
    for (int i = 0; i < 100; ++i) {
      const double a = coefficient(random), b = coefficient(random);
      EXPECT_EQ(combine(rule, a, b), combine(rule, b, a));
      if (rule != Combine::Product) {
        EXPECT_EQ(combine(rule, a, a), a);
      }
    }
  }
}

TEST(Filter, CategoriesMustWantEachOther) {
  EXPECT_TRUE(may_touch({}, {}));
  EXPECT_TRUE(may_touch({2, 4, 0}, {4, 2, 0}));
  EXPECT_FALSE(may_touch({2, 4, 0}, {4, 1, 0}));
  EXPECT_FALSE(may_touch({4, 1, 0}, {2, 4, 0}));
  EXPECT_FALSE(may_touch({0, 0xFFFFFFFFu, 0}, {}));
}

TEST(Filter, EqualGroupsDecideFirst) {
  EXPECT_TRUE(may_touch({1, 0, 5}, {1, 0, 5}));
  EXPECT_FALSE(may_touch({1, 1, -5}, {1, 1, -5}));
  EXPECT_TRUE(may_touch({1, 1, -5}, {1, 1, -4}));
  EXPECT_FALSE(may_touch({1, 0, 5}, {1, 0, 4}));
  EXPECT_FALSE(may_touch({1, 0, 0}, {1, 0, 0}));
}

TEST(Scene, FindsBodies) {
  Scene scene;
  scene.bodies = {{.name = "a"}, {.name = "b"}};
  EXPECT_EQ(find_body(scene, "a"), 0u);
  EXPECT_EQ(find_body(scene, "b"), 1u);
  EXPECT_EQ(find_body(scene, "c"), std::nullopt);
  EXPECT_EQ(find_body(scene, kWorld), std::nullopt);
}

TEST(Scene, StartsAsItSays) {
  const Body body{.name = "a", .position = {1, 2}, .angle = 3, .velocity = {4, 5}, .angular_velocity = 6};
  EXPECT_EQ(initial_state(body), (BodyState{{1, 2}, 3, {4, 5}, 6}));
}

TEST(Hash, IsThatOfTheOneLineText) {
  const Scene scene{.name = "a"};
  EXPECT_EQ(to_json(scene, -1),
            R"({"plumb_scene":1,"name":"a","gravity":[0,-9.81],"contact_rules":{"friction":"geometric_mean",)"
            R"("restitution":"maximum","restitution_threshold":0},"bodies":[],"joints":[],"forces":[]})");
  EXPECT_EQ(hash(scene), 0x6ac636f8459aa2a8u);  // FNV-1a of that text by another program
}

TEST(Hash, TellsEveryBitApart) {
  const Scene scene{.name = "a"};
  Scene other = scene;
  EXPECT_EQ(hash(scene), hash(other));
  other.gravity.y = std::nextafter(other.gravity.y, 0.0);
  EXPECT_NE(hash(scene), hash(other));
  other = scene;
  other.gravity.x = -0.0;
  EXPECT_EQ(scene, other);
  EXPECT_NE(hash(scene), hash(other));
}

}  // namespace
}  // namespace plumb
