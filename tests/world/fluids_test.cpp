#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/forces/submerged.h"
#include "engine/forces/wind.h"
#include "engine/world/force_laws.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDt = 1.0 / 60;

template <class Real>
class Floating : public testing::Test {
 public:
  using World = BasicWorld<Real>;
  static constexpr bool kSingle = std::is_same_v<Real, float>;
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Floating, Reals);

// Rounded shapes against sums over many small pieces of the outline.
TEST(Wind, OnRoundedShapesIsTheIntegralOfThePressure) {
  const Corner<double> corners[3] = {{{-1, -0.5}, {0, 0}}, {{1.2, -0.3}, {0, 0}}, {{0.1, 0.9}, {0, 0}}};
  for (int count = 1; count <= 3; ++count) {
    Corner<double> shape[3];
    for (int i = 0; i < count; ++i) {
      const Vec2d way = corners[(i + 1) % count].point - corners[i].point;
      const double length = std::sqrt(length_squared(way));
      shape[i] = {corners[i].point, length > 0 ? (-1 / length) * perpendicular(way) : Vec2d{}};
    }
    for (int turn = 0; turn < 12; ++turn) {
      const Vec2d flow{3 * std::cos(0.4 + turn * kPi / 6), 3 * std::sin(0.4 + turn * kPi / 6)};
      Vec2d force{};
      double torque = 0;
      const auto press = [&](Vec2d normal, double length, Vec2d at) {
        const double into = -dot(flow, normal);
        if (into <= 0) return;
        const Vec2d f = (-0.6 * into * into * length) * normal;
        force += f, torque += cross(at, f);
      };
      for (int i = 0; i < count && count > 1; ++i) {
        const Vec2d way = shape[(i + 1) % count].point - shape[i].point;
        press(shape[i].normal, std::sqrt(length_squared(way)), shape[i].point + 0.5 * way);
      }
      for (int i = 0; i < count; ++i) {
        const Vec2d from = shape[(i + count - 1) % count].normal, to = shape[i].normal;
        double start = std::atan2(from.y, from.x), sweep = std::atan2(cross(from, to), dot(from, to));
        if (count == 1) sweep = 2 * kPi;
        if (sweep <= 0) sweep += 2 * kPi;
        const int pieces = 20000;
        for (int k = 0; k < pieces; ++k) {
          const double angle = start + (k + 0.5) * sweep / pieces;
          const Vec2d normal{std::cos(angle), std::sin(angle)};
          press(normal, 0.3 * sweep / pieces, shape[i].point);
        }
      }
      const WindLoad load = wind_load({flow, 1.2}, {shape, count, 0.3}, {0, 0}, 0);
      EXPECT_NEAR(load.wrench.force.x, force.x, 3e-8) << count << ' ' << turn;
      EXPECT_NEAR(load.wrench.force.y, force.y, 3e-8);
      EXPECT_NEAR(load.wrench.torque, torque, 3e-8);
      EXPECT_NEAR(load.power, dot(force, flow), 1e-7);
    }
  }
}

// Strips of the hull of discs: the width at a height y is found by bisection of a distance in long double.
bool inside(const std::vector<Vec2d>& hull, double radius, double x, double y) {
  const Vec2d p{x, y};
  bool in_hull = hull.size() > 2;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2d a = hull[i], b = hull[(i + 1) % hull.size()];
    const Vec2d way = b - a;
    const double size = length_squared(way);
    const double share = size > 0 ? std::clamp(dot(p - a, way) / size, 0.0, 1.0) : 0;
    if (length_squared(p - a - share * way) <= radius * radius) return true;
    if (cross(way, p - a) < 0) in_hull = false;
  }
  return in_hull;
}

TEST(Submerged, MatchesStripsOfRoundedShapes) {
  const std::vector<std::vector<Vec2d>> hulls = {
      {{0.3, 0.1}}, {{-0.6, -0.2}, {0.7, 0.4}}, {{-0.5, -0.4}, {0.8, -0.3}, {0.6, 0.5}, {-0.2, 0.7}}};
  for (const auto& hull : hulls) {
    for (const double radius : {0.0, 0.25}) {
      if (hull.size() < 3 && radius == 0) continue;
      for (double level = -1; level <= 1.2; level += 0.1) {
        long double area = 0, moment_x = 0, moment_y = 0;
        const int strips = 2000;
        const double low = -1.2, high = std::min(level, 1.2);
        for (int i = 0; i < strips && high > low; ++i) {
          const double y = low + (i + 0.5) * (high - low) / strips;
          // Convex: one interval; its inside is found on a coarse grid, its ends by bisection.
          double seed = 9;
          for (double x = -1.2; x <= 1.2 && seed == 9; x += 0.005) {
            if (inside(hull, radius, x, y)) seed = x;
          }
          if (seed == 9) continue;
          const auto end = [&](double out) {
            double in = seed;
            for (int k = 0; k < 40; ++k) {
              const double middle = 0.5 * (in + out);
              (inside(hull, radius, middle, y) ? in : out) = middle;
            }
            return in;
          };
          const double left = end(-1.3), right = end(1.3), strip = (right - left) * (high - low) / strips;
          area += strip, moment_x += strip * 0.5 * (left + right), moment_y += strip * y;
        }
        std::vector<Corner<double>> corners;
        for (std::size_t i = 0; i < hull.size(); ++i) {
          const Vec2d way = hull[(i + 1) % hull.size()] - hull[i];
          const double length = std::sqrt(length_squared(way));
          corners.push_back(
              {hull[i] - Vec2d{0, level}, length > 0 ? (-1 / length) * perpendicular(way) : Vec2d{}});
        }
        const Submerged part = submerged_part({corners.data(), static_cast<int>(hull.size()), radius});
        // Strips of 1.2 mm: their ends cost up to a strip's area, (width 1) x 1.2e-3 / 50 on the average.
        EXPECT_NEAR(part.area, static_cast<double>(area), 4e-5)
            << hull.size() << ' ' << radius << ' ' << level;
        EXPECT_NEAR(part.area * part.centroid.x, static_cast<double>(moment_x), 4e-5);
        EXPECT_NEAR(part.area * (part.centroid.y + level), static_cast<double>(moment_y), 4e-5);
      }
    }
  }
}

template <class Real>
void settle(BasicWorld<Real>& world, const Water& water) {
  for (int i = 0; i < 1500; ++i) {
    apply_water(world, water, kDt);
    world.step(kDt);
  }
}

TYPED_TEST(Floating, FloatingBodiesSettleWhereTheyDisplaceTheirOwnMass) {
  typename TestFixture::World world(without_sleep());
  const Water water{.level = 2, .density = 1000, .linear_drag = 3000, .angular_drag = 1000};
  const BodyId box = add_box(world, {0, 2}, 300, 2, 1);
  const BodyId disc = add_body(world, {10, 2}, {.geometry = Circle{0.5}, .density = 250});
  const BodyId half = add_body(world, {20, 3}, {.geometry = Circle{0.5}, .density = 500});
  settle(world, water);
  const double tolerance = TestFixture::kSingle ? 1e-6 : 1e-12;
  // A box of density 0.3 has 0.3 of its height under water.
  EXPECT_NEAR(world.centre(box).y, 2 + 0.5 - 0.3, tolerance);
  EXPECT_NEAR(world.angle(box), 0, tolerance);
  EXPECT_NEAR(world.centre(half).y, 2, tolerance);
  // A segment with half the central angle t has area r^2 (t - sin t cos t): a quarter of the disc.
  long double low = 0, high = kPi;
  for (int i = 0; i < 80; ++i) {
    const long double t = 0.5L * (low + high);
    (t - std::sin(t) * std::cos(t) < 0.25L * kPi ? low : high) = t;
  }
  EXPECT_NEAR(world.centre(disc).y, 2 + 0.5 * static_cast<double>(std::cos(low)), tolerance);
}

TYPED_TEST(Floating, AFloatingBoxBobsWithTheHydrostaticPeriod) {
  typename TestFixture::World world(without_sleep());
  const BodyId box = add_box(world, {0, 0.3}, 500, 2, 1);
  // m y'' = -rho g b y, with m = rho/2 b h: omega^2 = 2 g / h; the step's own period by its discrete law.
  const double omega = std::sqrt(2 * kGravity), theta = std::acos(1 - 0.5 * omega * omega * kDt * kDt);
  for (int i = 1; i <= 300; ++i) {
    apply_water(world, {.density = 1000}, kDt);
    world.step(kDt);
    ASSERT_NEAR(world.centre(box).y, 0.3 * std::cos(i * theta), TestFixture::kSingle ? 2e-4 : 1e-11);
  }
}

TYPED_TEST(Floating, WaterLiesAcrossGravity) {
  typename TestFixture::World world({.gravity = {-6, -8}, .sleeping = false});
  const BodyId disc = add_body(world, {0, 0}, {.geometry = Circle{0.5}, .density = 500});
  settle(world, {.level = 5, .density = 1000, .linear_drag = 3000});
  EXPECT_NEAR(0.6 * world.centre(disc).x + 0.8 * world.centre(disc).y, 5,
              TestFixture::kSingle ? 2e-6 : 1e-12);
  EXPECT_NEAR(0.8 * world.centre(disc).x - 0.6 * world.centre(disc).y, 0,
              TestFixture::kSingle ? 2e-6 : 1e-12);
}

}  // namespace
}  // namespace plumb
