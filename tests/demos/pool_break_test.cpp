#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "tests/demos/play.h"

// The third project's milestones: circles that collide, played as a player would.
namespace plumb::demos {
namespace {

constexpr double kRadius = 0.028575, kMass = 0.17;  // m, kg
constexpr double kLength = 2.54, kWidth = 1.27;     // m
constexpr double kHardness = 8;                     // 1/s: speed for a metre of aim
constexpr double kApart = kLength / 2;              // m, from the cue ball to the tip of the rack
constexpr double kFloat = std::numeric_limits<float>::epsilon();

BodyId cue(const Demo& demo) { return body_called(demo, "cue"); }
Vec2d position(const Demo& demo, const char* name) { return demo.world()->position(body_called(demo, name)); }
Vec2d velocity(const Demo& demo, const char* name) { return demo.world()->velocity(body_called(demo, name)); }

// A table without cloth and pockets.
std::unique_ptr<Demo> table(int balls, double restitution, double cue_mass = kMass) {
  std::unique_ptr<Demo> demo = make("pool_break");
  demo->set("balls", balls);
  demo->set("restitution", restitution);
  demo->set("cue mass", cue_mass);
  demo->set("cloth", 0);
  demo->set("pockets", 0);
  return demo;
}

// Aims so that the cue ball gets a velocity, m/s.
void shoot(Demo& demo, Vec2d velocity) {
  const Vec2d from = demo.world()->position(cue(demo));
  pull(demo, from, from + (1 / kHardness) * velocity);
}

class Lights : public DebugDraw {
 public:
  void polygon(std::span<const Vec2d>, double, DrawRole) override {}
  void circle(Vec2d centre, double, Vec2d, DrawRole role) override {
    if (role == DrawRole::Highlight) lit.push_back(centre);
  }
  void capsule(Vec2d, Vec2d, double, DrawRole) override {}
  void segment(Vec2d, Vec2d, DrawRole) override {}
  void point(Vec2d, DrawRole) override {}
  void text(Vec2d, std::string_view, DrawRole) override {}
  std::vector<Vec2d> lit;
};
std::size_t lit(const Demo& demo) {
  Lights lights;
  demo.draw(lights);
  return lights.lit.size();
}

// Two circles touch when their middles are two radii apart: not a step before, not a step later.
TEST(PoolBreak, CirclesAreDetectedWhenTheyTouch) {
  for (const double speed : {1.0, 3.3, 9.0}) {
    const std::unique_ptr<Demo> demo = table(1, 1);
    shoot(*demo, {speed, 0});
    const int touch = static_cast<int>(std::floor((kApart - 2 * kRadius) / speed / demo->dt()));
    steps(*demo, touch);
    EXPECT_EQ(figure(*demo, "collisions"), 0) << speed;
    EXPECT_EQ(velocity(*demo, "1"), (Vec2d{0, 0}));
    EXPECT_EQ(lit(*demo), 0u);
    steps(*demo, 1);
    EXPECT_NE(velocity(*demo, "1"), (Vec2d{0, 0})) << speed;
    EXPECT_EQ(figure(*demo, "collisions"), 1) << speed;
    EXPECT_EQ(lit(*demo), 2u);
    if (speed > 1) continue;
    steps(*demo, static_cast<int>(0.25 / demo->dt()) + 1);
    EXPECT_EQ(lit(*demo), 0u);  // after a quarter of a second, before the cushion
  }
}

// Newton's and Poisson's law of a head-on collision, for any masses and restitution:
// v1' = (m1 - e m2) / (m1 + m2) v, v2' = (1 + e) m1 / (m1 + m2) v. A heavy ball barely slows, a light one
// comes back.
TEST(PoolBreak, HeadOnCollisionsFollowTheirClosedForm) {
  for (const double mass : {kMass / 10, kMass, 10 * kMass}) {
    for (const double e : {0.0, 0.5, 0.95, 1.0}) {
      const std::unique_ptr<Demo> demo = table(1, e, mass);
      const double v = 2;
      shoot(*demo, {v, 0});
      steps(*demo, static_cast<int>(std::ceil(kApart / v / demo->dt())));
      EXPECT_NEAR(velocity(*demo, "cue").x, (mass - e * kMass) / (mass + kMass) * v, 8 * kFloat * v);
      EXPECT_NEAR(velocity(*demo, "1").x, (1 + e) * mass / (mass + kMass) * v, 8 * kFloat * v);
      EXPECT_NEAR(velocity(*demo, "1").y, 0, kFloat);
    }
  }
  const std::unique_ptr<Demo> heavy = table(1, 1, 10 * kMass);
  shoot(*heavy, {2, 0});
  steps(*heavy, 200);
  EXPECT_GT(velocity(*heavy, "cue").x, 0.8 * 2);
}

// The slider counts for the next contact, not for the next game.
TEST(PoolBreak, RestitutionChangesWhileTheBallsRoll) {
  const std::unique_ptr<Demo> demo = table(1, 1);
  shoot(*demo, {2, 0});
  steps(*demo, 60);
  demo->set("restitution", 0);
  steps(*demo, 100);
  EXPECT_NEAR(velocity(*demo, "cue").x, 1, 8 * kFloat);
  EXPECT_NEAR(velocity(*demo, "1").x, 1, 8 * kFloat);
}

// Off-centre, with the line of the shot at b from the middle of the ball that rests: that one leaves along
// the line of centres at the touch, at asin(b / 2 r) from the shot; smooth elastic balls of one mass part at
// a right angle. The world's normal is that of the step's end before, which is wrong by an angle of at most v
// dt / 2 r times tan(asin(b / 2 r)), and by ever less with shorter steps.
TEST(PoolBreak, ObliqueCollisionsPartAtARightAngle) {
  const double offset = kRadius, v = 2, half = std::asin(offset / (2 * kRadius));
  const double aim = std::asin(offset / kApart);
  const Vec2d way{std::cos(aim), std::sin(aim)};
  for (const double dt : {1.0 / 240, 0.001}) {
    const std::unique_ptr<Demo> demo = table(1, 1);
    demo->set("dt", dt);
    shoot(*demo, v * way);
    steps(*demo, static_cast<int>(std::ceil(kApart / v / dt)));
    const Vec2d hit = velocity(*demo, "1"), left = velocity(*demo, "cue");
    EXPECT_NEAR(dot(hit, left), 0, 16 * kFloat * v * v);
    EXPECT_NEAR(length_squared(hit) + length_squared(left), v * v, 16 * kFloat * v * v);
    const double angle = std::acos(dot(hit, way) / std::sqrt(length_squared(hit)));
    EXPECT_NEAR(angle, half, v * dt / (2 * kRadius) * std::tan(half));
  }
}

// Cushions give e back of the speed towards them, and leave the speed along them.
TEST(PoolBreak, BallsBounceOffCushions) {
  for (const double e : {0.0, 0.6, 1.0}) {
    const std::unique_ptr<Demo> demo = table(1, e);
    shoot(*demo, {-2, 0.5});
    steps(*demo, 100);
    EXPECT_NEAR(velocity(*demo, "cue").x, 2 * e, 8 * kFloat * 2);
    EXPECT_NEAR(velocity(*demo, "cue").y, 0.5, 8 * kFloat);
  }
}

// The break: momentum is that of the shot until a cushion takes some. Energy falls; contacts that push
// overlaps apart give back less than 2e-4 of it. Every ball moves and is lit.
TEST(PoolBreak, TheRackScattersAndKeepsItsMomentum) {
  for (const double e : {0.0, 0.5, 0.95}) {
    const std::unique_ptr<Demo> demo = table(15, e);
    shoot(*demo, {8, 0.1});
    const Vec2d momentum = kMass * velocity(*demo, "cue");
    double energy = figure(*demo, "kinetic energy");
    EXPECT_NEAR(energy, kMass / 2 * (64 + 0.01), 1e-4);
    // Faster than the shot no ball is: what is farther than a step of it from all cushions reaches none.
    const auto clear = [&] {
      for (int ball = 0; ball <= 15; ++ball) {
        const Vec2d at = position(*demo, ball == 0 ? "cue" : std::to_string(ball).c_str());
        const double room = kRadius + 8 * demo->dt();
        if (std::abs(at.x) > kLength / 2 - room || std::abs(at.y) > kWidth / 2 - room) return false;
      }
      return true;
    };
    while (clear() && demo->time() < 0.25) {
      demo->step_once();
      EXPECT_NEAR(figure(*demo, "momentum x"), momentum.x, 16 * kFloat * momentum.x) << e;
      EXPECT_NEAR(figure(*demo, "momentum y"), momentum.y, 16 * kFloat * momentum.x) << e;
      EXPECT_LE(figure(*demo, "kinetic energy"), energy * (1 + 2e-4)) << e;
      energy = figure(*demo, "kinetic energy");
    }
    EXPECT_GT(demo->time(), 0.15);  // the shot has met the rack
    EXPECT_EQ(lit(*demo), 16u);
    for (int ball = 1; ball <= 15; ++ball)
      EXPECT_GT(length_squared(velocity(*demo, std::to_string(ball).c_str())), 0) << ball;
  }
}

TEST(PoolBreak, PocketsTakeBallsAndGiveTheCueBallBack) {
  const std::unique_ptr<Demo> demo = table(1, 1);
  demo->set("pockets", 1);
  const Vec2d way = Vec2d{-kLength / 2, kWidth / 2} - demo->world()->position(cue(*demo));
  shoot(*demo, (2 / std::sqrt(length_squared(way))) * way);
  steps(*demo, static_cast<int>(std::sqrt(length_squared(way)) / 2 / demo->dt()) + 1);
  EXPECT_EQ(demo->world()->position(cue(*demo)), (Vec2d{-kLength / 4, 0}));
  EXPECT_EQ(velocity(*demo, "cue"), (Vec2d{0, 0}));
  demo->key(' ');
  steps(*demo, 1);
  EXPECT_GT(velocity(*demo, "cue").x, 11);
}

TEST(PoolBreak, TheClothSlowsBalls) {
  const std::unique_ptr<Demo> demo = table(1, 1);
  demo->set("cloth", 1.5);
  shoot(*demo, {0, 1});
  const double t = 0.25;
  steps(*demo, static_cast<int>(std::lround(t / demo->dt())));
  EXPECT_NEAR(velocity(*demo, "cue").y, std::exp(-1.5 * t), 60 * kFloat);
}

TEST(PoolBreak, KeysChangeTheCueBall) {
  const std::unique_ptr<Demo> demo = table(1, 1);
  for (const double mass : {10 * kMass, kMass / 10, kMass}) {
    demo->key('m');
    EXPECT_NEAR(demo->world()->mass(cue(*demo)), mass, 1e-7);
  }
}

}  // namespace
}  // namespace plumb::demos
