#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "engine/scene/error.h"
#include "engine/world/force_laws.h"
#include "tests/world/allocations.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDt = 1.0 / 60;

template <class Real>
class ForceLaws : public testing::Test {
 public:
  using World = BasicWorld<Real>;
  static constexpr bool kSingle = std::is_same_v<Real, float>;
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ForceLaws, Reals);

// A disc of mass 2 kg, and one that touches nothing.
const ShapeDefinition kDisc{.geometry = Circle{0.5}, .density = 2 / (kPi * 0.25)};
const ShapeDefinition kGhost{.geometry = Circle{0.5}, .density = 2 / (kPi * 0.25), .filter = {.mask = 0}};

TYPED_TEST(ForceLaws, ACircularOrbitTakesKeplersPeriod) {
  typename TestFixture::World world(weightless());
  const double radius = 10, strength = 50, h = 0.1;
  // A force at the middle of the step leads round a circle by theta a step, tan(theta/2) = v h / 2 r, when
  // v^2 = strength / sqrt(r^2 + (v h / 2)^2): the kick turns the velocity and keeps its size.
  double speed = std::sqrt(strength / radius);
  for (int i = 0; i < 40; ++i) speed = std::sqrt(strength / std::hypot(radius, 0.5 * speed * h));
  const double theta = 2 * std::atan2(0.5 * speed * h, radius);
  // To second order that is 1 - 7/48 (omega h)^2 of what Kepler's law demands.
  const double kepler = h * std::sqrt(strength / (radius * radius * radius));
  ASSERT_NEAR(theta / kepler, 1 - 7.0 / 48 * kepler * kepler, kepler * kepler * kepler * kepler);

  const BodyId body = add_body(world, {radius, 0}, kDisc, {0, speed});
  for (int i = 1; i <= 600; ++i) {
    apply_attraction(world, {0, 0}, {.strength = strength}, h);
    world.step(h);
    ASSERT_NEAR(world.centre(body).x, radius * std::cos(i * theta), TestFixture::kSingle ? 1e-3 : 1e-11);
    ASSERT_NEAR(world.centre(body).y, radius * std::sin(i * theta), TestFixture::kSingle ? 1e-3 : 1e-11);
  }
}

TYPED_TEST(ForceLaws, LinearAttractionIsHarmonicWithOnePeriodForAll) {
  typename TestFixture::World world(weightless());
  const BodyId near = add_body(world, {2, 0}, kGhost), far = add_body(world, {0, 7}, kGhost);
  const double omega = 2, theta = std::acos(1 - 0.5 * omega * omega * kDt * kDt);
  for (int i = 1; i <= 300; ++i) {
    apply_attraction(world, {0, 0}, {.strength = omega * omega, .falloff = Attraction::Falloff::Linear}, kDt);
    world.step(kDt);
    const double tolerance = TestFixture::kSingle ? 2e-4 : 1e-11;
    ASSERT_NEAR(world.centre(near).x, 2 * std::cos(i * theta), tolerance);
    ASSERT_NEAR(world.centre(far).y, 7 * std::cos(i * theta), tolerance);
  }
}

TYPED_TEST(ForceLaws, AttractionToABodyKeepsMomentum) {
  typename TestFixture::World world(weightless());
  const BodyId sun = add_body(world, {0, 0}, kDisc);
  const BodyId a = add_body(world, {3, 1}, kDisc, {0, 1}), b = add_body(world, {-2, 4}, kDisc, {1, 0});
  for (int i = 0; i < 60; ++i) {
    apply_attraction_to_body(world, sun, {.strength = 5}, kDt);
    world.step(kDt);
  }
  const Vec2d momentum = world.velocity(sun) + world.velocity(a) + world.velocity(b);
  const double tolerance = TestFixture::kSingle ? 3e-6 : 1e-14;
  EXPECT_NEAR(momentum.x, 1, tolerance);
  EXPECT_NEAR(momentum.y, 1, tolerance);
  EXPECT_GT(length_squared(world.velocity(sun)), 0.01);
}

TYPED_TEST(ForceLaws, LinearDragDecaysExponentially) {
  typename TestFixture::World world(weightless());
  const BodyId body = add_body(world, {0, 0}, kDisc, {3, -4});
  world.set_angular_velocity(body, 5);
  for (int i = 0; i < 120; ++i) {
    apply_linear_drag(world, {.linear = 1.5, .angular = 0.2}, kDt);
    world.step(kDt);
  }
  const double left = std::exp(-1.5 / 2 * 2.0), inertia = 0.5 * 2 * 0.25;
  const double tolerance = TestFixture::kSingle ? 2e-6 : 1e-14;
  EXPECT_NEAR(world.velocity(body).x, 3 * left, 3 * tolerance);
  EXPECT_NEAR(world.velocity(body).y, -4 * left, 4 * tolerance);
  EXPECT_NEAR(world.angular_velocity(body), 5 * std::exp(-0.2 / inertia * 2.0), 5 * tolerance);
}

TYPED_TEST(ForceLaws, LinearDragFallsToTheTerminalSpeedAlongTheClosedForm) {
  typename TestFixture::World world;
  const BodyId body = add_body(world, {0, 0}, kDisc);
  const double mass = 2, c = 3, terminal = mass * kGravity / c;
  for (int i = 1; i <= 600; ++i) {
    apply_linear_drag(world, {.linear = c}, kDt);
    world.step(kDt);
    const double exact = -terminal * (1 - std::exp(-c / mass * i * kDt));
    ASSERT_NEAR(world.velocity(body).y, exact, TestFixture::kSingle ? 4e-5 : 2e-14);
  }
}

TYPED_TEST(ForceLaws, QuadraticDragFollowsTheHyperbolicTangent) {
  typename TestFixture::World world;
  const BodyId body = add_body(world, {0, 0}, kDisc);
  const double mass = 2, k = 0.4, terminal = std::sqrt(mass * kGravity / k);
  for (int i = 1; i <= 900; ++i) {
    apply_quadratic_drag(world, k, kDt);
    world.step(kDt);
    // Of second order: x = g dt / terminal = 0.023, and x^2 / 12 is 5e-5 of the terminal speed.
    const double exact = -terminal * std::tanh(kGravity * i * kDt / terminal);
    ASSERT_NEAR(world.velocity(body).y, exact, 5e-5 * terminal);
  }
  EXPECT_NEAR(world.velocity(body).y, -terminal, terminal * (TestFixture::kSingle ? 5e-6 : 1e-9));
}

TYPED_TEST(ForceLaws, NoDragReversesAVelocity) {
  for (const double size : {1e2, 1e4, 1e8}) {
    typename TestFixture::World world(weightless());
    const BodyId slow = add_body(world, {0, 0}, kDisc, {3, 0});
    apply_linear_drag(world, {.linear = size}, kDt);
    world.step(kDt);
    EXPECT_GE(world.velocity(slow).x, -3e-7) << size;
    EXPECT_LT(world.velocity(slow).x, 2);

    typename TestFixture::World other(weightless());
    const BodyId body = add_body(other, {0, 0}, kDisc, {3, 0});
    apply_quadratic_drag(other, size, kDt);
    other.step(kDt);
    EXPECT_GE(other.velocity(body).x, -3e-7) << size;

    typename TestFixture::World windy(weightless());
    const BodyId feather = add_body(windy, {0, 0}, kDisc, {3, 0});
    apply_wind(windy, {.density = size}, kDt);
    windy.step(kDt);
    EXPECT_GE(windy.velocity(feather).x, -3e-7) << size;

    typename TestFixture::World wet(weightless());
    const BodyId diver = add_body(wet, {0, -9}, kDisc, {3, 0});
    apply_water(wet, {.velocity = {1, 0}, .linear_drag = size}, kDt);
    wet.step(kDt);
    EXPECT_GE(wet.velocity(diver).x, 1 - 3e-7) << size;
  }
}

TYPED_TEST(ForceLaws, WindOnAPlateIsTheDynamicPressureTimesItsArea) {
  typename TestFixture::World world(weightless());
  const BodyId plate = add_box(world, {0, 0}, 10, 0.2, 3);
  const BodyId disc = add_body(world, {20, 0}, kDisc);
  const double speed = 7, density = 1.3;
  apply_wind(world, {.velocity = {speed, 0}, .density = density}, kDt);
  world.step(kDt);
  const double tolerance = TestFixture::kSingle ? 1e-6 : 1e-14;
  const double pressure = 0.5 * density * speed * speed;
  EXPECT_NEAR(world.velocity(plate).x, pressure * 3 * kDt / 6, tolerance);
  EXPECT_NEAR(world.velocity(plate).y, 0, tolerance);
  EXPECT_NEAR(world.angular_velocity(plate), 0, tolerance);
  // The integral of cos^3 over a half circle of radius 1/2 is 2/3 of its width.
  EXPECT_NEAR(world.velocity(disc).x, pressure * (2.0 / 3) * kDt / 2, tolerance);
}

TYPED_TEST(ForceLaws, ASpringSwingsTwoBodiesWithTheirReducedMass) {
  typename TestFixture::World world(weightless());
  const BodyId a = add_body(world, {0, 0}, kDisc), b = add_body(world, {3, 0}, kDisc);
  // Two masses of 2 kg: omega^2 = k / 1 kg. The implicit midpoint rule, which the method is along a line,
  // advances the phase by theta a step: tan(theta / 2) = omega dt / 2.
  const double omega = 5, theta = 2 * std::atan(0.5 * omega * kDt);
  for (int i = 1; i <= 300; ++i) {
    apply_spring(world, a, {0, 0}, b, {0, 0}, {.stiffness = omega * omega, .rest_length = 2.5}, kDt);
    world.step(kDt);
    const double length = world.centre(b).x - world.centre(a).x;
    ASSERT_NEAR(length, 2.5 + 0.5 * std::cos(i * theta), TestFixture::kSingle ? 2e-5 : 1e-12);
    ASSERT_NEAR(world.velocity(a).x, -world.velocity(b).x, TestFixture::kSingle ? 1e-6 : 1e-13);
  }
}

TYPED_TEST(ForceLaws, ADampedSpringRestsAtItsHangingLengthHoweverStiff) {
  for (const double stiffness : {50.0, 5e3, 1e9}) {
    typename TestFixture::World world(without_sleep());
    const BodyId roof = world.create_body({.type = BodyType::Static, .position = {0, 5}});
    const BodyId body = add_body(world, {0, 3}, kDisc);
    for (int i = 0; i < 1500; ++i) {
      apply_spring(world, roof, {0, 0}, body, {0, 0},
                   {.stiffness = stiffness, .damping = 8, .rest_length = 1}, kDt);
      world.step(kDt);
    }
    // Stiffness beyond m / dt^2 counts as that.
    const double counts = std::min(stiffness, 2 / (kDt * kDt));
    EXPECT_NEAR(world.centre(body).y, 4 - 2 * kGravity / counts, TestFixture::kSingle ? 4e-6 : 1e-10);
  }
}

TYPED_TEST(ForceLaws, AnExplosionAmongEqualDiscsKeepsMomentumZero) {
  typename TestFixture::World world(weightless());
  std::vector<BodyId> ring;
  const double radius = 3;
  for (int i = 0; i < 7; ++i) {
    const double angle = 2 * kPi * i / 7;
    ring.push_back(add_body(world, {1 + radius * std::cos(angle), 2 + radius * std::sin(angle)}, kDisc));
  }
  const BodyId far = add_body(world, {20, 0}, kDisc);
  explode(world, Blast{.centre = {1, 2}, .radius = 8, .impulse = 40});
  // A ray at an angle a from that to a disc's middle meets it at d = 3 cos a - sqrt(0.25 - 9 sin^2 a), and
  // pushes by 40 (1 - d/8) d da, of which cos a is along; on 2 kg. With s = sin a, and s = sin t / 6 for the
  // root:
  double exact = 0;
  constexpr int kRays = 2000;
  for (int i = 0; i < kRays; ++i) {
    const double t = ((i + 0.5) / kRays - 0.5) * kPi, s = std::sin(t) / 6;
    const double d = 3 * std::sqrt(1 - s * s) - 0.5 * std::cos(t);
    exact += 40 * (1 - d / 8) * d * std::cos(t) / 6 * kPi / kRays / 2;
  }
  const double speed = std::sqrt(length_squared(world.velocity(ring[0])));
  EXPECT_NEAR(speed, exact, 2e-3 * exact);  // eight pieces, by the rule of middles
  const double tolerance = TestFixture::kSingle ? 4e-6 : 1e-13;
  Vec2d momentum{};
  for (const BodyId body : ring) {
    EXPECT_NEAR(std::sqrt(length_squared(world.velocity(body))), speed, tolerance);
    EXPECT_NEAR(cross(world.centre(body) - Vec2d{1, 2}, world.velocity(body)), 0, 4 * tolerance);
    EXPECT_NEAR(world.angular_velocity(body), 0, tolerance);
    momentum += world.velocity(body);
  }
  EXPECT_NEAR(momentum.x, 0, 7 * tolerance);
  EXPECT_NEAR(momentum.y, 0, 7 * tolerance);
  EXPECT_EQ(world.velocity(far), Vec2d{});
}

TYPED_TEST(ForceLaws, AnExplosionPushesAWallByItsIntegralAndSparesWhatItCovers) {
  typename TestFixture::World world(weightless());
  const BodyId wall = add_box(world, {2, 0}, 1, 0.5, 4), behind = add_body(world, {5, 0}, kDisc);
  world.set_awake(behind, false);
  typename TestFixture::World open(weightless());
  add_box(open, {2, 0}, 1, 0.5, 4);
  const BodyId seen = add_body(open, {5, 0}, kDisc);
  const Blast blast{.centre = {0, 0}, .radius = 20, .impulse = 10};
  explode(world, blast, {.occlusion = true});
  explode(open, blast);
  EXPECT_EQ(world.velocity(behind), Vec2d{});
  EXPECT_FALSE(world.awake(behind));
  EXPECT_GT(open.velocity(seen).x, 1);
  // Along x the face x = a from y = -2 to 2 gets the integral of I (1 - d/R) (a/d) (a/d) dy, d^2 = a^2 + y^2:
  // a/d for the width across the ray, a/d for the ray's x part.
  const double a = 1.75;
  const double exact = 10 * (a * 2 * std::atan(2 / a) - a * a / 20 * 2 * std::asinh(2 / a));
  // Eight pieces, by the rule of middles.
  EXPECT_NEAR(world.velocity(wall).x * 2, exact, 2e-3 * exact);
  EXPECT_NEAR(world.velocity(wall).y, 0, 1e-5);
}

TYPED_TEST(ForceLaws, ASpringNeedsTwoBodies) {
  typename TestFixture::World world(weightless());
  const BodyId body = add_body(world, {0, 0}, kDisc);
  EXPECT_THROW(apply_spring(world, body, {0, 0}, body, {1, 0}, {}, kDt), Error);
}

TYPED_TEST(ForceLaws, AttractionIsSoftenedLikeABallOfEvenDensity) {
  typename TestFixture::World world(weightless());
  const BodyId body = add_body(world, {0.05, 0}, kDisc);
  apply_attraction(world, {0, 0}, {.strength = 2, .softening = 0.5}, kDt);
  world.step(kDt);
  EXPECT_NEAR(world.velocity(body).x, -2 * 0.05 / 0.125 * kDt, TestFixture::kSingle ? 2e-9 : 1e-16);
}

// Drag of a coefficient c solves its equation together with the forces that were added before it:
// v = F / c (1 - e^(-c t / m)), and the same for the spin under a torque, in steps in which most of it
// happens.
TYPED_TEST(ForceLaws, LinearDragKnowsTheForcesAddedBefore) {
  typename TestFixture::World world(weightless());
  const BodyId body = add_body(world, {0, 0}, kDisc);
  constexpr double kLinear = 50, kAngular = 5;
  for (int i = 1; i <= 10; ++i) {
    world.apply_force(body, {6, 0});
    world.apply_torque(body, 2);
    apply_linear_drag(world, {.linear = kLinear, .angular = kAngular}, kDt);
    world.step(kDt);
    const double speed = 6 / kLinear * (1 - std::exp(-kLinear * i * kDt / world.mass(body))),
                 spin = 2 / kAngular * (1 - std::exp(-kAngular * i * kDt / world.inertia(body)));
    EXPECT_NEAR(world.velocity(body).x, speed, TestFixture::kSingle ? 1e-6 : 1e-13);
    EXPECT_NEAR(world.angular_velocity(body), spin, TestFixture::kSingle ? 1e-6 : 1e-13);
  }
}

TYPED_TEST(ForceLaws, DragLeavesTheWeightOfWhatRests) {
  typename TestFixture::World world(without_sleep());
  add_ground(world);
  const BodyId box = add_box(world, {0, 0.5}, 4);
  for (int i = 0; i < 120; ++i) {
    apply_linear_drag(world, {.linear = 500}, kDt);
    world.step(kDt);
  }
  double impulse = 0;
  for (const ContactReading& contact : world.contacts(box)) {
    for (int i = 0; i < contact.count; ++i) impulse += contact.impulses[i];
  }
  // A quarter of a step.
  EXPECT_NEAR(impulse, 4 * kGravity * kDt / 4, 1e-5 * 4 * kGravity * kDt);
}

TYPED_TEST(ForceLaws, ASpringOffTheCentreTurnsBodiesAndKeepsAngularMomentum) {
  typename TestFixture::World world(weightless());
  const BodyId a = add_box(world, {0, 0}, 1, 2, 0.5), b = add_box(world, {0, 3}, 2, 1, 0.5);
  // So stiff that it counts as 1 / (w dt^2), with w the largest mobility of its ends.
  apply_spring(world, a, {1, 0}, b, {-0.5, 0}, {.stiffness = 1e9, .rest_length = 3}, kDt);
  const Vec2d end_a = world.world_point(a, {1, 0}), end_b = world.world_point(b, {-0.5, 0});
  double mobility = 0;
  for (const auto& [body, end] : {std::pair{a, end_a}, std::pair{b, end_b}})
    mobility += 1 / world.mass(body) + length_squared(end - world.centre(body)) / world.inertia(body);
  const auto elastic = [&](Vec2d line) {
    const double stretch = length(line) - 3;
    return 0.5 * stretch * stretch / (mobility * kDt * kDt);
  };
  world.step(kDt);
  EXPECT_GT(std::abs(world.angular_velocity(b)), 1);
  // Energy is exact. For that the levers are those of the middle times sin(x) / x, not cos(x), where
  // 2 x is the rotation in the step. Angular momentum differs by x^2 / 3 of what the levers take.
  double momentum = 0, levers = 0,
         energy = elastic(world.world_point(b, {-0.5, 0}) - world.world_point(a, {1, 0}));
  for (const BodyId body : {a, b}) {
    const double mass = world.mass(body), inertia = world.inertia(body), spin = world.angular_velocity(body);
    momentum += mass * cross(world.centre(body), world.velocity(body)) + inertia * spin;
    energy += 0.5 * mass * length_squared(world.velocity(body)) + 0.5 * inertia * spin * spin;
    levers += inertia * std::abs(spin) * (spin * kDt) * (spin * kDt) / 12;
  }
  const double before = elastic(end_b - end_a);
  EXPECT_NEAR(energy, before, (TestFixture::kSingle ? 1e-5 : 1e-12) * before);
  EXPECT_NEAR(momentum, 0, levers + (TestFixture::kSingle ? 1e-4 : 1e-12));
}

TYPED_TEST(ForceLaws, ARubberBandIsSlackBelowItsRestLength) {
  typename TestFixture::World world(weightless());
  const BodyId a = add_body(world, {0, 0}, kDisc), b = add_body(world, {3, 0}, kDisc, {1, 0});
  apply_spring(world, a, {0, 0}, b, {0, 0},
               {.stiffness = 1, .damping = 50, .rest_length = 4, .pulls_only = true}, kDt);
  world.step(kDt);
  EXPECT_EQ(world.velocity(a), Vec2d{});
  apply_spring(world, a, {0, 0}, b, {0, 0}, {.rest_length = 2, .pulls_only = true}, kDt);
  world.step(kDt);
  EXPECT_GT(world.velocity(a).x, 0.1);
}

TYPED_TEST(ForceLaws, SpringsLetSleepersLieAndExplosionsWakeThem) {
  typename TestFixture::World world(weightless());
  const BodyId a = add_body(world, {0, 0}, kDisc), b = add_body(world, {3, 0}, kDisc);
  world.set_awake(a, false), world.set_awake(b, false);
  apply_spring(world, a, {0, 0}, b, {0, 0}, {}, kDt);
  EXPECT_FALSE(world.awake(a));
  apply_spring(world, a, {0, 0}, b, {0, 0}, {}, kDt, {.wakes = true});
  EXPECT_TRUE(world.awake(a) && world.awake(b));
  world.set_awake(a, false), world.set_awake(b, false);
  // In the middle of a: it is not pushed.
  explode(world, {.centre = {0.2, 0}, .impulse = 5});
  EXPECT_FALSE(world.awake(a));
  EXPECT_TRUE(world.awake(b));
  EXPECT_EQ(world.velocity(a), Vec2d{});
}

TYPED_TEST(ForceLaws, ALawOfOnesOwnActsOnAwakeBodiesAlone) {
  typename TestFixture::World world(weightless());
  const BodyId awake = add_body(world, {0, 0}, kDisc), asleep = add_body(world, {9, 0}, kDisc);
  world.set_awake(asleep, false);
  const auto law = [](const LawBody& body) -> Wrench<double> {
    return {{body.mass * 3, 0}, body.inertia * 2};
  };
  apply_law(world, law);
  world.step(0.5);
  EXPECT_NEAR(world.velocity(awake).x, 1.5, 1e-6);
  EXPECT_NEAR(world.angular_velocity(awake), 1, 1e-6);
  EXPECT_FALSE(world.awake(asleep));
  apply_law(world, law, {.wakes = true});
  EXPECT_TRUE(world.awake(asleep));
  world.step(0.5);
  EXPECT_NEAR(world.velocity(asleep).x, 1.5, 1e-6);
}

// F = -m w^2 x: the amplitude stays. Evaluated in the middle of steps, the scheme keeps a quadratic form that
// is the energy up to (w dt / 2)^2; a constant force moves the body by a t^2 / 2.
TYPED_TEST(ForceLaws, ALawOfOnesOwnInTheMiddleOfStepsKeepsTheEnergyOfASpring) {
  for (const double rate : {2.0, 5.0, 10.0, 20.0}) {
    typename TestFixture::World world(weightless());
    const BodyId swings = world.create_body({.position = {1, 0}, .angle = 1}, kDisc),
                 thrust = world.create_body({.position = {0, 50}}, kDisc);
    double largest = 0, widest = 0;
    for (int i = 0; i < 600; ++i) {
      apply_law(
          world,
          [&](const LawBody& body) -> Wrench<double> {
            if (body.id == thrust) return {{body.mass * 3, 0}, 0};
            return {{-body.mass * rate * rate * body.centre.x, 0}, -body.inertia * rate * rate * body.angle};
          },
          {.dt = kDt});
      world.step(kDt);
      if (i < 480) continue;
      largest = std::max(largest, std::abs(world.centre(swings).x));
      widest = std::max(widest, std::abs(world.angle(swings)));
    }
    const double bound = 0.5 * rate * rate * kDt * kDt + 1e-3;
    EXPECT_NEAR(largest, 1, bound) << rate;
    EXPECT_NEAR(widest, 1, bound) << rate;
    EXPECT_NEAR(world.centre(thrust).x, 0.5 * 3 * 600 * kDt * 600 * kDt, 1e-3) << rate;
  }
  typename TestFixture::World world(weightless());
  EXPECT_THROW(apply_law(world, [](const LawBody&) { return Wrench<double>{}; }, {.dt = -1}), Error);
}

TYPED_TEST(ForceLaws, ALawOfOnesOwnKnowsTheBody) {
  typename TestFixture::World world(weightless());
  const BodyId body = world.create_body({.position = {1, 2},
                                         .angle = 0.5,
                                         .velocity = {3, 4},
                                         .angular_velocity = -2,
                                         .mass = MassProperties{5, {}, 6},
                                         .user_data = 7},
                                        kDisc);
  int asked = 0;
  apply_law(world, [&](const LawBody& seen) -> Wrench<double> {
    ++asked;
    EXPECT_EQ(seen.id, body);
    EXPECT_EQ(seen.centre, (Vec2d{1, 2}));
    EXPECT_EQ(seen.angle, 0.5);
    EXPECT_EQ(seen.velocity, (Vec2d{3, 4}));
    EXPECT_EQ(seen.angular_velocity, -2);
    EXPECT_EQ(seen.mass, 5);
    EXPECT_EQ(seen.inertia, 6);
    EXPECT_EQ(seen.user_data, 7u);
    return {};
  });
  EXPECT_EQ(asked, 1);
}

TYPED_TEST(ForceLaws, ALawThatFailsNamesTheBodyAndChangesNothing) {
  typename TestFixture::World world(weightless());
  world.set_quarantine(false);
  const BodyId good = add_body(world, {0, 0}, kDisc);
  const BodyId bad = world.create_body({.name = "ball", .position = {5, 0}}, kDisc);
  try {
    apply_law(world, [&](const LawBody& body) -> Wrench<double> {
      return {{1, body.id == bad ? std::numeric_limits<double>::quiet_NaN() : 1}, 0};
    });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
    EXPECT_EQ(error.subject(), "body 'ball'");
  }
  world.step(kDt);
  EXPECT_EQ(world.velocity(good), Vec2d{});
  EXPECT_EQ(world.velocity(bad), Vec2d{});
  EXPECT_THROW(apply_wind(world, {.density = -1}, kDt), Error);
  EXPECT_THROW(apply_attraction(world, {0, 0}, {.softening = 0}, kDt), Error);
  EXPECT_THROW(apply_linear_drag(world, {.linear = 1}, 0), Error);
  world.destroy(bad);
  EXPECT_THROW(apply_attraction_to_body(world, bad, {}, kDt), Error);
  EXPECT_THROW(apply_spring(world, good, {0, 0}, bad, {0, 0}, {}, kDt), Error);
}

TYPED_TEST(ForceLaws, AllocateNothingOnceWarm) {
  typename TestFixture::World world(without_sleep());
  std::vector<BodyId> all;
  for (int i = 0; i < 30; ++i) all.push_back(add_box(world, {2.0 * i, 0}, 0.5, 1, 1 + 0.02 * i));
  const auto laws = [&] {
    apply_water(world, {.density = 1, .linear_drag = 1}, kDt);
    apply_wind(world, {.velocity = {1, 0}}, kDt);
    apply_attraction(world, {5, 0}, {}, kDt);
    apply_spring(world, all[0], {0, 0}, all[1], {0, 0}, {}, kDt);
    apply_quadratic_drag(world, 0.1, kDt);
    apply_linear_drag(world, {0.1, 0.1}, kDt);
    apply_law(world, [](const LawBody&) -> Wrench<double> { return {{0, 0.1}, 0}; });
    explode(world, {.centre = {3, -2}, .impulse = 0.1}, {.occlusion = true});
  };
  laws();
  const long before = test::allocations();
  laws();
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace plumb
