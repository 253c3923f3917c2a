#include "engine/realtime/impact.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb {
namespace {

/// One point of a free body against a fixed wall below it, its arm from the centre of mass given.
Impact<double> point_on_floor(double mass, double inertia, double x, double y) {
  Impact<double> out;
  out.points = 1;
  out.response[0][0] = 1 / mass + x * x / inertia;  // normal (0, 1): lever x
  out.response[1][1] = 1 / mass + y * y / inertia;  // tangent (-1, 0): lever y
  out.response[0][1] = out.response[1][0] = x * y / inertia;
  return out;
}

TEST(Impact, HeadOnAtAnyMassRatio) {
  for (const double ratio : {1.0, 10.0, 1e3, 1e6}) {
    for (const double e : {0.0, 0.5, 1.0}) {
      Impact<double> impact;
      impact.points = 1;
      impact.restitution = e;
      impact.velocity[0] = -3;
      impact.response[0][0] = 1 + 1 / ratio;
      impact.response[1][1] = 1;
      double impulse[4];
      solve_impact(impact, impulse);
      // P = (1 + e) m |v|, m the reduced mass.
      EXPECT_NEAR(impulse[0], (1 + e) * 3 / (1 + 1 / ratio), 4e-15 * impulse[0]);
      EXPECT_EQ(impulse[1], 0);
    }
  }
}

// A rod that falls on its end without friction: P = (1 + e) m v / (1 + 3 cos^2 theta), theta from the
// horizontal.
TEST(Impact, RodOnItsEnd) {
  for (const double theta : {0.1, 0.7, 1.4}) {
    Impact<double> impact = point_on_floor(2, 2.0 / 12, -0.5 * std::cos(theta), -0.5 * std::sin(theta));
    impact.restitution = 0.5;
    impact.velocity[0] = -4;
    double impulse[4];
    solve_impact(impact, impulse);
    EXPECT_NEAR(impulse[0], 1.5 * 2 * 4 / (1 + 3 * std::cos(theta) * std::cos(theta)), 1e-14);
  }
}

// A disc that lands with slip u: the tangential impulse is -m u / 3, at most mu (1 + e) m |v_n|.
TEST(Impact, DiscWithSlip) {
  const double mass = 2, radius = 0.5, inertia = mass * radius * radius / 2;
  for (const double mu : {0.05, 0.1, 0.5}) {
    Impact<double> impact = point_on_floor(mass, inertia, 0, -radius);
    impact.restitution = 0.3;
    impact.friction = mu;
    impact.velocity[0] = -2;
    impact.velocity[1] = 1.5;
    double impulse[4];
    solve_impact(impact, impulse);
    EXPECT_NEAR(impulse[0], 1.3 * mass * 2, 1e-14);
    EXPECT_NEAR(impulse[1], -std::fmin(mass * 1.5 / 3, mu * 1.3 * mass * 2), 1e-14);
  }
}

// A plate that lands flat on both ends: no spin, half the impulse at each.
TEST(Impact, TwoPointsShareAFlatLanding) {
  const double mass = 3, inertia = 0.25;  // a plate 1 m long
  Impact<double> impact;
  impact.points = 2;
  impact.restitution = 1;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double x = i == 0 ? -0.5 : 0.5, y = j == 0 ? -0.5 : 0.5;
      impact.response[2 * i][2 * j] = 1 / mass + x * y / inertia;
      impact.response[2 * i + 1][2 * j + 1] = 1 / mass;
    }
  impact.velocity[0] = impact.velocity[2] = -1;
  double impulse[4];
  solve_impact(impact, impulse);
  EXPECT_NEAR(impulse[0], mass, 1e-14);
  EXPECT_NEAR(impulse[2], mass, 1e-14);
}

// A box of width 2 b and height 2 h lands flat: P = (1 + e) m v in all. While it slides the friction is mu P;
// at the speed u that friction of less than that stops, it is m u. The torque of the friction T about the
// centre is borne by the front corner: p2 - p1 = T h / b, as long as that is less than P.
TEST(Impact, AFlatLandingThatSlidesOrSticks) {
  const double mass = 1.7, v = 1.2, e = 0.5, b = 0.45, pressure = (1 + e) * mass * v;
  for (const double h : {0.1, 0.3, 0.9, 2.0}) {
    for (const double share : {0.1, 0.5, 0.9, 0.99}) {  // T h / (b P)
      for (const bool sticks : {false, true}) {
        const double drag = share * b / h * pressure, inertia = mass * (b * b + h * h) / 3;
        Impact<double> impact;
        impact.points = 2;
        impact.restitution = e, impact.friction = (sticks ? 1.01 : 1) * drag / pressure;
        for (int i = 0; i < 2; ++i) {
          const double x_i = i == 0 ? -b : b;
          impact.velocity[2 * i] = -v, impact.velocity[2 * i + 1] = sticks ? -drag / mass : -50;
          for (int j = 0; j < 2; ++j) {
            const double x_j = j == 0 ? -b : b;
            impact.response[2 * i][2 * j] = 1 / mass + x_i * x_j / inertia;
            impact.response[2 * i][2 * j + 1] = impact.response[2 * j + 1][2 * i] = -x_i * h / inertia;
            impact.response[2 * i + 1][2 * j + 1] = 1 / mass + h * h / inertia;
          }
        }
        double impulse[4];
        solve_impact(impact, impulse);
        EXPECT_NEAR(impulse[0], 0.5 * (1 - share) * pressure, 1e-12) << h << " " << share << " " << sticks;
        EXPECT_NEAR(impulse[2], 0.5 * (1 + share) * pressure, 1e-12) << h << " " << share << " " << sticks;
        EXPECT_NEAR(impulse[1] + impulse[3], drag, 1e-12 * std::max(1.0, drag))
            << h << " " << share << " " << sticks;
      }
    }
  }
}

TEST(Impact, PartingPointGetsNothing) {
  Impact<double> impact = point_on_floor(1, 1, 0, 0);
  impact.restitution = 1;
  impact.velocity[0] = 0.5;
  double impulse[4];
  solve_impact(impact, impulse);
  EXPECT_EQ(impulse[0], 0);
}

}  // namespace
}  // namespace plumb
