#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "tests/demos/play.h"

// The second project's milestones: forces and masses, played as a player would.
namespace plumb::demos {
namespace {

constexpr double kGravity = 9.81;
constexpr Vec2d kMuzzle{1, 1.5};
// Velocities are floats; a step rounds one a few times.
constexpr double kFloat = std::numeric_limits<float>::epsilon();

double speed_of(const Demo& demo, const char* name) {
  return std::sqrt(length_squared(demo.world()->velocity(body_called(demo, name))));
}

std::unique_ptr<Demo> weightless(const char* fired_by) {
  std::unique_ptr<Demo> demo = make("cannonballs");
  demo->set("gravity", 0);
  demo->set("balls", "both");
  demo->set("fired by", fired_by);
  return demo;
}

// v = J / m, at once, and it lasts.
TEST(Cannonballs, TheSameImpulseGivesTenTimesTheMassATenthOfTheSpeed) {
  const std::unique_ptr<Demo> demo = weightless("impulse");
  demo->set("impulse", 12);
  click(*demo, {20, 12});
  for (const int count : {0, 30}) {
    steps(*demo, count);
    EXPECT_NEAR(speed_of(*demo, "light"), 12, 12 * kFloat);
    EXPECT_NEAR(speed_of(*demo, "heavy"), 1.2, 1.2 * kFloat);
  }
}

// v = F t / m while it acts; after T it stays at F T / m, also where T is no whole number of steps.
TEST(Cannonballs, TheSameForceGivesTenTimesTheMassATenthOfTheAcceleration) {
  for (const double duration : {0.5, 0.31}) {
    const std::unique_ptr<Demo> demo = weightless("force");
    demo->set("force", 60);
    demo->set("duration", duration);
    click(*demo, {20, 12});
    for (int n = 1; n <= 45; ++n) {
      demo->step_once();
      const double pushed = std::min(n * demo->dt(), duration);
      EXPECT_NEAR(speed_of(*demo, "light"), 60 * pushed, 60 * pushed * n * kFloat);
      EXPECT_NEAR(speed_of(*demo, "heavy"), 6 * pushed, 6 * pushed * n * kFloat);
    }
  }
}

// Weight, wind and thrust add up: a = g + (wind + thrust) / m, and constant forces make x = v t + a t^2 / 2.
TEST(Cannonballs, ForcesAddUp) {
  const std::unique_ptr<Demo> demo = make("cannonballs");
  demo->set("balls", "both");
  demo->set("fired by", "force");
  demo->set("force", 100);
  demo->set("duration", 2);
  demo->set("wind", -6);
  click(*demo, kMuzzle + Vec2d{3, 4});
  const double masses[] = {1, 10};
  const char* names[] = {"light", "heavy"};
  const Vec2d thrust{60, 80}, wind{-6, 0};
  Vec2d start[2];
  for (const int i : {0, 1}) start[i] = demo->world()->position(body_called(*demo, names[i]));
  for (int n = 1; n <= 45; ++n) {  // until the heavy one is near the ground
    demo->step_once();
    const double t = n * demo->dt();
    for (const int i : {0, 1}) {
      const BodyId ball = body_called(*demo, names[i]);
      const Vec2d a = Vec2d{0, -kGravity} + 1 / masses[i] * (thrust + wind);
      const Vec2d v = demo->world()->velocity(ball), x = demo->world()->position(ball);
      const double tolerance = n * kFloat * std::sqrt(length_squared(a)) * t;
      EXPECT_NEAR(v.x, a.x * t, tolerance);
      EXPECT_NEAR(v.y, a.y * t, tolerance);
      EXPECT_NEAR(x.x, start[i].x + a.x * t * t / 2, tolerance);
      EXPECT_NEAR(x.y, start[i].y + a.y * t * t / 2, tolerance);
    }
  }
}

// All masses fall alike; wind moves the light one ten times as much.
TEST(Cannonballs, GravityDoesNotAskForMassButWindDoes) {
  const std::unique_ptr<Demo> demo = make("cannonballs");
  demo->set("balls", "both");
  demo->set("impulse", 0);
  demo->set("wind", 5);
  demo->restart();
  click(*demo, {30, 1.5});
  const Vec2d before[] = {demo->world()->position(body_called(*demo, "light")),
                          demo->world()->position(body_called(*demo, "heavy"))};
  steps(*demo, 12);
  const Vec2d light = demo->world()->position(body_called(*demo, "light")) - before[0];
  const Vec2d heavy = demo->world()->position(body_called(*demo, "heavy")) - before[1];
  EXPECT_NEAR(light.y, -kGravity * 0.2 * 0.2 / 2, 12 * kFloat);
  EXPECT_NEAR(heavy.y, light.y, 12 * kFloat);
  EXPECT_NEAR(light.x, 10 * heavy.x, 12 * kFloat);
  EXPECT_NEAR(light.x, 5 * 0.2 * 0.2 / 2, 12 * kFloat);
}

TEST(Cannonballs, BallsFlyTowardsThePointer) {
  for (const Vec2d target : {Vec2d{20, 1.5}, Vec2d{1, 15}, Vec2d{11, 11.5}, Vec2d{-1, 2}}) {
    const std::unique_ptr<Demo> demo = weightless("impulse");
    demo->set("balls", "light (1 kg)");
    demo->hover({5, 5});
    click(*demo, target);
    const Vec2d way = target - kMuzzle, v = demo->world()->velocity(body_called(*demo, "light"));
    const double length = std::sqrt(length_squared(way)), speed = std::sqrt(length_squared(v));
    EXPECT_NEAR(dot(v, way), length * speed, length * speed * 4 * kFloat);
  }
}

// Arrows are drawn for what acts, and no more than that.
class Arrows : public DebugDraw {
 public:
  void polygon(std::span<const Vec2d>, double, DrawRole) override {}
  void circle(Vec2d, double, Vec2d, DrawRole) override {}
  void capsule(Vec2d, Vec2d, double, DrawRole) override {}
  void segment(Vec2d start, Vec2d end, DrawRole role) override {
    if (role == DrawRole::Force) lines.push_back(end - start);
  }
  void point(Vec2d, DrawRole) override {}
  void text(Vec2d, std::string_view, DrawRole) override {}
  std::vector<Vec2d> lines;
};

TEST(Cannonballs, ForcesAreDrawn) {
  const std::unique_ptr<Demo> demo = make("cannonballs");
  demo->set("balls", "light (1 kg)");
  demo->set("wind", 10);
  click(*demo, {20, 16});
  demo->step_once();
  Arrows seen;
  demo->draw(seen);
  ASSERT_EQ(seen.lines.size(), 6u);  // weight and wind: a shaft and two sides of the head each
  EXPECT_NEAR(seen.lines[0].y / seen.lines[3].x, -kGravity / 10, 1e-6);
  EXPECT_EQ(seen.lines[0].x, 0);
  EXPECT_EQ(seen.lines[3].y, 0);
  demo->set("each force", 0);
  Arrows none;
  demo->draw(none);
  EXPECT_TRUE(none.lines.empty());
}

TEST(Cannonballs, KeysChooseFireAndClear) {
  const std::unique_ptr<Demo> demo = make("cannonballs");
  demo->key('2');
  demo->key(' ');
  demo->key('1');
  demo->key(' ');
  EXPECT_EQ(bodies_called(*demo, "heavy").size(), 1u);
  EXPECT_EQ(bodies_called(*demo, "light").size(), 1u);
  for (int i = 0; i < 100; ++i) demo->key(' ');
  EXPECT_EQ(figure(*demo, "balls"), 40);
  demo->key('c');
  EXPECT_EQ(figure(*demo, "balls"), 0);
}

}  // namespace
}  // namespace plumb::demos
