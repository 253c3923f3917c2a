#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>
#include <vector>

#include "engine/collision/distance/distance.h"
#include "engine/collision/distance/ray_cast.h"
#include "engine/collision/distance/shape_cast.h"
#include "engine/collision/distance/time_of_impact.h"
#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

/// FNV-1a over the bits of numbers.
class Hash {
 public:
  void add(double value) {
    for (int shift = 0; shift < 64; shift += 8)
      hash_ = (hash_ ^ (std::bit_cast<std::uint64_t>(value) >> shift & 0xFF)) * 0x100000001B3ull;
  }
  template <class Real>
  void add(Vec2<Real> v) {
    add(static_cast<double>(v.x));
    add(static_cast<double>(v.y));
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325ull;
};

/// Inputs from integers and the engine's own rotations: no library function has a say.
template <class Real>
class Inputs {
 public:
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) * 0x1p-32);
  }
  Rotation<Real> rotation() { return rotation_of(static_cast<Real>(uniform(-4, 4))); }
  Vec2<Real> point(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size);
    return {static_cast<Real>(x), static_cast<Real>(y)};
  }
  /// Corners on a circle.
  std::vector<Corner<Real>> corners() {
    const int count = 1 + static_cast<int>(engine_() % 8u);
    std::vector<Corner<Real>> out;
    for (int i = 0; i < count; ++i) {
      const auto q = rotation_of(6.283185307179586 * (i + uniform(-0.3, 0.3)) / count);
      const auto n = rotation_of(6.283185307179586 * (i + 0.5) / count);
      out.push_back({Vec2d{q.c, q.s}.as<Real>(), Vec2d{n.c, n.s}.as<Real>()});
    }
    return out;
  }

 private:
  std::mt19937 engine_{1};
};

template <class Real>
std::uint64_t hash_of_queries() {
  Inputs<Real> in;
  Hash hash;
  for (int k = 0; k < 3000; ++k) {
    const auto corners_a = in.corners(), corners_b = in.corners();
    const Convex<Real> a{corners_a.data(), static_cast<int>(corners_a.size()),
                         k % 3 == 0 ? Real(0.25) : Real(0)};
    const Convex<Real> b{corners_b.data(), static_cast<int>(corners_b.size()),
                         k % 5 == 0 ? Real(0.125) : Real(0)};
    const Pose<Real> pose{in.point(3), in.rotation()};
    const Vec2<Real> way = in.point(6);
    const auto apart = distance(a, b, pose);
    hash.add(apart.point_a), hash.add(apart.point_b), hash.add(apart.normal);
    hash.add(static_cast<double>(apart.distance));
    const auto cast = shape_cast(a, b, pose, way);
    hash.add(cast.point), hash.add(cast.normal), hash.add(static_cast<double>(cast.fraction));
    const auto ray = ray_cast(a, pose.position, way);
    hash.add(ray.point), hash.add(ray.normal), hash.add(static_cast<double>(ray.fraction));
    const auto nearest = nearest_point(a, pose.position);
    hash.add(nearest.point), hash.add(nearest.normal), hash.add(static_cast<double>(nearest.distance));
    const Sweep<Real> sweep_a{{}, in.point(1), in.rotation(), static_cast<Real>(in.uniform(-3, 3))};
    const Sweep<Real> sweep_b{pose.position, way, pose.rotation, static_cast<Real>(in.uniform(-3, 3))};
    const auto impact = time_of_impact(a, sweep_a, b, sweep_b, Real(0.01), Real(0.001));
    hash.add(impact.point), hash.add(impact.normal), hash.add(impact.exact_fraction);
    hash.add(static_cast<double>(impact.fraction) + static_cast<int>(impact.state));
  }
  return hash.value();
}

// The same bits from every compiler, at every level of optimisation, for ever: snapshots and replays need it.
TEST(QueryBits, AreTheSameEverywhere) {
  EXPECT_EQ(hash_of_queries<float>(), 17460100451363867569ull);
  EXPECT_EQ(hash_of_queries<double>(), 15674531486745421182ull);
}

}  // namespace
}  // namespace plumb
