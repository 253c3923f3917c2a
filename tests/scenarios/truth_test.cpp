// The truths against published digits, other formulas and other formulations.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/scene/error.h"
#include "scenarios/truth/billiard.h"
#include "scenarios/truth/fresnel.h"
#include "scenarios/truth/rod_chain.h"
#include "scenarios/truth/stepping.h"
#include "scenarios/truth/trajectory.h"

namespace plumb::scenarios::truth {
namespace {

using reference::Scheme;

constexpr Real kPi = std::numbers::pi_v<Real>;
constexpr Real kUlp = std::numeric_limits<Real>::epsilon();

/// EXPECT_NEAR in extended precision.
::testing::AssertionResult near(Real value, Real expected, Real tolerance) {
  if (std::fabs(value - expected) <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << value << " is off " << expected << " by " << value - expected << ", more than " << tolerance;
}

Problem problem(std::string_view name) { return select(name).front().build(); }

std::vector<BodyState> exact(const Problem& of, double time) {
  std::vector<BodyState> states(of.scene.bodies.size());
  of.truth.exact(time, states);
  return states;
}

TEST(Fresnel, HasTheTabulatedValues) {
  // Abramowitz and Stegun, table 7.7; C(1) and S(1) to 16 digits.
  EXPECT_TRUE(near(fresnel(1).x, 0.7798934003768228L, 1e-16L));
  EXPECT_TRUE(near(fresnel(1).y, 0.4382591473903548L, 1e-16L));
  EXPECT_TRUE(near(fresnel(0.5L).x, 0.4923442L, 5e-8L));
  EXPECT_TRUE(near(fresnel(0.5L).y, 0.0647324L, 5e-8L));
  EXPECT_TRUE(near(fresnel(5).x, 0.5636312L, 5e-8L));
  EXPECT_TRUE(near(fresnel(5).y, 0.4991914L, 5e-8L));
  EXPECT_EQ(fresnel(0).x, 0);
}

TEST(Fresnel, AgreesWithThePowerSeries) {
  // C(s) + i S(s) = sum over n of s (i pi s^2/2)^n / (n! (2n + 1)); A&S 7.3.11, 7.3.13.
  for (const Real s : {0.1L, 0.7L, 1.0L, 1.3L}) {
    Real term = s, c = 0, i_s = 0;
    for (int n = 0; n < 60; ++n) {
      const Real share = term / (2 * n + 1) * (n % 4 < 2 ? 1 : -1);
      (n % 2 == 0 ? c : i_s) += share;
      term *= kPi / 2 * s * s / (n + 1);
    }
    EXPECT_TRUE(near(fresnel(s).x, c, 50 * kUlp));
    EXPECT_TRUE(near(fresnel(s).y, i_s, 50 * kUlp));
  }
}

TEST(Trajectory, FollowsAnOscillatorInAnyOrder) {
  const Trajectory path(
      {1, 0},
      [](const auto& y, auto& rate) {
        rate = {y[1], -y[0]};
      },
      1.0L / 64);
  for (const Real t : {3.0L, 0.0L, 0.123456L, 1.0L / 64, 10.0L, 2.999L}) {
    EXPECT_TRUE(near(path.at(t)[0], std::cos(t), 200 * kUlp)) << t;
    EXPECT_TRUE(near(path.at(t)[1], -std::sin(t), 200 * kUlp)) << t;
  }
}

TEST(Trajectory, MeetsItsToleranceWhereTheGridIsCoarse) {
  // y' = y^2 runs away: y = 1/(1 - t).
  const Trajectory path(
      {1}, [](const auto& y, auto& rate) { rate = {y[0] * y[0]}; }, 0.5L);
  EXPECT_TRUE(near(path.at(0.9L)[0], 10, 1e-11L));
}

TEST(RodChain, HasThePublishedDigits) {
  // Tip at t = 1 s of N rods of 1 m, g = 9.81, released from +x.
  const auto tip = [](int count) {
    const BodyState last = exact(problem("pendulum_chain[" + std::to_string(count) + "]"), 1).back();
    return last.position + Vec2d{std::cos(last.angle) / 2, std::sin(last.angle) / 2};
  };
  EXPECT_NEAR(tip(2).x, -1.66211513581613, 1e-14);
  EXPECT_NEAR(tip(2).y, -1.04146663719322, 1e-14);
  EXPECT_NEAR(tip(5).x, 0.533569475142432, 2e-15);
  EXPECT_NEAR(tip(5).y, -4.91970959757084, 1e-14);
}

/// Angle from the vertical of one rod released at 90 degrees: sin(phi/2) = k cd(w t, k), k = sin 45 degrees.
Real rod_angle(Real time) {
  const Real k = std::sqrt(0.5L), w = std::sqrt(1.5L * 9.81);
  const Real sine = k * boost::math::jacobi_cd(k, w * time);
  return 2 * std::asin(sine);
}

TEST(RodChain, OfOneRodIsThePendulumOfJacobi) {
  const Problem chain = problem("pendulum_chain[1]");
  for (const double t : {0.1, 0.37, 0.5, 0.77, 1.0})
    EXPECT_NEAR(exact(chain, t)[0].angle, static_cast<double>(rod_angle(t) - kPi / 2), 1e-14) << t;
  // The period of a swing of 90 degrees, over that of a small one: 1.18034059901610.
  const Real small = 2 * kPi / std::sqrt(1.5L * 9.81L);
  const Real ratio = 2 / kPi * boost::math::ellint_1(std::sqrt(0.5L));
  EXPECT_TRUE(near(ratio, 1.18034059901610L, 5e-15L));
  const auto quarter = static_cast<double>(ratio * small / 4);
  EXPECT_NEAR(exact(chain, quarter)[0].angle, -std::numbers::pi / 2, 1e-14);
  EXPECT_NEAR(exact(chain, 2 * quarter)[0].angle, -std::numbers::pi, 1e-14);
}

/// The same equations with the whole matrix, by Gaussian elimination with pivoting.
std::vector<Real> dense_accelerations(const std::vector<Real>& state, Real g) {
  const std::size_t n = state.size() / 2;
  std::vector<std::vector<Real>> m(n, std::vector<Real>(n + 1));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const Real beyond = static_cast<Real>(n - 1 - std::max(i, j));
      m[i][j] = (i == j ? beyond + 1.0L / 3 : beyond + 0.5L) * std::cos(state[i] - state[j]);
      if (i != j) m[i][n] -= (beyond + 0.5L) * std::sin(state[i] - state[j]) * state[n + j] * state[n + j];
    }
    m[i][n] -= g * (static_cast<Real>(n - 1 - i) + 0.5L) * std::cos(state[i]);
  }
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < n; ++r)
      if (std::fabs(m[r][c]) > std::fabs(m[pivot][c])) pivot = r;
    std::swap(m[c], m[pivot]);
    for (std::size_t r = 0; r < n; ++r) {
      if (r == c) continue;
      const Real factor = m[r][c] / m[c][c];
      for (std::size_t k = c; k <= n; ++k) m[r][k] -= factor * m[c][k];
    }
  }
  std::vector<Real> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = m[i][n] / m[i][i];
  return out;
}

TEST(RodChain, SolvesTheDenseEquations) {
  for (const std::size_t n : {1, 2, 3, 8, 30}) {
    std::vector<Real> state(2 * n), rate;
    for (std::size_t i = 0; i < 2 * n; ++i) state[i] = 3 * std::sin(1.7L * static_cast<Real>(i * i + 1));
    RodChain(static_cast<int>(n), 1, 9.81L).rates(state, rate);
    const auto expected = dense_accelerations(state, 9.81L);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(rate[i], state[n + i]);
      EXPECT_TRUE(
          near(rate[n + i], expected[i], 1000 * kUlp * static_cast<Real>(n) * (1 + std::fabs(expected[i]))));
    }
  }
}

TEST(RodChain, ScalesLikeAPendulum) {
  // Four times the length takes twice the time.
  const auto at = [](Real length, Real time) {
    const RodChain chain(3, length, 9.81L);
    return Trajectory(
               std::vector<Real>(6), [&](const auto& y, auto& r) { chain.rates(y, r); }, 1.0L / 240)
        .at(time);
  };
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(near(at(4, 1.4L)[i], at(1, 0.7L)[i], 1e-15L));
}

TEST(RodChain, KeepsItsEnergy) {
  for (const int n : {1, 2, 5, 20, 100}) {
    const RodChain chain(n, 1, 9.81L);
    const Trajectory path(
        std::vector<Real>(2 * static_cast<std::size_t>(n)),
        [&](const auto& y, auto& rate) { chain.rates(y, rate); }, 1.0L / 480);
    for (const Real t : {0.2L, 0.55L, 1.0L}) {
      Real kinetic = 0, potential = 0;
      for (const Motion& m : chain.motions(path.at(t))) {
        kinetic += length_squared(m.velocity) / 2 + m.angular_velocity * m.angular_velocity / 24;
        potential += 9.81L * m.position.y;
      }
      EXPECT_TRUE(near(kinetic + potential, 0, 1e-15L * kinetic)) << n << " at " << t;
    }
  }
}

TEST(Billiard, GivesTheTextbookVelocitiesHeadOn) {
  for (const double ratio : {1.0, 10.0, 1000.0, 1e6}) {
    const Problem of =
        problem(ratio == 1e6 ? "elastic_collision/head_on_1e6"
                             : "elastic_collision/head_on_" + std::to_string(std::lround(ratio)));
    const auto end = exact(of, of.duration);
    EXPECT_NEAR(end[0].velocity.x, 2.25 * (1 - ratio) / (1 + ratio), 1e-15);
    EXPECT_NEAR(end[1].velocity.x, 2.25 * 2 / (1 + ratio), 1e-15);
    EXPECT_NEAR(end[2].velocity.x, 1.75 * (ratio - 1) / (1 + ratio), 1e-15);
    EXPECT_NEAR(end[3].velocity.x, 1.75 * 2 * ratio / (1 + ratio), 1e-15);
    // 1.53 m of gap at 2.25 and at 1.75 m/s.
    ASSERT_EQ(of.truth.impacts.size(), 2u);
    EXPECT_NEAR(of.truth.impacts[0], 1.53 / 2.25, 1e-15);
    EXPECT_NEAR(of.truth.impacts[1], 1.53 / 1.75, 1e-15);
  }
}

TEST(Billiard, LeavesEqualDiscsAtRightAngles) {
  // A cue ball that misses the centre by b: sin(phi) = b/(2 r); the object ball leaves along the normal.
  const auto end = exact(problem("elastic_collision/oblique"), 2);
  const double sine = 0.3, cosine = std::sqrt(1 - sine * sine);
  EXPECT_NEAR(dot(end[0].velocity, end[1].velocity), 0, 1e-14);
  EXPECT_NEAR(end[1].velocity.x, 3 * cosine * cosine, 1e-14);
  EXPECT_NEAR(end[1].velocity.y, -3 * cosine * sine, 1e-14);
}

TEST(Billiard, LeavesInelasticPairsAsNewtonSays) {
  // Chaser 1 kg at 3.5 m/s, chased 2 kg at 0.5 m/s: centre of mass at 1.5 m/s.
  const auto plastic = exact(problem("elastic_collision/restitution_0"), 2);
  EXPECT_NEAR(plastic[0].velocity.x, 1.5, 1e-15);
  EXPECT_NEAR(plastic[1].velocity.x, 1.5, 1e-15);
  const auto half = exact(problem("elastic_collision/restitution_half"), 2);
  EXPECT_NEAR(half[0].velocity.x, 0.5, 1e-15);
  EXPECT_NEAR(half[1].velocity.x, 2.0, 1e-15);
}

TEST(Billiard, PassesTheSpeedAlongTheCradle) {
  const Problem cradle = problem("elastic_collision/cradle");
  const auto end = exact(cradle, cradle.duration);
  const std::array gaps = {0.83, 0.077, 0.111, 0.053};
  double time = 0;
  ASSERT_EQ(cradle.truth.impacts.size(), gaps.size());
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    time += gaps[i] / 2;
    EXPECT_NEAR(cradle.truth.impacts[i], time, 1e-15);
    EXPECT_NEAR(end[i].velocity.x, 0, 1e-15);
  }
  EXPECT_NEAR(end[4].velocity.x, 2, 1e-15);
}

Disc on_a_line(Real mass, Real x, Real v) { return {mass, 0.25L, {.position = {x, 0}, .velocity = {v, 0}}}; }

TEST(Billiard, CountsTheDigitsOfPi) {
  // Galperin: a ball at rest by a wall, another of 100^n times its mass comes in. Here with its mirror image
  // in place of the wall: the light balls meet where it would stand, and the heavy ones hit them at the same
  // moments, so that one moment is one bounce.
  constexpr std::array kBounces = {3, 31, 314};
  for (std::size_t n = 0; n < kBounces.size(); ++n) {
    const Real heavy = std::pow(100.0L, static_cast<Real>(n));
    const Billiard billiard(
        {on_a_line(heavy, -4, 1), on_a_line(1, -1, 0), on_a_line(1, 1, 0), on_a_line(heavy, 4, -1)}, 1, 1e4L);
    int moments = 0;
    double last = 0;
    for (const double time : billiard.impacts()) {
      if (time - last > 1e-12) ++moments;
      last = time;
    }
    EXPECT_EQ(moments, kBounces[n]);
  }
}

TEST(Billiard, GivesTheVelocitiesAfterAnImpactAtItsTime) {
  // Two metres of gap at 1 m/s: at 2 s, without rounding.
  const Billiard billiard({on_a_line(1, 0, 1), on_a_line(1, 2.5L, 0)}, 1, 10);
  ASSERT_EQ(billiard.impacts(), std::vector<double>{2});
  EXPECT_EQ(billiard.at(std::nextafter(2.0L, 0.0L))[1].velocity.x, 0);
  EXPECT_EQ(billiard.at(2)[1].velocity.x, 1);
}

TEST(Billiard, StopsWhereImpactsHaveNoEnd) {
  // Two heavy discs that close in on a light one crush it with infinitely many impacts in a finite time.
  EXPECT_THROW(Billiard({on_a_line(1e18L, -1, 1), on_a_line(1, 0, 0), on_a_line(1e18L, 1, -1)}, 0.9L, 10),
               Error);
}

TEST(Stepping, SemiImplicitFallsTooFarByHalfAStep) {
  // g h t/2 too far for semi-implicit Euler, too little for explicit Euler, none for velocity Verlet.
  const Problem fall = problem("free_fall/vacuum");
  std::vector<BodyState> states(fall.scene.bodies.size());
  const double h = 1.0 / 60, t = 600 * h;
  const auto error = [&](Scheme scheme) {
    EXPECT_TRUE(fall.truth.discrete(scheme, h, 600, states));
    return states[1].position.y - exact(fall, t)[1].position.y;
  };
  EXPECT_NEAR(error(Scheme::SemiImplicitEuler), -9.81 * h * t / 2, 1e-13);
  EXPECT_NEAR(error(Scheme::ExplicitEuler), 9.81 * h * t / 2, 1e-13);
  EXPECT_NEAR(error(Scheme::VelocityVerlet), 0, 1e-13);
  EXPECT_FALSE(fall.truth.discrete(Scheme::Adaptive, h, 600, states));
}

TEST(Stepping, LinearDragIsAGeometricSeries) {
  // v' = v + h (g - v/tau): v_n - u = (v_0 - u) (1 - h/tau)^n.
  const Problem drag = problem("free_fall/drag");
  std::vector<BodyState> states(drag.scene.bodies.size());
  const double h = 1.0 / 60, tau = 4;
  for (const long n : {1L, 60L, 600L, 30L}) {
    ASSERT_TRUE(drag.truth.discrete(Scheme::SemiImplicitEuler, h, n, states));
    const double u = -9.81 * tau, left = std::pow(1 - h / tau, static_cast<double>(n));
    EXPECT_NEAR(states[0].velocity.y, u * (1 - left), 1e-12);
  }
  EXPECT_FALSE(drag.truth.discrete(Scheme::VelocityVerlet, h, 1, states));
}

TEST(Stepping, RefusesStepsInWhichAPushEnds) {
  const Problem push = problem("off_centre_torque/corner_force");
  std::vector<BodyState> states(1);
  EXPECT_TRUE(push.truth.discrete(Scheme::SemiImplicitEuler, 1.0 / 60, 5, states));
  EXPECT_FALSE(push.truth.discrete(Scheme::SemiImplicitEuler, 0.3, 5, states));
}

TEST(FreeFall, DragEndsAtTheTerminalSpeed) {
  // m g = k u^2 and m g = c u; after ten time constants nothing else is left.
  const auto late = exact(problem("free_fall/drag"), 100);
  EXPECT_NEAR(late[0].velocity.y, -2 * 9.81 / 0.5, 1e-9);
  EXPECT_NEAR(late[1].velocity.x, 0, 1e-9);
  EXPECT_NEAR(late[2].velocity.y, -std::sqrt(9.81 / 0.02), 1e-12);
}

TEST(OffCentreTorque, PushDoesTheWorkThatTheSpinHolds) {
  // While the force F acts: I w^2/2 = F . (r(angle) - r(0)), r the arm. Angles are not compared with an ODE
  // here.
  const Problem push = problem("off_centre_torque/corner_force");
  const double inertia = 2 * (1 + 0.25) / 12;
  for (const double t : {0.1, 0.5, 0.9, 1.0}) {
    const BodyState s = exact(push, t)[0];
    const double c = std::cos(s.angle), sn = std::sin(s.angle);
    const Vec2d arm{0.5 * c - 0.25 * sn, 0.5 * sn + 0.25 * c};
    const double work = dot(Vec2d{-2, 2.5}, arm - Vec2d{0.5, 0.25});
    EXPECT_NEAR(inertia * s.angular_velocity * s.angular_velocity / 2, work, 2e-15) << t;
  }
}

TEST(OffCentreTorque, CentresDoNotCareWhereTheyArePushed) {
  const auto end = exact(problem("off_centre_torque/thin_and_square"), 2.3);
  EXPECT_EQ(end[0].velocity, end[1].velocity);
  EXPECT_NEAR(end[0].position.x, end[1].position.x, 1e-15);
  EXPECT_NEAR(end[0].position.y - 4, end[1].position.y + 4, 1e-14);
  EXPECT_GT(end[0].angle, 1.1 * end[1].angle);
}

}  // namespace
}  // namespace plumb::scenarios::truth
