#include <algorithm>
#include <cmath>

#include "engine/collision/distance/time_of_impact.h"

#include <gtest/gtest.h>

#include "tests/collision/query_truth.h"

namespace plumb {
namespace {

namespace truth = query_truth;
using truth::near;
using truth::Point;
using truth::Random;
using truth::Shape;
using truth::Wide;

template <class Real>
class TimeOfImpact : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(TimeOfImpact, Reals);

template <class Real>
using State = typename ImpactResult<Real>::State;

constexpr Wide kDouble = std::numeric_limits<double>::epsilon();

/// Two moving shapes in long double, with the library's sine and cosine.
template <class Real>
struct Motion {
  const Convex<Real> a, b;
  const Sweep<Real> sweep_a, sweep_b;

  static std::vector<Point> moved(const Convex<Real>& shape, const Sweep<Real>& sweep, Wide t) {
    const Wide c0 = sweep.start_rotation.c, s0 = sweep.start_rotation.s,
               length = std::sqrt(c0 * c0 + s0 * s0);
    const Wide c = std::cos(t * sweep.delta_angle), s = std::sin(t * sweep.delta_angle);
    return truth::placed(shape, {sweep.start.template as<Wide>() + t * sweep.motion.template as<Wide>(),
                                 {(c * c0 - s * s0) / length, (s * c0 + c * s0) / length}});
  }
  std::vector<Point> a_at(Wide t) const { return moved(a, sweep_a, t); }
  std::vector<Point> b_at(Wide t) const { return moved(b, sweep_b, t); }
  Wide gap(Wide t) const { return truth::hull_gap(a_at(t), b_at(t)) - (Wide(a.radius) + Wide(b.radius)); }

  static Wide reach(const Convex<Real>& shape) {
    Wide farthest = 0;
    for (const Point& p : truth::points_of(shape))
      farthest = std::max(farthest, std::sqrt(length_squared(p)));
    return farthest;
  }
  Wide speed() const {
    return std::sqrt(length_squared(sweep_b.motion.template as<Wide>() - sweep_a.motion.template as<Wide>()));
  }
  Wide size() const {
    return reach(a) + reach(b) + Wide(a.radius) + Wide(b.radius) +
           std::sqrt(length_squared(sweep_b.start.template as<Wide>() - sweep_a.start.template as<Wide>()));
  }
  /// A bound of how fast the gap changes: the speed of the fastest points.
  Wide fastest() const {
    return speed() + std::abs(Wide(sweep_a.delta_angle)) * reach(a) +
           std::abs(Wide(sweep_b.delta_angle)) * reach(b);
  }
  Wide rounding() const { return 8 * kDouble * (size() + fastest()); }

  /// Proves by small steps that the gap is at least `least` - `slack` until `end`: no gap closes faster than
  /// the fastest points do.
  testing::AssertionResult stays_apart(Wide end, Wide least, Wide slack) const {
    int steps = 0;
    for (Wide t = 0; t < end;) {
      const Wide now = gap(t);
      if (now < least - rounding())
        return testing::AssertionFailure() << now << " apart at " << t << " of " << end;
      if (!(fastest() > 0)) break;
      t += (now - least + slack) / fastest();
      if (++steps > 2000000) return testing::AssertionFailure() << "not decided in 2000000 steps";
    }
    return testing::AssertionSuccess();
  }
};

struct Counts {
  int states[4] = {};
  int most_iterations = 0;
  long iterations = 0;
};

template <class Real>
void check(const Motion<Real>& motion, Real target_separation, Real tolerance, const ImpactResult<Real>& got,
           Counts& counts) {
  const Wide rounding = motion.rounding(), gap_before = motion.gap(0);
  Wide target = target_separation, slack = std::max(Wide(tolerance), rounding);
  if (gap_before <= target + slack) target = gap_before / 2, slack = gap_before / 4;
  ++counts.states[static_cast<int>(got.state)];
  counts.iterations += got.iterations;
  counts.most_iterations = std::max(counts.most_iterations, got.iterations);
  const Wide end = got.exact_fraction, ulp = std::numeric_limits<Real>::epsilon();
  ASSERT_TRUE(end >= 0 && end <= 1);
  ASSERT_LE(got.fraction, end);
  ASSERT_GE(got.fraction, end * (1 - ulp));
  if (got.state == State<Real>::Overlapped) {
    ASSERT_LE(gap_before, rounding);
    ASSERT_EQ(got.fraction, 0);
    return;
  }
  ASSERT_GT(gap_before, -rounding);
  // Steps aim a quarter of the tolerance farther out than the target: the proof may use it up.
  ASSERT_TRUE(motion.stays_apart(end, target, slack / 4));
  if (got.state == State<Real>::Separated) {
    ASSERT_EQ(got.fraction, 1);
    return;
  }
  ASSERT_EQ(got.state, State<Real>::Hit);
  const Wide gap = motion.gap(end);
  ASSERT_GE(gap, target - rounding);
  ASSERT_LE(gap, target + slack + rounding);
  const auto in_a = motion.a_at(end), in_b = motion.b_at(end);
  const Point n = got.normal.template as<Wide>(), at = got.point.template as<Wide>();
  const Point center =
      motion.sweep_a.start.template as<Wide>() + end * motion.sweep_a.motion.template as<Wide>();
  const Wide exact = rounding + ulp * (motion.size() + std::sqrt(length_squared(center)));
  // An ulp of length from each of: a direction of unit length, a sine and a cosine, their products' sum.
  ASSERT_TRUE(near(length_squared(n), 1, 2 * 3 * ulp));
  ASSERT_TRUE(near(truth::gap_along(in_a, in_b, n) - motion.a.radius - motion.b.radius, gap, exact));
  ASSERT_TRUE(near(truth::signed_distance(in_a, at) - motion.a.radius, gap / 2, exact));
  ASSERT_TRUE(near(truth::signed_distance(in_b, at) - motion.b.radius, gap / 2, exact));
}

template <class Real>
void check(const Motion<Real>& motion, Real target, Real tolerance, Counts& counts) {
  const auto got =
      time_of_impact<Real>(motion.a, motion.sweep_a, motion.b, motion.sweep_b, target, tolerance);
  check(motion, target, tolerance, got, counts);
}

template <class Real>
Sweep<Real> sweep_of(Point from, Point motion, Rotation<Real> rotation, double turn) {
  return {from.as<Real>(), motion.as<Real>(), rotation, static_cast<Real>(turn)};
}

TYPED_TEST(TimeOfImpact, BoxesInAGame) {
  using Real = TypeParam;
  Random random(1);
  Counts counts;
  for (int k = 0; k < 10000; ++k) {
    const Shape<Real> a = truth::tight_aabb<Real>(0.5, 0.5),
                      b = truth::tight_aabb<Real>(random.uniform(0.1, 1), 0.3);
    const Point from = random.uniform(0, 4) * random.direction(), to = random.direction();
    const Motion<Real> motion{
        a, b, sweep_of<Real>({}, {}, random.rotation<Real>(), random.uniform(-1, 1)),
        sweep_of<Real>(from, to - from, random.rotation<Real>(), random.uniform(-1, 1))};
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_NO_FATAL_FAILURE(check<Real>(motion, Real(0.005), Real(0.001), counts));
  }
  for (const auto state : {State<Real>::Separated, State<Real>::Hit, State<Real>::Overlapped})
    EXPECT_GT(counts.states[static_cast<int>(state)], 1000);
  EXPECT_LE(counts.most_iterations, 15);
  EXPECT_LT(counts.iterations, 10000 * 2);
}

TYPED_TEST(TimeOfImpact, ThinRodsThatSpin) {
  using Real = TypeParam;
  Random random(2);
  Counts counts;
  for (int k = 0; k < 6000; ++k) {
    const Shape<Real> a = truth::tight_aabb<Real>(1, random.decade(-4, -1)),
                      b = truth::shape_of<Real>({{-1, 0}, {random.uniform(0, 2), 0}}, random.decade(-4, -1));
    const Point from = random.uniform(0.5, 3) * random.direction(), to = random.direction();
    const double turn = random.decade(0, 2);
    const Motion<Real> motion{a, b, sweep_of<Real>({}, {}, random.rotation<Real>(), turn),
                              sweep_of<Real>(from, random.uniform(0, 1) * (to - from),
                                             random.rotation<Real>(), turn * random.uniform(-1, 1))};
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_NO_FATAL_FAILURE(check<Real>(motion, Real(0.001), Real(0.0002), counts));
  }
  EXPECT_GT(counts.states[static_cast<int>(State<Real>::Hit)], 2000);
  EXPECT_GT(counts.states[static_cast<int>(State<Real>::Separated)], 300);
  EXPECT_EQ(counts.states[static_cast<int>(State<Real>::Failed)], 0);
  EXPECT_LE(counts.most_iterations, 300);
}

// All kinds of shapes, sizes from 1e-6 to 1e6, up to 1e8 times their size a step and a hundred turns.
TYPED_TEST(TimeOfImpact, AnySizeAndSpeed) {
  using Real = TypeParam;
  Random random(3);
  Counts counts;
  for (int k = 0; k < 20000; ++k) {
    const double size = random.decade(-6, 6);
    const Shape<Real> a = truth::random_shape<Real>(random, size, 6),
                      b = truth::random_shape<Real>(random, size * random.decade(-2, 0), 6);
    const Point from = size * random.uniform(0, 5) * random.direction(),
                to = size * random.uniform(0, 2) * random.direction();
    const Wide farther = random.chance(0.5) ? 1 : random.decade(-3, 8);
    const double turn = random.chance(0.3) ? 0 : random.decade(-2, 1.5);
    const Point offset = random.chance(0.3) ? random.decade(0, 2) * size * random.direction() : Point{};
    const Point carried = random.chance(0.3) ? random.decade(-1, 1) * size * random.direction() : Point{};
    const Motion<Real> motion{
        a, b, sweep_of<Real>(offset, carried, random.rotation<Real>(), turn * random.uniform(-1, 1)),
        sweep_of<Real>(offset + from, carried + farther * (to - from), random.rotation<Real>(),
                       turn * random.uniform(-1, 1))};
    const Real target = static_cast<Real>(size * 0.005), tolerance = static_cast<Real>(size * 0.001);
    SCOPED_TRACE(testing::Message() << "case " << k);
    ASSERT_NO_FATAL_FAILURE(check<Real>(motion, target, tolerance, counts));
  }
  for (const auto state : {State<Real>::Separated, State<Real>::Hit, State<Real>::Overlapped})
    EXPECT_GT(counts.states[static_cast<int>(state)], 1000);
  EXPECT_EQ(counts.states[static_cast<int>(State<Real>::Failed)], 0);
}

// A wall of 1 mm and a bullet of 2 cm at up to 1e8 m a step: t = (distance - radius - half a wall - target) /
// V.
TYPED_TEST(TimeOfImpact, ThroughAThinWallAtAnySpeed) {
  using Real = TypeParam;
  const Shape<Real> wall = truth::tight_aabb<Real>(0.0005, 10),
                    bullet = truth::shape_of<Real>({{0, 0}}, 0.01);
  for (const double way : {1.1, 10.0, 1e3, 1e5, 1e7, 1e8})
    for (const double spin : {0.0, 1.0, 100.0})
      for (const double from : {-1.0, -0.4 * way}) {
        const auto sweep = sweep_of<Real>({from, 0.25}, {way, 0}, {}, spin);
        const auto got = time_of_impact<Real>(wall, {}, bullet, sweep, Real(0.005), Real(0.001));
        SCOPED_TRACE(testing::Message() << way << " m, " << spin << " rad, from " << from);
        ASSERT_EQ(got.state, State<Real>::Hit);
        const Wide x = Wide(sweep.start.x) + got.exact_fraction * Wide(sweep.motion.x), target = Real(0.005);
        const Wide gap = -x - bullet.radius - wall.corners[1].point.x, rounding = 8 * kDouble * way;
        EXPECT_GE(gap, target - rounding);
        EXPECT_LE(gap, target + Real(0.001) + rounding);
        EXPECT_TRUE(near(got.normal.x, -1, 0));
        EXPECT_TRUE(near(got.point.y, 0.25, std::numeric_limits<Real>::epsilon()));
        EXPECT_LE(got.iterations, 6);
      }
}

// A rod that turns about its centre meets a disc at distance D and angle phi when
// D sin(phi - w t) = radii + target, at whatever speed it turns.
TYPED_TEST(TimeOfImpact, SpinningRodMeetsADisc) {
  using Real = TypeParam;
  const Wide thin = 0.001, disc_radius = 0.02;
  const Shape<Real> rod = truth::shape_of<Real>({{-1, 0}, {1, 0}}, thin),
                    disc = truth::shape_of<Real>({{0, 0}}, disc_radius);
  const Real target = Real(0.002), tolerance = Real(0.0001);
  for (const double turn : {3.0, 30.0, 1e3, 1e5, 1e8})
    for (const double phi : {0.5, 1.5, 2.5})
      for (const double away : {0.1, 0.5, 0.95}) {
        const Sweep<Real> spin{{}, {}, {}, static_cast<Real>(turn)},
            stand{(away * Point{std::cos(phi), std::sin(phi)}).as<Real>(), {}, {}, 0};
        const auto got = time_of_impact<Real>(rod, spin, disc, stand, target, tolerance);
        SCOPED_TRACE(testing::Message() << turn << " rad, angle " << phi << ", distance " << away);
        const Wide x = stand.start.x, y = stand.start.y, distance = std::sqrt(x * x + y * y);
        const Wide radii = Wide(rod.radius) + Wide(disc.radius) + Wide(target);
        const auto meets = [&](Wide gap) { return std::atan2(y, x) - std::asin((radii + gap) / distance); };
        ASSERT_EQ(got.state, State<Real>::Hit);
        const Wide angle = Wide(spin.delta_angle) * got.exact_fraction;
        EXPECT_LE(angle, meets(0) + 4 * kDouble);
        EXPECT_GE(angle, meets(tolerance) - 4 * kDouble);
        EXPECT_LE(got.iterations, 30);
      }
}

// Two rods in step, like gears that never touch: about two iterations a radian, which is more than allowed
// for a thousand turns. What was found out until then still holds.
TYPED_TEST(TimeOfImpact, GearsThatNeverTouch) {
  using Real = TypeParam;
  const Shape<Real> rod = truth::tight_aabb<Real>(1, 0.01);
  const auto turn = [&](Real angle) {
    return Motion<Real>{rod, rod, {{}, {}, {}, angle}, {{Real(1.5), 0}, {}, {0, 1}, -angle}};
  };
  Counts counts;
  check<Real>(turn(100), Real(0.01), Real(0.001), counts);
  EXPECT_EQ(counts.states[static_cast<int>(State<Real>::Separated)], 1);
  EXPECT_LE(counts.most_iterations, 300);

  const auto fast = turn(Real(1e6));
  const auto got = time_of_impact<Real>(fast.a, fast.sweep_a, fast.b, fast.sweep_b, Real(0.01), Real(0.001));
  EXPECT_EQ(got.state, State<Real>::Failed);
  EXPECT_GT(got.fraction, 1000 / 1e6);
  EXPECT_LT(got.fraction, 1);
  EXPECT_TRUE(fast.stays_apart(got.exact_fraction, 0.01, 0.001));
}

// Shapes that rest or slide closer than the target are left alone; those that come closer are stopped.
TYPED_TEST(TimeOfImpact, StartsCloserThanTheTarget) {
  using Real = TypeParam;
  const Shape<Real> ground = truth::tight_aabb<Real>(100, 1), box = truth::tight_aabb<Real>(1, 1);
  const Real target = Real(0.005), tolerance = Real(0.001), start = Real(0.002);
  const auto go = [&](Vec2<Real> motion, Real turn) {
    const Motion<Real> all{ground, box, {}, {{0, 2 + start}, motion, {}, turn}};
    Counts counts;
    const auto got = time_of_impact<Real>(all.a, all.sweep_a, all.b, all.sweep_b, target, tolerance);
    check<Real>(all, target, tolerance, got, counts);
    return got;
  };
  EXPECT_EQ(go({0, 0}, 0).state, State<Real>::Separated);
  EXPECT_EQ(go({5, 0}, 0).state, State<Real>::Separated);
  EXPECT_EQ(go({5, -start / 4}, 0).state, State<Real>::Separated);
  EXPECT_EQ(go({5, 1}, 0).state, State<Real>::Separated);
  EXPECT_EQ(go({5, 3}, 3).state, State<Real>::Separated);
  EXPECT_EQ(go({5, -1}, 0).state, State<Real>::Hit);
  EXPECT_EQ(go({5, 0}, Real(0.1)).state, State<Real>::Hit);
  EXPECT_EQ(go({0, Real(-1e8)}, 0).state, State<Real>::Hit);
  EXPECT_EQ(go({0, Real(-1e8)}, 100).state, State<Real>::Hit);
}

TYPED_TEST(TimeOfImpact, WithoutMotion) {
  using Real = TypeParam;
  const Shape<Real> box = truth::tight_aabb<Real>(1, 1), point = truth::shape_of<Real>({{0, 0}});
  const auto state = [&](const Shape<Real>& a, const Shape<Real>& b, Vec2<Real> at) {
    return time_of_impact<Real>(a, {}, b, {at, {}, {}, 0}, Real(0.005), Real(0.001)).state;
  };
  EXPECT_EQ(state(box, box, {3, 0}), State<Real>::Separated);
  EXPECT_EQ(state(box, box, {2, 0}), State<Real>::Overlapped);
  EXPECT_EQ(state(box, box, {1, 1}), State<Real>::Overlapped);
  EXPECT_EQ(state(box, box, {0, 0}), State<Real>::Overlapped);
  EXPECT_EQ(state(point, point, {0, 0}), State<Real>::Overlapped);
  EXPECT_EQ(state(point, point, {1, 0}), State<Real>::Separated);
}

// Sizes, speeds and spins beyond all reason, and corners that coincide: a state, and numbers.
TYPED_TEST(TimeOfImpact, NothingBreaksIt) {
  using Real = TypeParam;
  Random random(4);
  for (int k = 0; k < 5000; ++k) {
    const double size = random.decade(-15, 15);
    Shape<Real> a = truth::random_shape<Real>(random, size, 64),
                b = truth::random_shape<Real>(random, size * random.decade(-15, 0), 64);
    if (random.chance(0.2)) a.corners.back() = a.corners.front();
    const Point from = size * random.decade(-9, 9) * random.direction();
    const auto sweep = [&] {
      const double turn = random.chance(0.3) ? 0 : random.decade(-12, 9);
      return sweep_of<Real>({}, size * random.decade(-15, 15) * random.direction(), random.rotation<Real>(),
                            turn);
    };
    Sweep<Real> sweep_a = sweep(), sweep_b = sweep();
    sweep_b.start = from.as<Real>();
    if (random.chance(0.2)) sweep_b.motion = (-from).as<Real>();
    const Real target = static_cast<Real>(size * random.decade(-9, 0)), tolerance = target * Real(0.1);
    const auto got = time_of_impact<Real>(a, sweep_a, b, sweep_b, target, random.chance(0.1) ? 0 : tolerance);
    ASSERT_TRUE(got.fraction >= 0 && got.fraction <= 1 && got.exact_fraction >= 0 && got.exact_fraction <= 1);
    ASSERT_TRUE(std::isfinite(got.point.x) && std::isfinite(got.point.y));
    if (got.state != State<Real>::Separated) {
      ASSERT_TRUE(near(length_squared(got.normal), 1, 1e-6));
    }
  }
}

TYPED_TEST(TimeOfImpact, PoseAtAFraction) {
  using Real = TypeParam;
  const Sweep<Real> sweep{{1, 2}, {4, -8}, {0, 1}, Real(3)};
  const auto pose = pose_at<Real>(sweep, 0.25);
  EXPECT_EQ(pose.position, (Vec2<Real>{2, 0}));
  EXPECT_TRUE(near(pose.rotation.c, -std::sin(0.75L), std::numeric_limits<Real>::epsilon()));
  EXPECT_TRUE(near(pose.rotation.s, std::cos(0.75L), std::numeric_limits<Real>::epsilon()));
}

}  // namespace
}  // namespace plumb
