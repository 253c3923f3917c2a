#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "engine/precise/impact_laws/impact_law.h"

// Laws of one impact, against closed forms and against the impact followed in small steps.
namespace plumb::precise {
namespace {

/// A body of mass 1 kg that touches a floor at (right, -down) from its centre, inertia in kg m^2.
ImpactPoint touching(double right, double down, double inertia, double vx, double vy, double w) {
  return {vy + right * w, vx + down * w, 1 + right * right / inertia, right * down / inertia,
          1 + down * down / inertia};
}

/// Follows an impact in steps of the normal impulse, as Routh describes it: the truth for both laws that do.
struct Followed {
  ContactImpulse compression{}, whole{};
  double taken = 0, given = 0;  // work of the normal impulse, J
};

Followed follow(const ImpactPoint& point, const ImpactCoefficients& c, bool energetic) {
  constexpr int kSteps = 200'000;
  const double step = -2 * point.gap_rate / (point.normal_response * kSteps);
  Followed out;
  ContactImpulse now;
  bool stopped = false;
  for (;;) {
    const double closing = gap_rate_after(point, now), slip = slip_speed_after(point, now);
    if (out.compression.normal == 0 && closing >= 0) out.compression = now;
    if (out.compression.normal > 0) {
      const bool done = energetic ? out.given >= c.restitution * c.restitution * out.taken
                                  : now.normal >= (1 + c.restitution) * out.compression.normal;
      if (done) break;
    }
    stopped = stopped || slip * point.slip_speed <= 0;
    double share = point.slip_speed > 0 ? -c.friction : c.friction;
    if (stopped) {
      share = -point.cross_response / point.tangent_response;
      share = std::min(std::max(share, -c.later_friction), c.later_friction);
    }
    now.normal += step;
    now.tangential += share * step;
    const double work = step * (closing + gap_rate_after(point, now)) / 2;
    (closing < 0 ? out.taken : out.given) += closing < 0 ? -work : work;
  }
  out.whole = now;
  return out;
}

TEST(ImpactLaws, CentralImpactsWithoutFrictionOpenAtTheCoefficient) {
  const ImpactPoint point = touching(0, 1, 0.5, 3, -2, 1);
  for (const auto law : {newton_impulse, poisson_impulse, stronge_impulse}) {
    const ContactImpulse impulse = law(point, {.restitution = 0.7});
    EXPECT_NEAR(impulse.normal, 1.7 * 2, 1e-15);
    EXPECT_EQ(impulse.tangential, 0);
  }
}

TEST(ImpactLaws, SlidingDiscIsSlowedByFrictionOrMadeToRoll) {
  // A disc: a tangential impulse changes the slip by 3/m. It slips on while mu (1 + e) 3 |vy| < slip.
  const ImpactPoint point = touching(0, 1, 0.5, 9, -2, 0);
  for (const auto law : {newton_impulse, poisson_impulse, stronge_impulse}) {
    const ContactImpulse slides = law(point, {.restitution = 0.5, .friction = 0.9, .later_friction = 0.9});
    EXPECT_NEAR(slides.tangential, -0.9 * 3, 1e-14);
    const ContactImpulse rolls = law(point, {.restitution = 0.5, .friction = 1.1, .later_friction = 1.1});
    EXPECT_NEAR(rolls.tangential, -9.0 / 3, 1e-14);
    EXPECT_NEAR(slip_speed_after(point, rolls), 0, 1e-14);
  }
}

TEST(ImpactLaws, AgreeWhereTheSlipKeepsItsDirection) {
  // Known of these laws (Stronge 1990): they differ only where the slip stops during the impact.
  const ImpactPoint point = touching(0.3, 0.8, 0.2, 20, -2, 1);
  const ImpactCoefficients c{.restitution = 0.6, .friction = 0.3, .later_friction = 0.3};
  const ContactImpulse newton = newton_impulse(point, c);
  for (const ContactImpulse& other : {poisson_impulse(point, c), stronge_impulse(point, c)}) {
    EXPECT_NEAR(other.normal, newton.normal, 1e-14);
    EXPECT_NEAR(other.tangential, newton.tangential, 1e-14);
  }
}

TEST(ImpactLaws, RouthsPathIsThatOfSmallSteps) {
  std::mt19937 random(5);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 30; ++i) {
    const ImpactPoint point =
        touching(draw(-1, 1), draw(0.1, 1), draw(0.1, 0.6), draw(-3, 3), -3, draw(-1, 1));
    if (point.gap_rate > -0.5) continue;
    const double mu = draw(0, 0.9);
    const ImpactCoefficients c{draw(0, 1), mu, mu * draw(0.3, 1), 0};
    for (const bool energetic : {false, true}) {
      const ContactImpulse found = energetic ? stronge_impulse(point, c) : poisson_impulse(point, c);
      const ContactImpulse followed = follow(point, c, energetic).whole;
      EXPECT_NEAR(found.normal, followed.normal, 1e-4) << i;
      EXPECT_NEAR(found.tangential, followed.tangential, 1e-4) << i;
    }
  }
}

TEST(ImpactLaws, StrongeNeverGainsEnergyAndNewtonCan) {
  std::mt19937 random(7);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  double newton_gain = 0;
  int seen = 0;
  for (int i = 0; i < 200'000; ++i) {
    const ImpactPoint point =
        touching(draw(-1, 1), draw(0, 1), draw(0.02, 0.6), draw(-6, 6), draw(-6, 1), draw(-6, 6));
    if (point.gap_rate >= 0) continue;
    ++seen;
    const double mu = draw(0, 2);
    const ImpactCoefficients c{draw(0, 1), mu, mu * draw(0, 1), draw(0, 1)};
    const double size =
        point.gap_rate * point.gap_rate / point.normal_response + point.slip_speed * point.slip_speed;
    const ContactImpulse stronge = with_tangential_restitution(point, c, stronge_impulse(point, c));
    ASSERT_LE(energy_change(point, stronge), 1e-9 * size);
    ASSERT_GE(gap_rate_after(point, stronge), -1e-9 * std::sqrt(size));
    ASSERT_GE(stronge.normal, 0);
    newton_gain = std::max(newton_gain, energy_change(point, newton_impulse(point, c)) / size);
  }
  EXPECT_GT(seen, 100'000);
  EXPECT_GT(newton_gain, 0.1) << "with friction Newton's law gains energy where the slip turns round";
}

TEST(ImpactLaws, NewtonGainsEnergyOnASlantingRodWithFriction) {
  // A rod of 2 m at 45 degrees that falls at 1 m/s and slips away from the side to which it leans at 0.5 m/s.
  // The slip turns round. Source of the effect: Kane and Levinson, Dynamics (1985).
  const double half = std::sqrt(0.5);
  const ImpactPoint point = touching(half, half, 1.0 / 3, -0.5, -1, 0);
  const ImpactCoefficients c{.restitution = 0.9, .friction = 0.4, .later_friction = 0.4};
  EXPECT_NEAR(energy_change(point, newton_impulse(point, c)), 0.05, 1e-9);
  EXPECT_LT(energy_change(point, poisson_impulse(point, c)), -0.1);
  EXPECT_LT(energy_change(point, stronge_impulse(point, c)), -0.08);
}

TEST(ImpactLaws, JammingSlipStopsAndTheGapOpens) {
  // Friction that drives the rod into the floor (Painleve): compression ends only after the slip has stopped.
  const ImpactPoint point = touching(0.6, 1, 0.15, 1, -0.1, 0);
  ASSERT_LT(point.normal_response - 2 * point.cross_response, 0) << "the case is one";
  const ImpactCoefficients c{.restitution = 0.3, .friction = 2, .later_friction = 2};
  for (const ContactImpulse& impulse : {poisson_impulse(point, c), stronge_impulse(point, c)}) {
    EXPECT_GT(impulse.normal, 0);
    EXPECT_GT(gap_rate_after(point, impulse), 0);
    EXPECT_NEAR(slip_speed_after(point, impulse), 0, 1e-12);
  }
}

TEST(ImpactLaws, SuperballTurnsItsSlipRoundWithoutLoss) {
  // Garwin, Am. J. Phys. 37 (1969) 88: slip and rebound are both returned, and energy with them.
  const ImpactPoint point = touching(0, 1, 0.5, 2, -3, 1);
  const ImpactCoefficients c{
      .restitution = 1, .friction = 5, .later_friction = 5, .tangential_restitution = 1};
  const ContactImpulse impulse = with_tangential_restitution(point, c, stronge_impulse(point, c));
  EXPECT_NEAR(slip_speed_after(point, impulse), -point.slip_speed, 1e-14);
  EXPECT_NEAR(gap_rate_after(point, impulse), -point.gap_rate, 1e-14);
  EXPECT_NEAR(energy_change(point, impulse), 0, 1e-13);
}

TEST(ImpactLaws, TangentialRestitutionIsWhatFrictionHolds) {
  const ImpactPoint point = touching(0, 1, 0.5, 3, -2, 0);
  const ImpactCoefficients c{
      .restitution = 0.5, .friction = 0.4, .later_friction = 0.4, .tangential_restitution = 1};
  const ContactImpulse impulse = with_tangential_restitution(point, c, stronge_impulse(point, c));
  EXPECT_NEAR(impulse.tangential, -0.4 * impulse.normal, 1e-14);
}

TEST(ImpactLaws, RestitutionFallsWithTheFourthRootBeyondTheYieldSpeed) {
  EXPECT_EQ(falling_restitution(0.8, 0.5, 1), 0.8);
  EXPECT_EQ(falling_restitution(0.8, 16, 1), 0.4);
  EXPECT_EQ(falling_restitution(0.8, 100, 0), 0.8) << "does not fall";
  EXPECT_DOUBLE_EQ(falling_restitution(0.8, 16, 1, 0.5), 0.2);
}

}  // namespace
}  // namespace plumb::precise
