#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/simulation/simulation.h"
#include "tests/demos/play.h"

// The first project's milestones, played as a player would.
namespace plumb::demos {
namespace {

constexpr double kGravity = 9.81, kRadius = 0.3, kWidth = 8, kHeight = 6;
constexpr double kRounding = 3e-13;  // of sums of a hundred numbers below 10

enum Scheme { kExplicitEuler, kSemiImplicitEuler, kVerlet };

BodyState ball(const Demo& demo) { return demo.simulation()->state(1); }

std::unique_ptr<Demo> undamped(Scheme scheme, double restitution, double dt = 1.0 / 60) {
  std::unique_ptr<Demo> demo = make("bouncing_ball");
  demo->set("integrator", scheme);
  demo->set("restitution", restitution);
  demo->set("damping", 0);
  demo->set("dt", dt);
  return demo;
}

class EveryScheme : public testing::TestWithParam<Scheme> {};
std::string name_of(const testing::TestParamInfo<Scheme>& each) {
  const char* names[] = {"explicit_euler", "semi_implicit_euler", "verlet"};
  return names[each.param];
}
INSTANTIATE_TEST_SUITE_P(Schemes, EveryScheme, testing::Values(kExplicitEuler, kSemiImplicitEuler, kVerlet),
                         name_of);

// Gravity works, and speed grows as the ball falls: v = g t in every scheme. After n steps of h it has fallen
// by g h^2 times n (n - 1) / 2 with explicit Euler, n (n + 1) / 2 with semi-implicit Euler, and the exact
// n^2 / 2 with Verlet: these are the sums of what each scheme adds.
TEST_P(EveryScheme, FallsFasterAndFaster) {
  for (const double dt : {1.0 / 30, 1.0 / 60, 0.004}) {
    const std::unique_ptr<Demo> demo = undamped(GetParam(), 1, dt);
    click(*demo, {2, 5.5});
    for (int n = 1; n * dt < 0.9; ++n) {
      demo->step_once();
      const double halves[] = {n * (n - 1.0), n * (n + 1.0), n * static_cast<double>(n)};
      EXPECT_NEAR(ball(*demo).velocity.y, -kGravity * n * dt, kRounding);
      EXPECT_NEAR(ball(*demo).position.y, 5.5 - kGravity * dt * dt * halves[GetParam()] / 2, kRounding);
      EXPECT_NEAR(ball(*demo).position.x, 2, kRounding);
    }
  }
}

// Change of energy in a step of free fall: + m (g h)^2 / 2 with explicit Euler, less as much with semi-
// implicit Euler, nothing with Verlet.
TEST_P(EveryScheme, KeepsGainsOrLosesEnergyAsItMust) {
  const double dt = 0.02, share = kGravity * kGravity * dt * dt / 2;
  const std::unique_ptr<Demo> demo = undamped(GetParam(), 1, dt);
  const double start = figure(*demo, "energy");
  constexpr int kSteps = 40;
  steps(*demo, kSteps);
  const double per_step[] = {share, -share, 0};
  EXPECT_NEAR(figure(*demo, "energy") - start, kSteps * per_step[GetParam()], 100 * kRounding);
}

// Folds a path without walls into the room from `low` to `high`: returns the place for the way `way`.
double folded(double way, double low, double high) {
  const double room = high - low;
  const double at = std::fmod(std::fmod(way - low, 2 * room) + 2 * room, 2 * room);
  return low + (at <= room ? at : 2 * room - at);
}

// Without gravity the ball goes straight between elastic walls. Verlet turns it where it touches; the Euler
// schemes where a step ends, at most a step's way before or behind.
TEST_P(EveryScheme, BouncesOffAllFourWalls) {
  const std::unique_ptr<Demo> demo = undamped(GetParam(), 1);
  steps(*demo, 30);
  demo->set("gravity", 0);
  const BodyState start = ball(*demo);
  bool left = false, right = false, floor = false, ceiling = false;
  Vec2d before = start.velocity;
  int bounces = 0;
  for (int n = 1; n <= 600; ++n) {
    demo->step_once();
    const BodyState now = ball(*demo);
    const Vec2d way = start.position + n * demo->dt() * start.velocity;
    bounces += (now.velocity.x != before.x ? 1 : 0) + (now.velocity.y != before.y ? 1 : 0);
    const double step = demo->dt() * std::sqrt(length_squared(start.velocity));
    const double tolerance = GetParam() == kVerlet ? 100 * kRounding : 2 * bounces * step + kRounding;
    EXPECT_NEAR(now.position.x, folded(way.x, kRadius, kWidth - kRadius), tolerance) << n;
    EXPECT_NEAR(now.position.y, folded(way.y, kRadius, kHeight - kRadius), tolerance) << n;
    left = left || (before.x < 0 && now.velocity.x > 0);
    right = right || (before.x > 0 && now.velocity.x < 0);
    floor = floor || (before.y < 0 && now.velocity.y > 0);
    ceiling = ceiling || (before.y > 0 && now.velocity.y < 0);
    before = now.velocity;
  }
  EXPECT_TRUE(left && right && floor && ceiling);
  EXPECT_NEAR(length_squared(before), length_squared(start.velocity), 100 * kRounding);
}

// A ball that is dropped from h returns to e^2 h.
TEST(BouncingBall, ReturnsToTheSquareOfItsRestitution) {
  for (const double restitution : {0.0, 0.25, 0.5, 0.8, 1.0}) {
    const double dt = 1.0 / 240, drop = 4;
    const std::unique_ptr<Demo> demo = undamped(kVerlet, restitution, dt);
    click(*demo, {4, kRadius + drop});
    const double fall = std::sqrt(2 * drop / kGravity);
    double highest = 0;
    for (int n = 0; n * dt < fall * (1 + 2 * restitution); ++n) {
      demo->step_once();
      const BodyState now = ball(*demo);
      const bool rises = now.velocity.y > 0;
      // The place to which its speed takes it; the impact itself lies within a step.
      const double top = now.position.y - kRadius + now.velocity.y * now.velocity.y / (2 * kGravity);
      if (n * dt > fall && rises) highest = std::max(highest, top);
    }
    EXPECT_NEAR(highest, restitution * restitution * drop, kRounding) << restitution;
  }
}

// Air and bounces take its energy: it comes to rest on the floor.
TEST(BouncingBall, SettlesWithDamping) {
  const std::unique_ptr<Demo> demo = make("bouncing_ball");
  demo->set("damping", 1);
  steps(*demo, 60 * 20);
  EXPECT_NEAR(figure(*demo, "height"), 0, 1e-3);
  EXPECT_LT(figure(*demo, "speed"), 1e-6);
}

// Without gravity and walls in reach, drag alone: v' = -c v has its closed form in each scheme, (1 - c h)^n
// for the Euler ones.
TEST(BouncingBall, DampingTakesItsShareOfTheSpeed) {
  const std::unique_ptr<Demo> demo = undamped(kSemiImplicitEuler, 1);
  demo->set("gravity", 0);
  demo->set("damping", 2);
  constexpr int kSteps = 60;
  steps(*demo, kSteps);
  EXPECT_NEAR(ball(*demo).velocity.x, 2.5 * std::pow(1 - 2 * demo->dt(), kSteps), kRounding);
}

TEST(BouncingBall, AClickMovesIt) {
  const std::unique_ptr<Demo> demo = undamped(kVerlet, 0.5);
  steps(*demo, 100);
  click(*demo, {5, 3});
  EXPECT_EQ(ball(*demo).position, (Vec2d{5, 3}));
  EXPECT_EQ(ball(*demo).velocity, (Vec2d{0, 0}));
  steps(*demo, 30);
  EXPECT_NEAR(ball(*demo).position.y, 3 - kGravity / 8, kRounding);
  // Held, it stays; and it stays in the room.
  demo->press({1, 5});
  demo->drag({-50, 2});
  steps(*demo, 30);
  EXPECT_EQ(ball(*demo).position, (Vec2d{kRadius, 2}));
  demo->release({4, 4});
  EXPECT_EQ(ball(*demo).position, (Vec2d{4, 4}));
}

// The same calls at the same simulated times give the same bits however frames come.
TEST(BouncingBall, SamePathOnAnyFrameRate) {
  const auto play = [](const std::vector<double>& frames) {
    const std::unique_ptr<Demo> demo = make("bouncing_ball");
    for (std::size_t i = 0; i < 2000 && demo->step_count() < 240; ++i)
      demo->advance(frames[i % frames.size()]);
    EXPECT_EQ(demo->step_count(), 240);
    return demo->hash();
  };
  const std::uint64_t expected = play({1.0 / 60});
  EXPECT_EQ(play({1.0 / 30}), expected);
  EXPECT_EQ(play({1.0 / 144}), expected);
  EXPECT_EQ(play({1.0 / 240, 1.0 / 90, 0.001}), expected);
}

// Drawn bodies move evenly between the steps, a step behind.
class BallPlace : public DebugDraw {
 public:
  void polygon(std::span<const Vec2d>, double, DrawRole) override {}
  void circle(Vec2d centre, double, Vec2d, DrawRole) override { place = centre; }
  void capsule(Vec2d, Vec2d, double, DrawRole) override {}
  void segment(Vec2d, Vec2d, DrawRole) override {}
  void point(Vec2d, DrawRole) override {}
  void text(Vec2d, std::string_view, DrawRole) override {}
  Vec2d place{};
};

TEST(BouncingBall, IsDrawnBetweenItsSteps) {
  const std::unique_ptr<Demo> demo = undamped(kVerlet, 1);
  demo->set("gravity", 0);
  demo->advance(demo->dt());
  for (int i = 1; i <= 30; ++i) {
    demo->advance(0.3 * demo->dt());
    BallPlace seen;
    demo->draw(seen);
    EXPECT_NEAR(seen.place.x, 1.5 + 2.5 * 0.3 * i * demo->dt(), kRounding) << i;
  }
}

}  // namespace
}  // namespace plumb::demos
