#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "tests/collision/convex_truth.h"

namespace plumb {
namespace {

using truth::Dice;
using truth::Solid;

struct Pair {
  Corners a, b;
  double radius_a = 0, radius_b = 0;
  Pose<double> pose;
  Vec2d pivot{};  // of the contact, in the frame of a
};

Pair random_pair(Dice& dice) {
  const auto kind_a = static_cast<Dice::Kind>(dice.integer(0, 3)),
             kind_b = static_cast<Dice::Kind>(dice.integer(0, 3));
  Pair out{dice.corners(kind_a, 1), dice.corners(kind_b, 1), 0, 0, {}};
  out.radius_a = kind_a == Dice::Disc || dice.integer(0, 1) ? dice.number(0.01, 0.5) : 0;
  out.radius_b = kind_b == Dice::Disc || dice.integer(0, 1) ? dice.number(0.01, 0.5) : 0;
  const double distance = dice.number(0, 2.2);
  out.pose = {distance * dice.direction(), rotation_of(dice.number(-4, 4))};
  out.pivot = 0.5 * out.pose.position;
  return out;
}

template <class Real>
ContactManifold<Real> collide(const Pair& pair) {
  const Solid<Real> a(pair.a, pair.radius_a), b(pair.b, pair.radius_b);
  const Rotation<double> q = pair.pose.rotation;
  return collide_convex(a.view(), b.view(),
                        {pair.pose.position.as<Real>(), {static_cast<Real>(q.c), static_cast<Real>(q.s)}},
                        Real(0.3), pair.pivot.as<Real>());
}

/// Differences between two manifolds of the same pair, found in two ways; `image` takes a point of the first
/// way to the second's frame and `turn` a direction.
template <class Real>
struct Comparison {
  int pairs = 0, unlike = 0;

  template <class Image, class Turn, class Name>
  void add(const ContactManifold<Real>& first, const ContactManifold<Real>& second, Image image, Turn turn,
           Name name) {
    if (first.count == 0 && second.count == 0) return;
    ++pairs;
    const double tolerance = 64 * double{std::numeric_limits<Real>::epsilon()};
    const auto near = [&](Vec2d u, Vec2d v) { return length_squared(u - v) < tolerance * tolerance; };
    bool alike = first.count == second.count &&
                 near(turn(first.normal.template as<double>()), second.normal.template as<double>());
    for (int i = 0; alike && i < first.count; ++i) {
      bool found = false;
      for (int k = 0; k < second.count; ++k)
        found =
            found || (name(first.points[i].feature) == second.points[k].feature &&
                      near(image(first.points[i].point.template as<double>()),
                           second.points[k].point.template as<double>()) &&
                      std::fabs(first.points[i].separation - second.points[k].separation) < Real(tolerance));
      alike = found;
    }
    if (!alike) ++unlike;
  }
};

template <class Real>
class Symmetry : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Symmetry, Reals);

constexpr int kPairs = 4000;
const auto kSameName = [](std::uint16_t feature) { return feature; };

// The two shapes in each other's place. Where two faces are nearly equal, a's is preferred: then the points
// are others. Those are the few exceptions.
TYPED_TEST(Symmetry, Swapping) {
  using Real = TypeParam;
  Dice dice(21);
  Comparison<Real> comparison;
  for (int i = 0; i < kPairs; ++i) {
    const Pair pair = random_pair(dice);
    const Rotation<double> back = pair.pose.rotation.inverse();
    const Pair other{pair.b,
                     pair.a,
                     pair.radius_b,
                     pair.radius_a,
                     {-(back * pair.pose.position), back},
                     back * (pair.pivot - pair.pose.position)};
    comparison.add(
        collide<Real>(pair), collide<Real>(other), [&](Vec2d p) { return back * (p - pair.pose.position); },
        [&](Vec2d n) { return -(back * n); },
        [](std::uint16_t feature) { return static_cast<std::uint16_t>((feature & 63) << 6 | feature >> 6); });
  }
  EXPECT_GT(comparison.pairs, kPairs / 2);
  EXPECT_LT(comparison.unlike, comparison.pairs / 100);
}

// The same pair in another frame of a's body.
TYPED_TEST(Symmetry, MovingAndTurning) {
  using Real = TypeParam;
  Dice dice(22);
  Comparison<Real> comparison;
  for (int i = 0; i < kPairs; ++i) {
    const Pair pair = random_pair(dice);
    const Pose<double> move{dice.point(2), rotation_of(dice.number(-4, 4))};
    const Rotation<double> q = move.rotation, r = pair.pose.rotation;
    const Pair other{transformed(pair.a, move),
                     pair.b,
                     pair.radius_a,
                     pair.radius_b,
                     {move.position + q * pair.pose.position, {q.c * r.c - q.s * r.s, q.s * r.c + q.c * r.s}},
                     move.position + q * pair.pivot};
    comparison.add(
        collide<Real>(pair), collide<Real>(other), [&](Vec2d p) { return move.position + q * p; },
        [&](Vec2d n) { return q * n; }, kSameName);
  }
  EXPECT_LE(comparison.unlike, 8) << "ties decided by rounding, of " << comparison.pairs;
}

/// Seen in a mirror on the y axis: a counter-clockwise order again, from the same first corner.
Corners mirrored(const Corners& corners) {
  Corners out;
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2d point = corners[(n - i) % n].point, normal = corners[n - 1 - i].normal;
    out.push_back({{-point.x, point.y}, {-normal.x, normal.y}});
  }
  return out;
}

TYPED_TEST(Symmetry, Mirroring) {
  using Real = TypeParam;
  Dice dice(23);
  Comparison<Real> comparison;
  const auto flip = [](Vec2d v) { return Vec2d{-v.x, v.y}; };
  for (int i = 0; i < kPairs; ++i) {
    const Pair pair = random_pair(dice);
    const Pair other{mirrored(pair.a),
                     mirrored(pair.b),
                     pair.radius_a,
                     pair.radius_b,
                     {flip(pair.pose.position), pair.pose.rotation.inverse()},
                     flip(pair.pivot)};
    const int n = static_cast<int>(pair.a.size()), m = static_cast<int>(pair.b.size());
    comparison.add(collide<Real>(pair), collide<Real>(other), flip, flip, [&](std::uint16_t feature) {
      return static_cast<std::uint16_t>((n - (feature >> 6)) % n << 6 | (m - (feature & 63)) % m);
    });
  }
  EXPECT_LE(comparison.unlike, 8) << "ties decided by rounding, of " << comparison.pairs;
}

// Scaling by a power of two is exact: the manifold scales to the bit.
TYPED_TEST(Symmetry, ScalingToTheBit) {
  using Real = TypeParam;
  Dice dice(24);
  for (int i = 0; i < kPairs; ++i) {
    const Pair pair = random_pair(dice);
    const Solid<Real> a(pair.a, pair.radius_a), b(pair.b, pair.radius_b);
    const Rotation<Real> q{static_cast<Real>(pair.pose.rotation.c), static_cast<Real>(pair.pose.rotation.s)};
    const Vec2<Real> p = pair.pose.position.template as<Real>();
    const auto first = collide_convex(a.view(), b.view(), {p, q}, Real(0.3), p);
    for (const Real scale : {Real(0x1p-10), Real(0x1p10)}) {
      Solid<Real> big_a = a, big_b = b;
      for (Solid<Real>* solid : {&big_a, &big_b}) {
        solid->radius *= scale;
        for (auto& corner : solid->corners) corner.point *= scale;
      }
      const auto second =
          collide_convex(big_a.view(), big_b.view(), {scale * p, q}, scale * Real(0.3), scale * p);
      ASSERT_EQ(first.count, second.count);
      EXPECT_EQ(first.normal, second.normal);
      for (int k = 0; k < first.count; ++k) {
        EXPECT_EQ(scale * first.points[k].point, second.points[k].point);
        EXPECT_EQ(scale * first.points[k].separation, second.points[k].separation);
        EXPECT_EQ(first.points[k].feature, second.points[k].feature);
      }
    }
  }
}

}  // namespace
}  // namespace plumb
