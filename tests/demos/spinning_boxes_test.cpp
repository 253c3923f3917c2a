#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "tests/demos/play.h"

// The fourth project's milestones: torque, inertia and boxes that collide, played as a player would.
namespace plumb::demos {
namespace {

constexpr double kForce = 20, kPush = 0.1;  // N, s
constexpr double kFloat = std::numeric_limits<float>::epsilon();
constexpr Vec2d kSquare{-3, 0}, kThin{2, 0};  // m, where boxes lie at the start

// The box whose middle is at a place.
BodyId box_at(const Demo& demo, Vec2d place) {
  for (const BodyId body : demo.world()->bodies()) {
    if (demo.world()->mass(body) > 0 && length_squared(demo.world()->position(body) - place) < 1e-6)
      return body;
  }
  ADD_FAILURE() << "no box at " << place.x << ", " << place.y;
  return {};
}

std::unique_ptr<Demo> room(double restitution = 1, double friction = 0) {
  std::unique_ptr<Demo> demo = make("spinning_boxes");
  demo->set("push", kForce);
  demo->set("restitution", restitution);
  demo->set("friction", friction);
  return demo;
}

// v = F t / m and no spin, whatever the form and the direction.
TEST(SpinningBoxes, APushInTheMiddleDoesNotSpin) {
  for (const Vec2d place : {kSquare, kThin}) {
    for (const Vec2d way : {Vec2d{0, 1}, Vec2d{0.6, -0.8}}) {
      const std::unique_ptr<Demo> demo = room();
      const BodyId box = box_at(*demo, place);
      const Vec2d near_middle = place + Vec2d{0.02, -0.01};
      pull(*demo, near_middle, near_middle + 0.5 * way);
      steps(*demo, 12);
      EXPECT_NEAR(demo->world()->velocity(box).x, kForce * kPush * way.x, 8 * kFloat);
      EXPECT_NEAR(demo->world()->velocity(box).y, kForce * kPush * way.y, 8 * kFloat);
      EXPECT_EQ(demo->world()->angular_velocity(box), 0);
      EXPECT_EQ(demo->world()->angle(box), 0);
    }
  }
}

// A step at a corner r gives alpha dt = (r x F) / I dt with I = m (w^2 + h^2) / 12; every corner turns the
// way that its lever says. The middle moves as if pushed there.
TEST(SpinningBoxes, APushAtACornerSpins) {
  struct Case {
    Vec2d place;
    double width, height;
  };
  for (const Case& each : {Case{kSquare, 1, 1}, Case{kThin, 2, 0.25}}) {
    const double inertia = (each.width * each.width + each.height * each.height) / 12;
    for (const Vec2d corner : {Vec2d{1, 1}, Vec2d{-1, 1}, Vec2d{1, -1}, Vec2d{-1, -1}}) {
      const std::unique_ptr<Demo> demo = room();
      const BodyId box = box_at(*demo, each.place);
      const Vec2d r{corner.x * each.width / 2, corner.y * each.height / 2};
      click(*demo, each.place + 0.95 * r);
      demo->step_once();
      const double alpha = cross(r, Vec2d{0, kForce}) / inertia;
      EXPECT_NEAR(demo->world()->angular_velocity(box), alpha * demo->dt(),
                  4 * kFloat * std::abs(alpha * demo->dt()));
      steps(*demo, 20);
      EXPECT_NEAR(demo->world()->velocity(box).y, kForce * kPush, 8 * kFloat);
      EXPECT_NEAR(demo->world()->velocity(box).x, 0, kFloat);
    }
  }
}

// Over the whole push the arm turns with the box: I theta'' = r x F at the angle theta, here by Runge and
// Kutta's method in long double with ten thousand steps. The demo's torque is that of each step's start, as
// in a sum of rectangles, whose error is dt / 2 times what alpha loses on the way.
TEST(SpinningBoxes, TheArmTurnsWithTheBox) {
  const long double inertia = 1 / 6.0L, x = 0.5L, y = 0.5L;
  const auto alpha = [&](long double angle) {
    return (x * std::cos(angle) - y * std::sin(angle)) * kForce / inertia;
  };
  long double angle = 0, spin = 0;
  const int count = 10000;
  const long double h = static_cast<long double>(kPush) / count;
  for (int i = 0; i < count; ++i) {
    const long double a1 = alpha(angle), s1 = spin;
    const long double a2 = alpha(angle + h / 2 * s1), s2 = spin + h / 2 * a1;
    const long double a3 = alpha(angle + h / 2 * s2), s3 = spin + h / 2 * a2;
    const long double a4 = alpha(angle + h * s3), s4 = spin + h * a3;
    angle += h / 6 * (s1 + 2 * s2 + 2 * s3 + s4);
    spin += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  for (const double dt : {0.01, 0.005, 0.0025}) {
    const std::unique_ptr<Demo> demo = room();
    demo->set("dt", dt);
    const BodyId box = box_at(*demo, kSquare);
    click(*demo, kSquare + Vec2d{0.49, 0.49});
    steps(*demo, static_cast<int>(std::lround(kPush / dt)));
    const double error = dt / 2 * static_cast<double>(alpha(0) - alpha(angle));
    EXPECT_NEAR(demo->world()->angular_velocity(box) - static_cast<double>(spin), error, 0.2 * error);
  }
}

// With the same torque a box turns by the inverse of its inertia: a thin one of 2 m by 0.25 m, which has
// twice the inertia of a square one of the same mass, half as fast.
TEST(SpinningBoxes, InertiaResistsTorque) {
  const std::unique_ptr<Demo> demo = room();
  const BodyId square = box_at(*demo, kSquare), thin = box_at(*demo, kThin);
  EXPECT_NEAR(demo->world()->inertia(square), 1 / 6.0, kFloat);
  EXPECT_NEAR(demo->world()->inertia(thin), (4 + 0.0625) / 12, kFloat);
  EXPECT_NEAR(demo->world()->mass(square), 1, kFloat);
  EXPECT_NEAR(demo->world()->mass(thin), 1, kFloat);
  click(*demo, kSquare + Vec2d{0.49, 0.49});  // a lever of 0.5 m
  click(*demo, kThin + Vec2d{0.99, 0.1});     // of 1 m
  demo->step_once();
  const double square_turn = demo->world()->angular_velocity(square) / 0.5;
  const double thin_turn = demo->world()->angular_velocity(thin) / 1.0;
  EXPECT_NEAR(square_turn / thin_turn, (4.0625 / 12) / (1 / 6.0), 8 * kFloat);
}

// Of one mass and as long as a square, a thin box is easier to spin: (1 + 1/16) / 2 of the inertia. The same
// push at the same lever turns it faster by the inverse.
TEST(SpinningBoxes, AThinBoxAsLongAsASquareIsEasierToSpin) {
  const std::unique_ptr<Demo> demo = room();
  const Vec2d short_thin{4.9, 0};
  const BodyId square = box_at(*demo, kSquare), thin = box_at(*demo, short_thin);
  EXPECT_NEAR(demo->world()->mass(thin), 1, kFloat);
  EXPECT_NEAR(demo->world()->inertia(thin), 1.0625 / 12, kFloat);
  click(*demo, kSquare + Vec2d{0.49, 0.49});
  click(*demo, short_thin + Vec2d{0.49, 0.1});
  demo->step_once();
  const double ratio = demo->world()->angular_velocity(thin) / demo->world()->angular_velocity(square);
  EXPECT_NEAR(ratio, 2 / 1.0625, 16 * kFloat);
}

// Off a wall with e, and head-on into a box of the same mass: v1' = (1 - e) / 2 v, v2' = (1 + e) / 2 v.
TEST(SpinningBoxes, BoxesBounce) {
  for (const double e : {0.0, 0.5, 1.0}) {
    for (const char* rotation : {"boxes turn", "along the axes"}) {
      const std::unique_ptr<Demo> demo = room(e);
      demo->set("rotation", rotation);
      demo->set("new boxes", "square");
      click(*demo, {-1, 0});
      const BodyId left = box_at(*demo, kSquare), right = box_at(*demo, {-1, 0});
      pull(*demo, kSquare, kSquare + Vec2d{1, 0});
      const double v = kForce * kPush;
      steps(*demo, 60);  // 1 m to go at 2 m/s, and not as far as the thin box
      EXPECT_NEAR(demo->world()->velocity(left).x, (1 - e) / 2 * v, 1e-6) << e;
      EXPECT_NEAR(demo->world()->velocity(right).x, (1 + e) / 2 * v, 1e-6) << e;
      EXPECT_NEAR(demo->world()->angle(right), 0, 1e-6);

      const std::unique_ptr<Demo> other = room(e);
      other->set("rotation", rotation);
      const BodyId box = box_at(*other, kSquare);
      pull(*other, kSquare, kSquare - Vec2d{1, 0});
      steps(*other, 120);  // 2.5 m to the wall
      EXPECT_NEAR(other->world()->velocity(box).x, e * v, 1e-6) << e;
    }
  }
}

// Boxes along the axes collide off-centre and pushed at corners without a turn, and keep their momentum.
TEST(SpinningBoxes, LockedBoxesNeverTurn) {
  const std::unique_ptr<Demo> demo = room(0.5, 0.5);
  click(*demo, kSquare + Vec2d{0.49, 0.49});
  steps(*demo, 10);
  const BodyId spun = body_called(*demo, "square");
  demo->set("rotation", "along the axes");
  click(*demo, {-1, 0.6});
  const BodyId box = box_at(*demo, {-1, 0.6});
  pull(*demo, Vec2d{-1, 0.6} + Vec2d{-0.45, 0.45}, Vec2d{-4, 0.6});
  pull(*demo, kThin + Vec2d{0.99, 0.1}, kThin + Vec2d{0.99, -2});
  for (int i = 0; i < 300; ++i) {
    demo->step_once();
    for (const BodyId body : demo->world()->bodies()) {
      ASSERT_EQ(demo->world()->angle(body), 0);
      ASSERT_EQ(demo->world()->angular_velocity(body), 0);
    }
  }
  EXPECT_GT(length_squared(demo->world()->velocity(box)), 0);
  demo->set("rotation", "boxes turn");
  click(*demo, demo->world()->position(spun) + Vec2d{0.49, 0.49});
  demo->step_once();
  EXPECT_GT(std::abs(demo->world()->angular_velocity(spun)), 0.1);
}

// Boxes that hit off-centre spin; what they had of momentum and angular momentum stays.
TEST(SpinningBoxes, CollisionsOffCentreSpin) {
  const std::unique_ptr<Demo> demo = room(0.5);
  click(*demo, {-1, 0.6});
  const BodyId left = box_at(*demo, kSquare), right = box_at(*demo, {-1, 0.6});
  pull(*demo, kSquare, kSquare + Vec2d{1, 0});
  const auto angular = [&](BodyId body) {
    return demo->world()->inertia(body) * demo->world()->angular_velocity(body) +
           cross(demo->world()->position(body), demo->world()->velocity(body));
  };
  steps(*demo, 8);
  const double before = angular(left) + angular(right);
  steps(*demo, 50);
  EXPECT_GT(std::abs(demo->world()->angular_velocity(left)), 0.1);
  EXPECT_GT(std::abs(demo->world()->angular_velocity(right)), 0.1);
  const Vec2d momentum = demo->world()->velocity(left) + demo->world()->velocity(right);
  EXPECT_NEAR(momentum.x, kForce * kPush, 1e-6);
  EXPECT_NEAR(momentum.y, 0, 1e-6);
  EXPECT_NEAR(angular(left) + angular(right), before, 1e-6);
}

TEST(SpinningBoxes, ClicksOnFreeRoomMakeBoxes) {
  const std::unique_ptr<Demo> demo = room();
  EXPECT_EQ(figure(*demo, "boxes"), 9);
  demo->key('2');
  click(*demo, {0, 3});
  demo->key('1');
  click(*demo, {0, -3});
  EXPECT_EQ(figure(*demo, "boxes"), 11);
  EXPECT_NEAR(demo->world()->inertia(box_at(*demo, {0, 3})), 4.0625 / 12, kFloat);
  EXPECT_NEAR(demo->world()->inertia(box_at(*demo, {0, -3})), 1 / 6.0, kFloat);
}

}  // namespace
}  // namespace plumb::demos
