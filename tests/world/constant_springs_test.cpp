#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "engine/scene/error.h"
#include "engine/world/snapshot.h"
#include "tests/world/support.h"

// Springs of joints have a constant stiffness, that of the effective mass at the pose of their creation.
namespace plumb {
namespace {

template <class Real>
class ConstantSprings : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ConstantSprings, Precisions);

constexpr double kPi = std::numbers::pi;
constexpr double kLength = 1, kWidth = 0.1, kMass = 0.1;  // m, m, kg: a bar of 1 kg/m^2
constexpr double kInertia = kMass * (kLength * kLength + kWidth * kWidth) / 12;

double stiffness_for(double mass, double hertz) { return mass * std::pow(2 * kPi * hertz, 2); }

template <class Real>
BodyId add_bar(BasicWorld<Real>& world, Vec2d position, double angle = 0) {
  return world.create_body({.position = position, .angle = angle},
                           ShapeDefinition{.geometry = Box{kLength, kWidth}});
}

template <class Real>
double relative_error() {
  return 32 * static_cast<double>(std::numeric_limits<Real>::epsilon());
}

// A world, its two bodies and a joint between them.
template <class Real>
struct Joined {
  BasicWorld<Real> world{WorldDefinition{.gravity = {0, 0}, .sleeping = false}};
  BodyId a{}, b{};
  JointId joint{};

  // `angle` is that of the bar b, whose left end lies at the origin of the static body a.
  explicit Joined(const JointKind& kind, double angle = 0) {
    a = world.create_body({.type = BodyType::Static});
    b = add_bar(world, {kLength / 2 * std::cos(angle), kLength / 2 * std::sin(angle)}, angle);
    joint = world.create_joint(a, b, {.kind = kind});
  }
};

// Effective masses of a free point of the bar at its end: along it m, across it m / (1 + m r^2 / I).
constexpr double kArm = kLength / 2;
const double kAcross = kMass / (1 + kMass * kArm * kArm / kInertia);

TYPED_TEST(ConstantSprings, AreThoseOfTheEffectiveMassAtTheCreation) {
  using Real = TypeParam;
  const Spring spring{2, 0.25};
  const double about_end = kInertia + kMass * kArm * kArm;
  const Vec2d end{-kArm, 0};
  const struct {
    const char* name;
    JointKind kind;
    double linear, angular;  // effective masses, kg and kg m^2
  } table[] = {
      {"a hinge at the end", RevoluteDefinition{.anchor_b = end, .spring = spring}, 0, about_end},
      {"a hinge at the centre", RevoluteDefinition{.anchor_a = {kArm, 0}, .spring = spring}, 0, kInertia},
      {"a slider", PrismaticDefinition{.anchor_b = end, .axis = {1, 1}, .spring = spring}, kMass, 0},
      {"a coil along the bar", DistanceDefinition{.anchor_a = {-1, 0}, .anchor_b = end, .spring = spring},
       kMass, 0},
      {"a coil across it", DistanceDefinition{.anchor_a = {0, -1}, .anchor_b = end, .spring = spring},
       kAcross, 0},
      {"a weld with a rigid angle", WeldDefinition{.anchor_b = end, .linear_spring = spring}, kMass, 0},
      {"a weld with a rigid point", WeldDefinition{.anchor_b = end, .angular_spring = spring}, 0, about_end},
      {"a soft weld", WeldDefinition{.anchor_b = end, .linear_spring = spring, .angular_spring = spring},
       (kMass + kAcross) / 2, kInertia},
      {"a suspension at the centre", WheelDefinition{.anchor_a = {kArm, 0}, .axis = {0, 1}, .spring = spring},
       kMass, 0},
      {"a mouse", MouseDefinition{.anchor_b = end, .spring = spring, .max_force = 10}, (kMass + kAcross) / 2,
       0},
      {"a motor joint",
       MotorDefinition{.target_position = {kArm, 0}, .max_force = 10, .max_torque = 10, .spring = spring},
       kMass, kInertia},
  };
  for (const auto& row : table) {
    SCOPED_TRACE(row.name);
    const Joined<Real> joined(row.kind);
    const JointStiffness found = joined.world.stiffness(joined.joint);
    const double w = 2 * kPi * spring.hertz;
    EXPECT_NEAR(found.linear, row.linear * w * w, relative_error<Real>() * row.linear * w * w);
    EXPECT_NEAR(found.angular, row.angular * w * w, relative_error<Real>() * row.angular * w * w);
    EXPECT_NEAR(found.linear_damping, 0.5 * row.linear * w, relative_error<Real>() * row.linear * w);
    EXPECT_NEAR(found.angular_damping, 0.5 * row.angular * w, relative_error<Real>() * row.angular * w);
  }
}

TYPED_TEST(ConstantSprings, OfTwoBodiesAreThoseOfBothTogether) {
  using Real = TypeParam;
  BasicWorld<Real> world(weightless());
  const BodyId a = add_bar(world, {0, 0}), b = add_bar(world, {1, 0});
  const Spring spring{1, 0};
  const JointId coil = world.create_joint(a, b, {.kind = DistanceDefinition{.length = 1, .spring = spring}});
  const JointId turn = world.create_joint(
      a, b, {.kind = WeldDefinition{.anchor_b = {-1, 0}, .linear_spring = spring, .angular_spring = spring}});
  const double error = relative_error<Real>();
  EXPECT_NEAR(world.stiffness(coil).linear / stiffness_for(kMass / 2, 1), 1, error);
  EXPECT_NEAR(world.stiffness(turn).angular / stiffness_for(kInertia / 2, 1), 1, error);
}

TYPED_TEST(ConstantSprings, AreRefusedForJointsWithoutSprings) {
  using Real = TypeParam;
  for (const JointKind& kind :
       std::vector<JointKind>{RevoluteDefinition{.anchor_b = {-kArm, 0}},
                              WeldDefinition{.anchor_b = {-kArm, 0}}, FrictionDefinition{.max_force = 1}}) {
    const Joined<Real> joined(kind);
    try {
      joined.world.stiffness(joined.joint);
      FAIL() << "a joint without a spring has a stiffness";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Unsupported);
      EXPECT_EQ(error.field(), "stiffness");
    }
  }
}

// Turns a body about the anchor of a coil that was stretched along it by `stretch`, now across it: the coil
// pulls with the stiffness that it had. A short step, in which the body hardly moves, shows its force.
TYPED_TEST(ConstantSprings, PullAsBeforeAfterTheBodyHasTurned) {
  using Real = TypeParam;
  const double stretch = 0.25, dt = 1e-3;
  Joined<Real> joined(DistanceDefinition{
      .anchor_a = {-1, 0}, .anchor_b = {-kArm, 0}, .length = 1 - stretch, .spring = Spring{1, 0}});
  joined.world.set_position(joined.b, {0, kArm}, kPi / 2);
  joined.world.step(dt, 1);
  const double k = stiffness_for(kMass, 1);
  // An implicit step is weaker by h^2 k over the effective mass of the turned body, and by no more.
  const double weaker = dt * dt * k / kAcross;
  const double force = joined.world.read(joined.joint).force;
  EXPECT_LE(force, k * stretch * (1 + 4 * weaker + relative_error<Real>()));
  EXPECT_GE(force, k * stretch * (1 - 4 * weaker - relative_error<Real>()));
}

TYPED_TEST(ConstantSprings, OfAHingePullAsBeforeAfterItHasOpened) {
  using Real = TypeParam;
  // Two bars end to end; folded, the hinge's effective inertia is another one.
  BasicWorld<Real> world(WorldDefinition{.gravity = {0, 0}, .sleeping = false});
  const BodyId a = add_bar(world, {-kArm, 0}), b = add_bar(world, {kArm, 0});
  const JointId hinge = world.create_joint(
      a, b,
      {.kind = RevoluteDefinition{.anchor_a = {kArm, 0}, .anchor_b = {-kArm, 0}, .spring = Spring{1, 0}}});
  const double k = world.stiffness(hinge).angular, dt = 1e-3, opened = kPi / 2;
  world.set_position(b, {0, kArm}, opened);
  world.step(dt, 1);
  // The mobility of the angle is at most that of both bars about their centres.
  const double weaker = dt * dt * k * (2 / kInertia);
  EXPECT_NEAR(world.read(hinge).torque / (k * opened), 1, 4 * weaker + relative_error<Real>());
  EXPECT_NEAR(world.stiffness(hinge).angular / k, 1, 0) << "the stiffness is that at the creation";
}

// Returns the energy of a bar on a soft weld at the origin, J; `gravity` down.
template <class Real>
double energy_of(const Joined<Real>& joined, double linear, double angular, double gravity) {
  const BasicWorld<Real>& world = joined.world;
  const Vec2d v = world.velocity(joined.b), end = world.world_point(joined.b, {-kArm, 0});
  const double w = world.angular_velocity(joined.b), angle = world.angle(joined.b);
  return 0.5 * (kMass * length_squared(v) + kInertia * w * w + linear * length_squared(end) +
                angular * angle * angle) +
         kMass * gravity * world.position(joined.b).y;
}

// With the stiffness of the present pose such a bar gained 10 to 19 m g L. Implicit steps lose energy, and
// more than the error of the positions gives.
TYPED_TEST(ConstantSprings, UndampedBarOnASoftWeldGainsNoEnergy) {
  using Real = TypeParam;
  const double gravity = 9.81, scale = kMass * gravity * kLength;
  for (const bool turns : {false, true}) {
    for (const int substeps : {1, 4, 16}) {
      SCOPED_TRACE("substeps " + std::to_string(substeps) + (turns ? ", with an angular spring" : ""));
      WeldDefinition weld{.anchor_b = {-kArm, 0}, .linear_spring = Spring{1, 0}};
      if (turns) weld.angular_spring = Spring{1, 0};
      Joined<Real> joined(weld);
      joined.world.set_gravity({0, -gravity});
      const double linear = stiffness_for(turns ? (kMass + kAcross) / 2 : kMass, 1);
      const double angular = turns ? stiffness_for(kInertia, 1) : 0;
      const double start = energy_of(joined, linear, angular, gravity);
      double most = start;
      for (int i = 0; i < 480; ++i) {
        joined.world.step(1.0 / 60, substeps);
        most = std::max(most, energy_of(joined, linear, angular, gravity));
      }
      EXPECT_LT(most - start, relative_error<Real>() * scale);
    }
  }
}

TYPED_TEST(ConstantSprings, ChangeWithTheMassTheFrequencyAndTheAnchorsAlone) {
  using Real = TypeParam;
  DistanceDefinition coil{.anchor_a = {-1, 0}, .anchor_b = {-kArm, 0}, .spring = Spring{1, 0.5}};
  Joined<Real> joined(coil);
  BasicWorld<Real>& world = joined.world;
  const double error = relative_error<Real>(), k = stiffness_for(kMass, 1);
  const auto linear = [&] { return world.stiffness(joined.joint).linear; };
  world.set_position(joined.b, {3, -2}, 2);
  run(world, 30);
  EXPECT_NEAR(linear() / k, 1, error);
  coil.length = 2;
  world.change(joined.joint, coil);
  EXPECT_NEAR(linear() / k, 1, error);
  coil.spring->hertz = 3;
  world.change(joined.joint, coil);
  EXPECT_NEAR(linear() / k, 9, 9 * error);
  world.set_mass(joined.b, {.mass = 2 * kMass, .inertia = 2 * kInertia});
  EXPECT_NEAR(linear() / k, 18, 18 * error);
  coil.anchor_a = {0, -1};  // at the creation this is across the bar
  world.change(joined.joint, coil);
  EXPECT_NEAR(linear() / k, 18 * kAcross / kMass, 18 * error);
}

TYPED_TEST(ConstantSprings, PullWithTheNewMassFromTheNextStepOn) {
  using Real = TypeParam;
  const double dt = 1e-3;
  Joined<Real> joined(
      DistanceDefinition{.anchor_a = {-1, 0}, .anchor_b = {-kArm, 0}, .length = 0.5, .spring = Spring{1, 0}});
  joined.world.step(dt, 1);
  joined.world.set_mass(joined.b, {.mass = 3 * kMass, .inertia = 3 * kInertia});
  joined.world.set_position(joined.b, {0, kArm}, kPi / 2);
  joined.world.set_velocity(joined.b, {});
  joined.world.step(dt, 1);
  const double k = stiffness_for(3 * kMass, 1), weaker = dt * dt * k / (3 * kAcross);
  EXPECT_NEAR(joined.world.read(joined.joint).force / (k * 0.5), 1, 4 * weaker + relative_error<Real>());
}

TYPED_TEST(ConstantSprings, AreTheSameInARestoredWorld) {
  using Real = TypeParam;
  Joined<Real> joined(WeldDefinition{.anchor_b = {-kArm, 0.2}, .linear_spring = Spring{1, 0}}, 0.3);
  const JointId coil = joined.world.create_joint(
      joined.a, joined.b,
      {.kind = DistanceDefinition{.anchor_a = {-1, 0}, .anchor_b = {-kArm, 0}, .spring = Spring{2, 0}}});
  joined.world.apply_angular_impulse(joined.b, 0.05);
  run(joined.world, 60);
  BasicWorld<Real> other;
  restore(other, save(joined.world));
  for (const JointId joint : {joined.joint, coil})
    EXPECT_EQ(other.stiffness(joint).linear, joined.world.stiffness(joint).linear);
  run(joined.world, 60), run(other, 60);
  EXPECT_EQ(save(other), save(joined.world));
  // Along the bar at its creation, which is across it now.
  other.destroy(joined.joint);
  const double k = other.stiffness(coil).linear, dt = 1e-3;
  other.set_position(joined.b, {0, kArm}, kPi / 2);
  other.set_velocity(joined.b, {}), other.set_angular_velocity(joined.b, 0);
  other.change(coil, DistanceDefinition{
                         .anchor_a = {-1, 0}, .anchor_b = {-kArm, 0}, .length = 0.5, .spring = Spring{2, 0}});
  other.step(dt, 1);
  EXPECT_NEAR(other.read(coil).force / (k * 0.5), 1, 4 * dt * dt * k / kAcross + relative_error<Real>());
}

}  // namespace
}  // namespace plumb
