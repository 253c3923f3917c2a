#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include "tests/collision/convex_truth.h"

namespace plumb {
namespace {

using truth::Dice;
using truth::Long;
using truth::Solid;
using truth::Vec2l;

/// Errors as shares of the shapes' size, and of a right angle for the normal.
struct Errors {
  double separation = 0;  // of the nearest point
  double choice = 0;  // how much farther apart the shapes are along the best normal than along the one chosen
  double normal = 0;  // if the hulls are clearly apart: from the direction between their nearest points
  double surface = 0;  // how far the nearest point is from half-way between the surfaces

  bool below(const Errors& b) const {
    return separation < b.separation && choice < b.choice && normal < b.normal && surface < b.surface;
  }
};

std::ostream& operator<<(std::ostream& out, const Errors& e) {
  return out << "separation " << e.separation << ", choice " << e.choice << ", normal " << e.normal
             << ", surface " << e.surface;
}

struct Tally {
  Errors worst;
  int met = 0, missed = 0;
  int chosen = 0;  // cases with more than rounding: another of two nearly equal faces was taken
};

template <class Real>
struct Pair {
  Solid<Real> a, b;
  Pose<Real> pose;
  double size = 1;
};

/// A pair that is near touching: b is pushed along a random direction to a random distance from a.
template <class Real>
Pair<Real> random_pair(Dice& dice, Dice::Kind kind_a, Dice::Kind kind_b, double size) {
  Pair<Real> out;
  out.size = size;
  const double radius_a = kind_a == Dice::Disc || dice.integer(0, 1) ? size * dice.number(0.01, 0.5) : 0;
  const double radius_b = kind_b == Dice::Disc || dice.integer(0, 1) ? size * dice.number(0.01, 0.5) : 0;
  const double ratio = dice.integer(0, 3) == 0 ? 0.1 : 1;
  out.a = {dice.corners(kind_a, size), radius_a};
  out.b = {dice.corners(kind_b, size * ratio), radius_b * ratio};
  const Rotation<double> q = rotation_of(dice.number(-4, 4));
  const Vec2d push = dice.direction();
  out.pose = {dice.point(0.3 * size).as<Real>(), {static_cast<Real>(q.c), static_cast<Real>(q.s)}};
  const double gap = dice.number(-0.7, 0.4) * size;
  double far = 0;  // apart by `gap` along `push`, as a start
  for (const Vec2l p : truth::points_of(out.a))
    for (const Vec2l r : truth::points_of(out.b, out.pose))
      far = std::max(far, static_cast<double>(dot(p - r, push.as<Long>())));
  out.pose.position += ((far + gap + radius_a + radius_b) * push).template as<Real>();
  return out;
}

template <class Real>
void judge(const Pair<Real>& pair, const Errors& rounding, Tally& tally) {
  const double reach = 0.3 * pair.size;
  const auto points_a = truth::points_of(pair.a), points_b = truth::points_of(pair.b, pair.pose);
  const truth::Apart apart = truth::between(points_a, points_b);
  const Long separation = apart.distance - (Long{pair.a.radius} + pair.b.radius);
  const auto manifold =
      collide_convex(pair.a.view(), pair.b.view(), pair.pose, static_cast<Real>(reach), pair.pose.position);

  ASSERT_LE(manifold.count, 2);
  if (manifold.count == 0) {
    ++tally.missed;
    EXPECT_GT(separation, reach - 1e-6 * pair.size);
    return;
  }
  ++tally.met;
  const auto& nearest = manifold.count == 2 && manifold.points[1].separation < manifold.points[0].separation
                            ? manifold.points[1]
                            : manifold.points[0];
  for (int i = 0; i < manifold.count; ++i) {
    const auto& point = manifold.points[i];
    EXPECT_LE(point.separation, static_cast<Real>(reach));
    EXPECT_TRUE(std::isfinite(point.point.x) && std::isfinite(point.point.y) &&
                std::isfinite(point.separation));
  }
  const Vec2l normal = manifold.normal.template as<Long>();
  EXPECT_NEAR(static_cast<double>(length_squared(normal)), 1,
              5 * double{std::numeric_limits<Real>::epsilon()});

  const auto share = [&](Long length) { return static_cast<double>(std::fabs(length)) / pair.size; };
  Errors errors;
  errors.separation = share(nearest.separation - separation);
  errors.choice = share(truth::along(points_a, points_b, normal) - apart.distance);
  if (apart.distance > 0.01 * pair.size)
    errors.normal = static_cast<double>(std::fabs(cross(normal, apart.normal)));
  // Half a separation back along the normal is a's surface, half forth b's.
  const Vec2l at = nearest.point.template as<Long>(), half = Long{0.5} * nearest.separation * normal;
  errors.surface = std::max(share(truth::between(points_a, {at - half}).distance - pair.a.radius),
                            share(truth::between(points_b, {at + half}).distance - pair.b.radius));

  if (!errors.below(rounding)) ++tally.chosen;
  Errors& worst = tally.worst;
  worst.separation = std::max(worst.separation, errors.separation);
  worst.choice = std::max(worst.choice, errors.choice);
  worst.normal = std::max(worst.normal, errors.normal);
  worst.surface = std::max(worst.surface, errors.surface);
}

/// Allowance for rounding. The unit is a roundoff of the type; a pose far from the origin costs a few.
template <class Real>
Errors rounding_errors() {
  const double unit = double{std::numeric_limits<Real>::epsilon()};
  return {6 * unit, 6 * unit, 40 * unit, 10 * unit};
}

/// Allowance for the preference for a's faces. Parallel edges (kParallel, 2e-3 rad): the normal is off by
/// that much, and a distance as long as the edge is seen under it. Overlaps: kPreference, 5e-4 of the smaller
/// shape's size across, which is up to 4.5 here.
constexpr Errors kChoiceErrors = {2.3e-3, 2.3e-3, 2e-3, 2.3e-3};

template <class Real>
void expect_truth(Dice::Kind kind_a, Dice::Kind kind_b) {
  const bool has_choice = kind_a != Dice::Disc && kind_b != Dice::Disc;
  for (const double size : {1e-3, 1.0, 1e3}) {
    Tally tally;
    Dice dice(1234u + 16u * kind_a + kind_b);
    for (int i = 0; i < 2000; ++i)
      judge(random_pair<Real>(dice, kind_a, kind_b, size), rounding_errors<Real>(), tally);
    EXPECT_GT(tally.met, 500);
    EXPECT_GT(tally.missed, 50);
    EXPECT_LE(tally.chosen, has_choice ? tally.met / 100 : 0) << size << ": " << tally.worst;
    EXPECT_TRUE(tally.worst.below(kChoiceErrors)) << size << ": " << tally.worst;
  }
}

constexpr Dice::Kind kKinds[] = {Dice::Disc, Dice::Capsule, Dice::Box, Dice::Polygon};

TEST(ContactManifoldTruth, Double) {
  for (const Dice::Kind a : kKinds)
    for (const Dice::Kind b : kKinds) {
      SCOPED_TRACE(testing::Message() << a << " against " << b);
      expect_truth<double>(a, b);
    }
}

TEST(ContactManifoldTruth, Float) {
  for (const Dice::Kind a : kKinds)
    for (const Dice::Kind b : kKinds) {
      SCOPED_TRACE(testing::Message() << a << " against " << b);
      expect_truth<float>(a, b);
    }
}

}  // namespace
}  // namespace plumb
