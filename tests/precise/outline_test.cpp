#include "engine/precise/dynamics/feature_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "engine/math/trigonometry.h"
#include "engine/precise/event_search/zero_crossing.h"

namespace plumb::precise {
namespace {

struct Moving {
  Vec2d position, velocity, acceleration;
  double angle, spin, change;

  Pose<double> pose(double t) const {
    return {position + t * velocity + (t * t / 2) * acceleration,
            rotation_of(angle + t * spin + t * t / 2 * change)};
  }
  Twist<double> twist(double t) const { return {velocity + t * acceleration, spin + t * change}; }
};

double along(const Row<double>& row, const Twist<double>& a, const Twist<double>& b) {
  return dot(row.linear_a, a.velocity) + row.angular_a * a.angular_velocity + dot(row.linear_b, b.velocity) +
         row.angular_b * b.angular_velocity;
}

TEST(PreciseOutline, RatesAreTheGapsDerivatives) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const FeatureShape box =
      feature_shapes_of(0, {.geometry = Box{1, 0.6}, .position = {0.1, 0.2}, .angle = 0.3})[0];
  const FeatureShape disc = feature_shapes_of(1, {.geometry = Circle{0.4}, .position = {-0.2, 0.1}})[0];
  const FeatureShape box_b = feature_shapes_of(1, {.geometry = Box{0.7, 0.9}})[0];
  const auto motion = [&](Vec2d at) {
    return Moving{at,
                  {unit(random), unit(random)},
                  {unit(random), unit(random)},
                  3 * unit(random),
                  unit(random),
                  unit(random)};
  };
  const struct {
    Feature feature;
    const FeatureShape& b;
  } cases[] = {{{Feature::Kind::CornerOfB, 2, 0}, disc},
               {{Feature::Kind::Corners, 3, 0}, disc},
               {{Feature::Kind::CornerOfB, 1, 3}, box_b},
               {{Feature::Kind::CornerOfA, 2, 1}, box_b}};
  for (const auto& [feature, b] : cases) {
    for (int round = 0; round < 20; ++round) {
      const Moving p = motion({0, 0}), q = motion({2, 1});
      const double h = 1e-4;
      const auto gap = [&](double t) { return gap_of(feature, box, p.pose(t), b, q.pose(t)).value; };
      const auto rows = [&](double t) {
        return rows_of(feature, box, p.pose(t), p.twist(t), b, q.pose(t), q.twist(t));
      };
      const auto rate = [&](double t) { return along(rows(t).normal, p.twist(t), q.twist(t)); };
      const auto slip = [&](double t) { return along(rows(t).tangent, p.twist(t), q.twist(t)); };
      const Twist<double> pa{p.acceleration, p.change}, qa{q.acceleration, q.change};
      EXPECT_NEAR(rate(0), (gap(h) - gap(-h)) / (2 * h), 1e-7);
      EXPECT_NEAR(along(rows(0).normal, pa, qa) + rows(0).normal.bias_acceleration,
                  (rate(h) - rate(-h)) / (2 * h), 3e-7);
      EXPECT_NEAR(along(rows(0).tangent, pa, qa) + rows(0).tangent.bias_acceleration,
                  (slip(h) - slip(-h)) / (2 * h), 3e-7);
    }
  }
}

TEST(PreciseOutline, SeparationIsTheDistance) {
  // Against the least distance of points sampled on both outlines.
  const FeatureShape a = feature_shapes_of(0, {.geometry = Box{1, 0.6}})[0];
  const FeatureShape b = feature_shapes_of(1, {.geometry = Box{0.8, 0.8}})[0];
  const auto edge_points = [](const FeatureShape& o, const Pose<double>& pose) {
    std::vector<Vec2d> points;
    for (int i = 0; i < o.count(); ++i) {
      for (int k = 0; k < 80; ++k) {
        const double s = k / 80.0;
        points.push_back(pose.position +
                         pose.rotation * ((1 - s) * o.corners[i].point + s * o.corners[o.next(i)].point));
      }
    }
    return points;
  };
  for (int i = 0; i < 12; ++i) {
    const Pose<double> pa{{0, 0}, rotation_of(0.3 * i)}, pb{{1.5, 0.2 * i - 1}, rotation_of(-0.7 * i)};
    double least = 1e300;
    for (const Vec2d p : edge_points(a, pa)) {
      for (const Vec2d q : edge_points(b, pb)) least = std::min(least, std::sqrt(length_squared(p - q)));
    }
    EXPECT_NEAR(separation(a, pa, b, pb).distance, least, 1e-2) << i;
    EXPECT_LE(separation(a, pa, b, pb).distance, least + 1e-15) << i;
  }
}

TEST(PreciseOutline, EdgesThatLieOnEachOtherTouchInTheEndsOfWhatTheyShare) {
  const FeatureShape low = feature_shapes_of(0, {.geometry = Box{2, 1}})[0];
  const FeatureShape high = feature_shapes_of(1, {.geometry = Box{2, 1}})[0];
  const auto touching = [&](double x) {
    return touching_features(low, {{0, 0}, {}}, {}, high, {{x, 1}, {}}, {}, 1e-12);
  };
  const auto xs = [&](double x) {
    std::vector<double> result;
    for (const Feature& f : touching(x))
      result.push_back(gap_of(f, low, {{0, 0}, {}}, high, {{x, 1}, {}}).point.x);
    std::sort(result.begin(), result.end());
    return result;
  };
  EXPECT_EQ(xs(0), (std::vector<double>{-1, 1}));
  EXPECT_EQ(xs(0.75), (std::vector<double>{-0.25, 1}));
  EXPECT_EQ(xs(-0.75), (std::vector<double>{-1, 0.25}));
}

TEST(PreciseEvents, FirstFallIsTheFirst) {
  // cos(t) and a dip of t^2 that lasts 2e-3 between samples.
  const auto evaluate = [](double t, std::span<double> values) {
    values[0] = std::cos(t);
    values[1] = (t - 0.93) * (t - 0.93) - 1e-6;
    values[2] = 1;
  };
  const std::vector<double> tolerance(3, 0.0);
  const auto dip = first_zero_crossing(evaluate, tolerance, 0, 3, 5);
  ASSERT_TRUE(dip);
  EXPECT_EQ(dip->index, 1u);
  EXPECT_NEAR(dip->time, 0.929, 1e-12);
  const auto later = first_zero_crossing(evaluate, tolerance, 0.94, 3, 5);
  EXPECT_EQ(later->index, 0u);
  EXPECT_NEAR(later->time, std::acos(0.0), 1e-15);
  EXPECT_FALSE(first_zero_crossing(evaluate, tolerance, 0.94, 1.5, 5));
}

}  // namespace
}  // namespace plumb::precise
