// The truths of the catalogue's scenes against published digits and other formulas.
#include <gtest/gtest.h>

#include <boost/math/special_functions/ellint_1.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "scenarios/truth/billiard.h"
#include "scenarios/truth/bob_chain.h"
#include "scenarios/truth/bounces.h"
#include "scenarios/truth/orbit.h"
#include "scenarios/truth/oscillator.h"
#include "scenarios/truth/phases.h"

namespace plumb::scenarios::truth {
namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

Problem problem(std::string_view name) { return select(name).front().build(); }

std::vector<BodyState> exact(const Problem& of, double time) {
  std::vector<BodyState> states(of.scene.bodies.size());
  of.truth.exact(time, states);
  return states;
}

BodyState last(const Problem& of, double time) { return exact(of, time).back(); }

/// Returns the time at which `after` becomes true, between `from` and `to`.
template <class Condition>
double moment(double from, double to, const Condition& after) {
  for (int i = 0; i < 60; ++i) (after((from + to) / 2) ? to : from) = (from + to) / 2;
  return to;
}

TEST(DampedSwing, SolvesItsEquationAtEveryDampingRatio) {
  for (const Real zeta : {0.0L, 0.3L, 0.999999L, 1.0L, 1.000001L, 3.0L}) {
    const Trajectory path(
        {0.7L, -1.1L},
        [zeta](const auto& y, auto& rate) {
          rate = {y[1], -4 * y[0] - 4 * zeta * y[1]};
        },
        1.0L / 64);
    for (const Real t : {0.1L, 1.0L, 2.7L}) {
      const Swing now = damped_swing({0.7L, -1.1L}, 2, zeta, t);
      EXPECT_NEAR(static_cast<double>(now.place - path.at(t)[0]), 0, 1e-14) << zeta;
      EXPECT_NEAR(static_cast<double>(now.rate - path.at(t)[1]), 0, 1e-14) << zeta;
    }
  }
}

TEST(ChainSwing, SolvesTheEquationsOfTheMasses) {
  constexpr int kCount = 5;
  const Trajectory path(
      {0.3L, 0, 0, 0, 0, 0, 0, 0, 0, 0},
      [](const auto& y, auto& rate) {
        for (int i = 0; i < kCount; ++i) {
          const Real left = i == 0 ? 0 : y[i - 1], right = i == kCount - 1 ? 0 : y[i + 1];
          rate[i] = y[kCount + i];
          rate[kCount + i] = 9 * (left + right - 2 * y[i]);
        }
      },
      1.0L / 64);
  for (int j = 1; j <= kCount; ++j) {
    const Swing now = chain_swing(kCount, j, 3, 0.3L, 1.7L);
    EXPECT_NEAR(static_cast<double>(now.place - path.at(1.7L)[j - 1]), 0, 1e-14);
    EXPECT_NEAR(static_cast<double>(now.rate - path.at(1.7L)[kCount + j - 1]), 0, 1e-14);
  }
}

TEST(Bounces, EndWhereTheSeriesDoes) {
  // h = 1 m, e = 0.8: at rest after 4.063713 s and a path of 4.555556 m.
  const Bounces bounces(1, 9.81L, 0.8L, 10);
  EXPECT_NEAR(bounces.impacts().back(), 4.063713, 5e-7);
  EXPECT_EQ(bounces.at(4.07L).place, 0);
  EXPECT_EQ(bounces.at(4.07L).rate, 0);
  double path = 0;
  for (int i = 0; i < 410'000; ++i) path += std::fabs(static_cast<double>(bounces.at(i * 1e-5L).rate)) * 1e-5;
  EXPECT_NEAR(path, 4.555556, 1e-4);
}

TEST(Bounces, GoOnForeverWhenElastic) {
  const Bounces bounces(1, 9.81L, 1, 10);
  const Real fall = std::sqrt(2 / 9.81L);
  EXPECT_NEAR(static_cast<double>(bounces.at(8 * fall).place), 1, 1e-15);
}

TEST(Phases, ChangeTheLawAtTheEventItself) {
  // Free fall from 1 m, then rest.
  const Phases path(
      {1, 0},
      {{second_order_law([](Real, Real) { return Real(-2); }), [](const auto& y) { return y[0]; },
        [](const auto&) {
          return Trajectory::State{0, 0};
        }},
       {second_order_law([](Real, Real) { return Real(0); })}},
      3);
  ASSERT_EQ(path.ends().size(), 1u);
  EXPECT_NEAR(path.ends()[0], 1, 1e-17);
  EXPECT_EQ(path.jumps(), path.ends());
  EXPECT_NEAR(static_cast<double>(path.at(0.5L)[0]), 0.75, 1e-16);
  EXPECT_EQ(path.at(2)[0], 0);
}

TEST(Orbit, ReturnsAfterItsPeriodAndKeepsItsEnergy) {
  for (const Real e : {0.0L, 0.5L, 0.9L}) {
    EXPECT_NEAR(static_cast<double>(orbit(e, 2 * kPi).position.x), static_cast<double>(1 - e), 1e-15);
    for (const Real t : {0.3L, 2.0L, 5.0L}) {
      const Motion now = orbit(e, t);
      const Real energy = length_squared(now.velocity) / 2 - 1 / std::sqrt(length_squared(now.position));
      EXPECT_NEAR(static_cast<double>(energy), -0.5, 1e-15);
    }
  }
}

TEST(Billiard, ReflectsDiscsFromWallsInGravity) {
  // A ball thrown against a wall and the floor, elastic: the same as without the wall, mirrored.
  const std::vector<Disc> ball = {{1, 0, {.position = {0, 1}, .velocity = {2, 0}}}};
  const Wall floor{{0, 0}, {0, 1}}, wall{{1, 0}, {-1, 0}};
  const Billiard open(ball, 1, 3, {{0, -9.81L}, {floor}}), closed(ball, 1, 3, {{0, -9.81L}, {floor, wall}});
  EXPECT_EQ(closed.impacts().size(), open.impacts().size() + 1);
  EXPECT_NEAR(static_cast<double>(closed.at(2)[0].position.x), 2 - 4, 1e-15);
  EXPECT_NEAR(static_cast<double>(closed.at(2)[0].position.y - open.at(2)[0].position.y), 0, 1e-15);
  const Real fall = std::sqrt(2 / 9.81L);
  EXPECT_NEAR(open.impacts()[1], static_cast<double>(3 * fall), 1e-15);
}

TEST(PiBilliard, CountsTheDigits) {
  EXPECT_EQ(problem("pi_billiard/3").truth.impacts.size(), 3u);
  EXPECT_EQ(problem("pi_billiard/31").truth.impacts.size(), 31u);
  // The last impact is between balls that go almost side by side, minutes later.
  Problem longer = problem("pi_billiard/314");
  EXPECT_EQ(longer.truth.impacts.size(), 313u);
  EXPECT_EQ(billiard_truth(longer.scene, 1e4, {{{0, 0}, {1, 0}}}).impacts.size(), 314u);
}

TEST(GalileanCannon, ThrowsTheLightBallAsHarterSays) {
  // Without a gap (3 m1 - m2)/(m1 + m2); the gap of 1 cm lets the heavy ball slow down a little before.
  const Problem cannon = problem("galilean_cannon/two");
  const double time = cannon.truth.impacts[1], speed = std::sqrt(2 * 9.81);
  const double leaves = last(cannon, time + 1e-9).velocity.y;
  EXPECT_NEAR(leaves / speed, (3 * 9 - 3) / 12.0, 0.02);
}

TEST(Pendulum, HasThePeriodsOfTheEllipticIntegral) {
  const double small = 2 * std::numbers::pi / std::sqrt(9.81);
  const std::vector<std::pair<std::string, double>> ratios = {{"60", 1.07318200714936},
                                                              {"90", 1.18034059901610},
                                                              {"120", 1.37288050061835},
                                                              {"170", 2.43936271967388}};
  for (const auto& [degrees, ratio] : ratios) {
    const Problem pendulum = problem("pendulum/" + degrees);
    const double quarter = moment(0.3, 2, [&](double t) { return exact(pendulum, t)[0].position.x < 0; });
    EXPECT_NEAR(4 * quarter / small, ratio, 2e-14) << degrees;
    const Real k = std::sin(std::stod(degrees) * kPi / 360);
    EXPECT_NEAR(static_cast<double>(2 / kPi * boost::math::ellint_1(k)), ratio, 5e-15);
  }
}

TEST(BobChain, SwingsSlowlyAsBernoulliSays) {
  EXPECT_NEAR(smallest_laguerre_zero(2), 2 - std::sqrt(2), 1e-15);
  EXPECT_NEAR(smallest_laguerre_zero(3), 0.415774557, 5e-10);
  EXPECT_NEAR(smallest_laguerre_zero(10), 0.137793471, 5e-10);
  for (const int count : {2, 3, 10}) {
    // A quarter of the period, but for the amplitude: 1 cm of the lowest bob, in rods of 1 m.
    const Problem modes = problem("small_modes[" + std::to_string(count) + "]");
    const double w = std::sqrt(9.81 * smallest_laguerre_zero(count));
    const double quarter = moment(0.1, 2, [&](double t) { return last(modes, t).position.x < 0; });
    EXPECT_NEAR(quarter * w, std::numbers::pi / 2, 1e-4) << count;
    EXPECT_NEAR(exact(modes, quarter)[0].position.x, 0, 1e-6) << count;  // all pass the middle at once
  }
}

TEST(BobChain, OfOneBobIsAPendulum) {
  const BobChain chain{{3}, {1.5}};
  Trajectory::State rate;
  chain.rates({0.7L, 2}, rate);
  EXPECT_NEAR(static_cast<double>(rate[1]), -9.81 * std::sin(0.7), 1e-15);
}

TEST(SlideToRoll, RollsWhenAndWhereEulerSays) {
  // v0 = 5 m/s, mu = 0.2: 0.849473 s and 3.53947 m.
  const Problem slide = problem("slide_to_roll/slide");
  const double rolls = moment(0, 2, [&](double t) {
    const BodyState now = last(slide, t);
    return now.velocity.x + 0.25 * now.angular_velocity < 1e-12;
  });
  EXPECT_NEAR(rolls, 0.849473, 5e-7);
  EXPECT_NEAR(last(slide, rolls).position.x + 2, 3.53947, 5e-6);
  EXPECT_NEAR(last(slide, 2).velocity.x, 10.0 / 3, 1e-14);
  // Backspin that is strong enough brings the disc back.
  EXPECT_LT(last(problem("slide_to_roll/backspin"), 2).velocity.x, 0);
}

TEST(Ladder, LeavesTheWallAtTwoThirdsOfItsHeight) {
  const Problem ladder = problem("ladder");
  const double start = last(ladder, 0).position.y;
  const double end = last(ladder, ladder.duration).velocity.x;
  const double leaves =
      moment(0, ladder.duration, [&](double t) { return last(ladder, t).velocity.x == end; });
  // The speed comes to its last value with a slope of zero, so the moment is good to half the digits.
  EXPECT_NEAR(last(ladder, leaves).position.y, 2.0 / 3 * start, 1e-7);
  // From energy: w^2 = (3 g/L)(1 - 2/3) cos(a0), and v_x = (L/2) w cos(a).
  const double cosine = 2.0 / 3 * std::cos(0.3), w = std::sqrt(3 * 9.81 / 2 * std::cos(0.3) / 3);
  EXPECT_NEAR(end, w * cosine, 1e-12);
}

TEST(Cylinder, IsLeftAtTwoThirdsOfTheHeight) {
  const Problem slides = problem("cylinder/slides");
  const double start = last(slides, 0).position.y;
  const double leaves = moment(0, slides.duration, [&](double t) {
    const BodyState now = last(slides, t);
    return std::hypot(now.position.x, now.position.y) > 1.25 + 1e-13;
  });
  EXPECT_NEAR(last(slides, leaves).position.y, 2.0 / 3 * start, 1e-3);
  const double sideways = last(slides, slides.duration).velocity.x;
  // Energy at the leaving point: v^2 = 2 g (2/3 - 1) ... = (2/3) g h0, and v_x = v cos(a).
  const double cosine = 2.0 / 3 * std::cos(0.3);
  EXPECT_NEAR(sideways, std::sqrt(9.81 * 1.25 * cosine) * cosine, 1e-12);
}

TEST(StruckRod, HasAPointThatStandsStill) {
  const Problem rod = problem("struck_rod/elastic");
  const BodyState end = exact(rod, rod.duration)[0];
  const double beyond = (4 + 0.01) / (12 * 0.7);
  EXPECT_NEAR(end.velocity.x + end.angular_velocity * beyond, 0, 1e-14);
}

TEST(BlockOnCart, EndsWithOneSpeed) {
  const auto end = exact(problem("block_on_cart"), 1.5);
  EXPECT_NEAR(end[1].velocity.x, 0.5, 1e-15);
  EXPECT_NEAR(end[2].velocity.x, 0.5, 1e-15);
}

TEST(Wedge, LetsTheBlockSlideOnIt) {
  // The block stays on the wedge's face: its height falls by half of what it goes relative to the wedge.
  const Problem wedge = problem("wedge");
  const auto start = exact(wedge, 0), end = exact(wedge, 0.6);
  const double along = end[2].position.x - end[1].position.x - start[2].position.x + start[1].position.x;
  EXPECT_NEAR(end[2].position.y - start[2].position.y, -along / 2, 1e-14);
}

TEST(Variants, HaveTheValueTheyAreGiven) {
  EXPECT_EQ(choose("b", {{"a", 1}, {"b", 2}}), 2);
  EXPECT_ANY_THROW(choose("c", {{"a", 1}, {"b", 2}}));
}

}  // namespace
}  // namespace plumb::scenarios::truth
