#include "engine/world/joint_solver/joint_set.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/world/solver/joint_bench.h"

/// Each kind of joint does what it says: against closed forms.
namespace plumb {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kStep = 1.0 / 60;

/// 4 times the quarter period of a pendulum: 2 pi / (omega agm(1, cos(amplitude / 2))).
double pendulum_period(double omega, double amplitude) {
  double a = 1, g = std::cos(amplitude / 2);
  for (int i = 0; i < 8; ++i) {
    const double mean = 0.5 * (a + g);
    g = std::sqrt(a * g);
    a = mean;
  }
  return 2 * kPi / (omega * a);
}

/// Relative error of the period of a bar that swings on a hinge, over five periods.
double period_error(int substeps) {
  JointBench<double> bench;
  bench.gravity = {0, -10};
  bench.substeps = substeps;
  const double amplitude = 1.0, arm = 0.8, inertia = 0.3;
  const int wall = bench.body({}, 0, 0);
  const int bar =
      bench.body({arm * std::sin(amplitude), -arm * std::cos(amplitude)}, 1, 1 / inertia, amplitude);
  bench.join(RevoluteDefinition{.anchor_b = {0, arm}}, wall, bar);
  const double expected = pendulum_period(std::sqrt(10 * arm / (inertia + arm * arm)), amplitude);
  double time = 0, before = bench.angle[bar], turns = 0;
  while (turns < 5) {
    bench.step(kStep);
    time += kStep;
    const double now = bench.angle[bar];
    if (before > 0 && now <= 0) turns += 1;
    if (turns == 5) time -= kStep * now / (now - before);
    before = now;
  }
  // The first crossing comes after a quarter of a period.
  return std::fabs(time / (4.25 * expected) - 1);
}

TEST(JointSet, HingeSwingsAtThePendulumsPeriod) {
  const double coarse = period_error(4), fine = period_error(16);
  EXPECT_LT(coarse, 4e-3);
  EXPECT_LT(fine, coarse / 3);  // at least first order
}

TEST(JointSet, MotorAcceleratesAtTorqueOverInertiaAndStopsAtItsSpeed) {
  JointBench<double> bench;
  const int wall = bench.body({}, 0, 0), wheel = bench.body({}, 0.5, 1 / 0.4);
  const int joint = bench.join(RevoluteDefinition{.motor = Motor{10, 3}}, wall, wheel);
  bench.run(1.0, kStep);
  EXPECT_NEAR(bench.motion[wheel].angular_velocity, 3 / 0.4, 1e-12);
  EXPECT_NEAR(bench.joints.torque(joint), 3, 1e-9);
  bench.run(1.0, kStep);
  EXPECT_NEAR(bench.motion[wheel].angular_velocity, 10, 1e-12);
  EXPECT_NEAR(bench.joints.torque(joint), 0, 1e-9);
}

TEST(JointSet, LimitsOvershootLessThanTwoDegrees) {
  for (const double speed : {5.0, 20.0}) {
    JointBench<float> bench;
    bench.gravity = {0, -10};
    const int wall = bench.body({}, 0, 0), bar = bench.body({0, -1}, 0.1, 0.12);
    const int joint =
        bench.join(RevoluteDefinition{.anchor_b = {0, 1}, .limits = Range{-0.5, 1.0}}, wall, bar);
    bench.motion[bar].angular_velocity = static_cast<float>(speed);
    bench.motion[bar].velocity = {static_cast<float>(speed), 0};
    float highest = 0, lowest = 0;
    for (int i = 0; i < 300; ++i) {
      bench.step(kStep);
      const float angle = bench.joints.angle(joint, bench.bodies());
      highest = std::max(highest, angle);
      lowest = std::min(lowest, angle);
    }
    EXPECT_GT(highest, 0.98);  // it got there
    EXPECT_LT(highest, 1.0 + 2 * kPi / 180);
    EXPECT_GT(lowest, -0.5 - 2 * kPi / 180);
  }
}

/// Displacement of a damped oscillator that starts at rest at 1.
double oscillator(double hertz, double zeta, double t) {
  const double omega = 2 * kPi * hertz, damped = omega * std::sqrt(1 - zeta * zeta);
  return std::exp(-zeta * omega * t) * (std::cos(damped * t) + zeta * omega / damped * std::sin(damped * t));
}

enum class SpringOf { Distance, Revolute, Prismatic, Wheel, WeldPoint, WeldAngle, Motor, Mouse };

/// Largest deviation from the closed form over a second and a half, relative to the first displacement.
double spring_error(SpringOf kind, int substeps) {
  constexpr double kHertz = 1.5, kZeta = 0.2, kSize = 0.05;
  const Spring spring{kHertz, kZeta};
  JointBench<double> bench;
  bench.substeps = substeps;
  const int wall = bench.body({1, 2}, 0, 0);
  const bool angular = kind == SpringOf::Revolute || kind == SpringOf::WeldAngle;
  const int body = bench.body({angular ? 1 : 2 + kSize, 2}, 0.5, 2, angular ? kSize : 0);
  const auto definition = [&]() -> JointKind {
    switch (kind) {
      case SpringOf::Distance:
        return DistanceDefinition{.length = 1, .spring = spring};
      case SpringOf::Revolute:
        return RevoluteDefinition{.spring = spring};
      case SpringOf::Prismatic:
        return PrismaticDefinition{.spring = spring, .target_translation = 1};
      case SpringOf::Wheel:
        return WheelDefinition{.anchor_a = {1, 0}, .axis = {1, 0}, .spring = spring};
      case SpringOf::WeldPoint:
        return WeldDefinition{.anchor_a = {1, 0}, .linear_spring = spring};
      case SpringOf::WeldAngle:
        return WeldDefinition{.angular_spring = spring};
      case SpringOf::Motor:
        return MotorDefinition{
            .target_position = {1, 0}, .max_force = 1e6, .max_torque = 1e6, .spring = spring};
      default:
        return MouseDefinition{.target = {2, 2}, .spring = spring, .max_force = 1e6};
    }
  };
  bench.join(definition(), wall, body);
  double worst = 0;
  for (int i = 1; i <= 90; ++i) {
    bench.step(kStep);
    const double now = angular ? bench.angle[body] : bench.position[body].x - 2;
    worst = std::max(worst, std::fabs(now / kSize - oscillator(kHertz, kZeta, i * kStep)));
  }
  return worst;
}

TEST(JointSet, SpringsSwingAsTheDampedOscillatorOfTheirHertzAndRatio) {
  for (int kind = 0; kind <= static_cast<int>(SpringOf::Mouse); ++kind) {
    const double coarse = spring_error(static_cast<SpringOf>(kind), 4);
    const double fine = spring_error(static_cast<SpringOf>(kind), 32);
    // Implicit Euler damps by h omega / 2 = 0.02 in the ratio: about a tenth of the displacement at most.
    EXPECT_LT(coarse, 0.1) << kind;
    EXPECT_NEAR(coarse / fine, 8, 1) << kind;  // first order in h
  }
}

TEST(JointSet, PrismaticSlidesDownItsAxisAndNowhereElse) {
  JointBench<float> bench;
  bench.gravity = {0, -10};
  const int wall = bench.body({}, 0, 0, 0.3), box = bench.body({}, 0.25, 3, 0.3);
  const int joint = bench.join(PrismaticDefinition{.axis = {2, 0}}, wall, box);
  bench.angular_acceleration[box] = 5;  // a torque that tries to turn it
  bench.run(1, kStep);
  // Semi-implicit Euler: a t^2 / 2 (1 + 1 / steps).
  const double expected = -10 * std::sin(0.3) * 0.5 * (1 + 1.0 / 240);
  EXPECT_NEAR(bench.joints.translation(joint, bench.bodies()), expected, 1e-4);
  const JointError<float> error = bench.joints.error(joint, bench.bodies());
  EXPECT_LT(error.linear, 2e-4);
  EXPECT_LT(error.angular, 2e-4);
  EXPECT_NEAR(bench.position[box].y, std::tan(0.3) * bench.position[box].x, 1e-4);
}

TEST(JointSet, PrismaticMotorAndLimits) {
  JointBench<double> bench;
  const int wall = bench.body({}, 0, 0), box = bench.body({}, 0.5, 1);
  const int joint =
      bench.join(PrismaticDefinition{.limits = Range{-1, 0.5}, .motor = Motor{2, 6}}, wall, box);
  bench.run(0.25, kStep);
  EXPECT_NEAR(bench.motion[box].velocity.x, 6 * 0.5 * 0.25, 1e-12);
  bench.run(2, kStep);
  EXPECT_NEAR(bench.joints.translation(joint, bench.bodies()), 0.5, 2e-3);  // the limit holds the motor
  bench.joints.change(joint, PrismaticDefinition{.limits = Range{-1, 0.5}, .motor = Motor{-2, 6}});
  bench.run(3, kStep);
  EXPECT_NEAR(bench.joints.translation(joint, bench.bodies()), -1, 2e-3);
}

TEST(JointSet, WeldHoldsACantileverAndTellsItsLoad) {
  JointBench<float> bench;
  bench.gravity = {0, -10};
  const int wall = bench.body({}, 0, 0), beam = bench.body({1.5, 0}, 0.5, 0.3);
  const int joint = bench.join(WeldDefinition{.anchor_b = {-1.5, 0}}, wall, beam);
  bench.run(2, kStep);
  EXPECT_NEAR(bench.joints.force(joint), 20, 0.02);   // m g
  EXPECT_NEAR(bench.joints.torque(joint), 30, 0.03);  // m g l
  EXPECT_LT(bench.joints.error(joint, bench.bodies()).linear, 1e-3);
  EXPECT_LT(bench.joints.error(joint, bench.bodies()).angular, 1e-3);
}

TEST(JointSet, WheelRestsOnItsSpringAndTurnsByItsMotor) {
  JointBench<double> bench;
  bench.gravity = {0, -10};
  // The chassis is fixed: the wheel hangs on the suspension, which it stretches by g / omega^2.
  const int chassis = bench.body({}, 0, 0), wheel = bench.body({0, -1}, 0.2, 1);
  const int joint = bench.join(
      WheelDefinition{.anchor_a = {0, -1}, .spring = Spring{2, 0.7}, .motor = Motor{8, 4}}, chassis, wheel);
  bench.run(1, kStep);
  EXPECT_NEAR(bench.motion[wheel].angular_velocity, 4, 1e-12);
  bench.run(4, kStep);
  EXPECT_NEAR(bench.motion[wheel].angular_velocity, 8, 1e-12);
  const double omega = 2 * kPi * 2;
  EXPECT_NEAR(bench.joints.translation(joint, bench.bodies()), -10 / (omega * omega), 1e-6);
  EXPECT_LT(bench.joints.error(joint, bench.bodies()).linear, 1e-12);
  EXPECT_GT(bench.joints.angle(joint, bench.bodies()), 8);  // turns are counted
}

TEST(JointSet, RopeIsFreeInsideItsRangeAndHoldsAtItsEnds) {
  JointBench<double> bench;
  const int wall = bench.body({}, 0, 0), bob = bench.body({1.5, 0}, 1, 1);
  const int joint = bench.join(DistanceDefinition{.range = Range{1, 2}}, wall, bob);
  bench.motion[bob].velocity = {1, 0};
  bench.run(0.4, kStep);
  EXPECT_EQ(bench.motion[bob].velocity.x, 1);  // not touched
  EXPECT_EQ(bench.joints.force(joint), 0);
  bench.run(1, kStep);
  EXPECT_NEAR(bench.joints.length(joint, bench.bodies()), 2, 1e-6);
  bench.motion[bob].velocity = {-3, 0};
  bench.run(1, kStep);
  EXPECT_NEAR(bench.joints.length(joint, bench.bodies()), 1, 1e-6);
}

TEST(JointSet, RodCarriesTheCentripetalForce) {
  JointBench<double> bench;
  const int wall = bench.body({}, 0, 0), bob = bench.body({2, 0}, 0.5, 1);
  const int joint = bench.join(DistanceDefinition{.length = 2}, wall, bob);
  bench.motion[bob].velocity = {0, 3};
  bench.run(2, kStep);
  EXPECT_NEAR(bench.joints.length(joint, bench.bodies()), 2, 1e-3);
  // m v^2 / r, after two seconds: relaxing at the new pose takes out no motion along the arc.
  EXPECT_NEAR(bench.joints.force(joint), 2 * 9 / 2.0, 0.01);
}

TEST(JointSet, DistanceMotorPaysOutAtItsSpeed) {
  JointBench<double> bench;
  const int wall = bench.body({}, 0, 0), bob = bench.body({1, 0}, 0.5, 1);
  const int joint = bench.join(DistanceDefinition{.range = Range{0, 3}, .motor = Motor{0.5, 10}}, wall, bob);
  bench.run(1, kStep);
  EXPECT_NEAR(bench.motion[bob].velocity.x, 0.5, 1e-12);
  EXPECT_NEAR(bench.joints.length(joint, bench.bodies()), 1 + 0.5 - 0.5 * 0.5 * 0.1, 2e-3);
}

TEST(JointSet, GearsTurnInTheirRatio) {
  JointBench<float> bench;
  const int wall = bench.body({}, 0, 0), small = bench.body({}, 1, 4),
            large = bench.body({3, 0}, 1, 0.5, 0.4);
  bench.join(RevoluteDefinition{.motor = Motor{12, 50}}, wall, small);
  bench.join(RevoluteDefinition{.anchor_a = {3, 0}}, wall, large);
  const int gear = bench.join(GearDefinition{.ratio = -0.25, .phase = 0.4}, small, large);
  bench.run(5, kStep);
  EXPECT_GT(bench.angle[small], 50);  // eight turns and more
  EXPECT_NEAR(bench.angle[large], -0.25 * bench.angle[small] + 0.4, 1e-3);
  EXPECT_NEAR(bench.motion[large].angular_velocity, -0.25 * 12, 1e-3);
  EXPECT_LT(bench.joints.error(gear, bench.bodies()).angular, 1e-3);
}

TEST(JointSet, PulleyIsAtwoodsMachine) {
  JointBench<double> bench;
  bench.gravity = {0, -10};
  const double m_a = 3, m_b = 1, ratio = 2;
  const int a = bench.body({-1, -2}, 1 / m_a, 1), b = bench.body({1, -3}, 1 / m_b, 1);
  const int joint =
      bench.join(PulleyDefinition{.ground_a = {-1, 0}, .ground_b = {1, 0}, .ratio = ratio}, a, b);
  bench.run(0.5, kStep);
  // A substep's fall, g h^2, comes before the rope has tightened.
  EXPECT_NEAR(bench.joints.length(joint, bench.bodies()), 2 + ratio * 3, 5e-4);
  // m_a a = -m_a g + T; m_b b = -m_b g + ratio T; a + ratio b = 0.
  const double tension = 10 * (1 + ratio) / (1 / m_a + ratio * ratio / m_b);
  EXPECT_NEAR(bench.motion[a].velocity.y, 0.5 * (-10 + tension / m_a), 1e-9);
  EXPECT_NEAR(bench.motion[b].velocity.y, 0.5 * (-10 + ratio * tension / m_b), 1e-9);
  EXPECT_NEAR(bench.joints.force(joint), ratio * tension, 1e-6);
}

TEST(JointSet, RatchetTurnsOneWayAndClicks) {
  for (const float way : {1.0f, -1.0f}) {  // of a tooth's sign
    JointBench<float> bench;
    const int wall = bench.body({}, 0, 0), wheel = bench.body({}, 1, 2);
    bench.join(RevoluteDefinition{}, wall, wheel);
    const int joint = bench.join(RatchetDefinition{.tooth = 0.25 * way}, wall, wheel);
    bench.angular_acceleration[wheel] = -2 * way;  // held at once: it starts on a tooth
    bench.run(1, kStep);
    EXPECT_NEAR(bench.angle[wheel], 0, 2e-3);
    bench.angular_acceleration[wheel] = 2 * way;
    bench.run(1, kStep);
    const double reached = way * bench.angle[wheel];
    EXPECT_GT(reached, 0.9);  // free
    bench.motion[wheel].angular_velocity = 0;
    bench.angular_acceleration[wheel] = -2 * way;
    bench.run(2, kStep);
    EXPECT_NEAR(way * bench.angle[wheel], std::floor(reached / 0.25) * 0.25, 2e-3);
    EXPECT_NEAR(bench.joints.torque(joint), 1, 1e-2);  // holds I alpha
  }
}

TEST(JointSet, FrictionDeceleratesAtForceOverMassAndThenHolds) {
  JointBench<double> bench;
  const int floor = bench.body({}, 0, 0), box = bench.body({}, 0.5, 2);
  const int joint = bench.join(FrictionDefinition{.max_force = 3, .max_torque = 0.5}, floor, box);
  bench.motion[box].velocity = {3, 4};
  bench.motion[box].angular_velocity = 2;
  bench.run(1, kStep);
  EXPECT_NEAR(std::hypot(bench.motion[box].velocity.x, bench.motion[box].velocity.y), 5 - 1.5, 1e-9);
  EXPECT_NEAR(bench.motion[box].velocity.y / bench.motion[box].velocity.x, 4.0 / 3, 1e-9);
  EXPECT_NEAR(bench.motion[box].angular_velocity, 2 - 1, 1e-9);
  EXPECT_NEAR(bench.joints.force(joint), 3, 1e-9);
  bench.run(4, kStep);
  EXPECT_NEAR(bench.motion[box].velocity.x, 0, 1e-12);
  EXPECT_NEAR(bench.motion[box].angular_velocity, 0, 1e-12);
}

TEST(JointSet, MousePullsWithNoMoreThanItsForce) {
  JointBench<float> bench;
  const int ground = bench.body({}, 0, 0), box = bench.body({}, 0.5, 1);
  const int joint = bench.join(MouseDefinition{.target = {100, 0}, .max_force = 8}, ground, box);
  bench.run(0.5, kStep);
  EXPECT_NEAR(bench.motion[box].velocity.x, 0.5 * 8 * 0.5, 1e-4);
  EXPECT_NEAR(bench.joints.force(joint), 8, 1e-3);
  bench.joints.change(joint, MouseDefinition{.target = {2, 1}, .max_force = 1000});
  bench.run(3, kStep);
  EXPECT_NEAR(bench.position[box].x, 2, 1e-4);
  EXPECT_NEAR(bench.position[box].y, 1, 1e-4);
  EXPECT_EQ(length_squared(bench.motion[ground].velocity), 0);
}

TEST(JointSet, MotorJointFollowsItsTargetWithBoundedForce) {
  JointBench<float> bench;
  const int base = bench.body({1, 1}, 0, 0, 0.5), box = bench.body({}, 0.5, 1);
  const MotorDefinition far{.target_position = {50, 0}, .target_angle = 1, .max_force = 4, .max_torque = 0.1};
  const int joint = bench.join(far, base, box);
  bench.run(0.5, kStep);
  EXPECT_NEAR(std::hypot(bench.motion[box].velocity.x, bench.motion[box].velocity.y), 0.5 * 4 * 0.5, 1e-3);
  EXPECT_NEAR(bench.motion[box].angular_velocity, 0.05, 1e-5);
  bench.joints.change(
      joint,
      MotorDefinition{.target_position = {2, 0}, .target_angle = 1, .max_force = 1e4, .max_torque = 1e4});
  bench.run(3, kStep);
  EXPECT_NEAR(bench.position[box].x, 1 + 2 * std::cos(0.5), 1e-4);
  EXPECT_NEAR(bench.position[box].y, 1 + 2 * std::sin(0.5), 1e-4);
  EXPECT_NEAR(bench.angle[box], 1.5, 1e-4);
}

}  // namespace
}  // namespace plumb
