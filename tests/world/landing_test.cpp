#include <gtest/gtest.h>

#include <cmath>

#include "tests/world/support.h"

// Boxes that land on their corners, one after the other, on a smooth floor without gravity. Between impacts
// the centre moves uniformly and the box turns uniformly; at an impact of a corner with lever x along the
// floor, the impulse -(1 + e) v / (1/m + x^2/I) brings the corner's velocity v to -e v (Newton). The times of
// impacts are found by bisection.
namespace plumb {
namespace {

constexpr double kWidth = 1, kHeight = 0.5, kMass = 1,
                 kInertia = kMass * (kWidth * kWidth + kHeight * kHeight) / 12;

struct Plank {
  double y = 0, angle = 0, vy = 0, w = 0;

  Vec2d corner(int i, double t) const {
    const Vec2d at{i % 2 == 0 ? -kWidth / 2 : kWidth / 2, i < 2 ? -kHeight / 2 : kHeight / 2};
    const double a = angle + w * t;
    return {std::cos(a) * at.x - std::sin(a) * at.y, y + vy * t + std::sin(a) * at.x + std::cos(a) * at.y};
  }
  double rate(int i, double t) const { return vy + w * corner(i, t).x; }
  void move(double t) { y += vy * t, angle += w * t; }
};

// Returns the time until corner `i` comes down to the floor, at most `most`, s.
double time_to_land(const Plank& plank, int i, double most) {
  constexpr int kParts = 4000;
  for (int k = 0; k < kParts; ++k) {
    double low = most * k / kParts, high = most * (k + 1) / kParts;
    // Just after its impact a corner is at the floor and leaves it.
    if (!(plank.corner(i, high).y < 0) || (plank.corner(i, low).y < 1e-12 && plank.rate(i, low) > -1e-9))
      continue;
    for (int j = 0; j < 80; ++j) {
      const double middle = (low + high) / 2;
      (plank.corner(i, middle).y < 0 ? high : low) = middle;
    }
    return low;
  }
  return most;
}

// Moves it for `time`, s, or up to a hundred impacts.
void land(Plank& plank, double restitution, double time) {
  for (int impacts = 0; impacts < 100; ++impacts) {
    int first = 0;
    double soonest = time;
    for (int i = 0; i < 4; ++i) {
      const double t = time_to_land(plank, i, time);
      if (t < soonest) soonest = t, first = i;
    }
    plank.move(soonest);
    time -= soonest;
    if (!(time > 0)) return;
    const double lever = plank.corner(first, 0).x, v = plank.rate(first, 0);
    const double impulse = -(1 + restitution) * v / (1 / kMass + lever * lever / kInertia);
    plank.vy += impulse / kMass, plank.w += impulse * lever / kInertia;
  }
}

// Solved together, the two corners of a side would take all of its spin: the box would lie instead of
// leaping.
TEST(Landing, CornersStrikeOneAfterTheOther) {
  int leaps = 0;
  for (const double restitution : {0.0, 0.3, 0.7}) {
    for (const double angle : {0.03, 0.1, -0.4, 1.2}) {
      for (const double speed : {50.0, 200.0, 1000.0}) {
        for (const double spin : {0.0, -4.0}) {
          Plank plank{.y = 2, .angle = angle, .vy = -speed, .w = spin};
          DoubleWorld world({.gravity = {0, 0}, .sleeping = false});
          const Material smooth{.friction = 0, .restitution = restitution};
          world.create_body({.type = BodyType::Static, .position = {0, -1}},
                            {.geometry = Box{100, 2}, .material = smooth});
          const BodyId box = world.create_body(
              {.position = {0, plank.y}, .angle = angle, .velocity = {0, -speed}, .angular_velocity = spin},
              {.geometry = Box{kWidth, kHeight}, .density = kMass / (kWidth * kHeight), .material = smooth});
          const double time = (std::ceil(60 * 3 / speed) + 60) / 60;
          land(plank, restitution, time);
          run(world, static_cast<int>(std::lround(60 * time)));
          SCOPED_TRACE(testing::Message() << restitution << ' ' << angle << ' ' << speed << ' ' << spin);
          // After impacts that follow each other without end the box lies: to the contacts' slop.
          const bool lies = plank.vy < 1e-3 * speed;
          leaps += lies ? 0 : 1;
          // Without restitution a body may have become so slow that its contacts take a later impact.
          const double error = lies ? 5e-3 : (restitution > 0 ? 1e-9 : 1e-3) * speed;
          EXPECT_NEAR(world.velocity(box).y, plank.vy, error);
          EXPECT_NEAR(world.angular_velocity(box), plank.w, error);
          EXPECT_NEAR(world.position(box).y, plank.y, error);
        }
      }
    }
  }
  EXPECT_GT(leaps, 40);
}

}  // namespace
}  // namespace plumb
