// Closed forms near the edge: 2 % beside a figure tells right from wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "engine/world/force_laws.h"
#include "engine/world/queries.h"
#include "engine/world/recorder.h"
#include "engine/world/replay.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

template <class Real>
class NearTheEdge : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(NearTheEdge, Reals);

constexpr double kPi = std::numbers::pi;

template <class Real>
void expect_at(const BasicWorld<Real>& world, BodyId body, Vec2d where, double tolerance) {
  EXPECT_NEAR(world.position(body).x, where.x, tolerance);
  EXPECT_NEAR(world.position(body).y, where.y, tolerance);
}

// ---- Masses off the origin

TYPED_TEST(NearTheEdge, AKinematicBodyTurnsAboutItsOrigin) {
  BasicWorld<TypeParam> world;
  const BodyId arm = world.create_body({.type = BodyType::Kinematic, .position = {1, 1}},
                                       ShapeDefinition{.geometry = Box{0.5, 0.5}, .position = {2, 0}});
  world.create_shape(arm, {.geometry = Box{0.5, 0.5}, .position = {4, 0}});
  world.set_angular_velocity(arm, kPi / 2);
  run(world, 60);
  expect_at(world, arm, {1, 1}, 1e-6);
  EXPECT_NEAR(world.angle(arm), kPi / 2, 1e-5);
  std::vector<ShapeId> found;
  shapes_at(world, {1, 3}, {}, found);
  EXPECT_EQ(found, std::vector{world.shapes(arm)[0]});
  EXPECT_NEAR(world.velocity_at(arm, {1, 3}).x, -kPi, 1e-5);
  // Dynamic from now on, it goes on as it was, about its centre of mass.
  world.set_type(arm, BodyType::Dynamic);
  EXPECT_NEAR(world.velocity(arm).x, -3 * kPi / 2, 1e-4);
  EXPECT_NEAR(world.centre(arm).y, 4, 1e-5);
  world.set_type(arm, BodyType::Kinematic);
  expect_at(world, arm, {1, 1}, 1e-5);
  EXPECT_NEAR(world.velocity(arm).x, 0, 1e-4);
}

TYPED_TEST(NearTheEdge, MoveTowardsArrivesWhereverTheMassIs) {
  for (const BodyType type : {BodyType::Kinematic, BodyType::Dynamic}) {
    for (const bool in_two : {false, true}) {
      BasicWorld<TypeParam> world(weightless());
      const ShapeDefinition off{.geometry = Box{1, 1}, .position = {2, 1}};
      const BodyId body = world.create_body({.type = type, .position = {1, 0}}, off);
      if (in_two) world.create_shape(body, {.geometry = Box{1, 2}, .position = {-3, 1}});
      world.move_towards(body, {3, 1}, 0.5, 1);
      run(world, 60);
      expect_at(world, body, {3, 1}, 2e-4);
      EXPECT_NEAR(world.angle(body), 0.5, 1e-4);
    }
  }
}

TYPED_TEST(NearTheEdge, ANewCentreOfMassMovesAsThatPointDid) {
  BasicWorld<TypeParam> world(weightless());
  const BodyId body =
      world.create_body({.velocity = {1, 0}, .angular_velocity = 2}, ShapeDefinition{.geometry = Box{1, 1}});
  world.create_shape(body, {.geometry = Box{1, 1}, .position = {1, 0}, .density = 3});
  for (const bool stepped : {false, true}) {
    if (stepped) world.step(1e-6, 1);
    EXPECT_NEAR(world.mass(body), 4, 1e-6);
    // 1/6 of each square's own, and 3 times 1/4 m and once 3/4 m from the centre.
    EXPECT_NEAR(world.inertia(body), 4 / 6.0 + 3 / 16.0 + 9 / 16.0, 1e-5);
    EXPECT_NEAR(world.centre(body).x, 0.75, 1e-5);
    EXPECT_NEAR(world.velocity(body).x, 1, 1e-5);
    EXPECT_NEAR(world.velocity(body).y, 1.5, 1e-5);
    expect_at(world, body, {0, 0}, 1e-5);
  }
  // Reading beside it changes nothing.
  BasicWorld<TypeParam> other(weightless());
  const BodyId same =
      other.create_body({.velocity = {1, 0}, .angular_velocity = 2}, ShapeDefinition{.geometry = Box{1, 1}});
  other.create_shape(same, {.geometry = Box{1, 1}, .position = {1, 0}, .density = 3});
  other.step(1e-6, 1);
  EXPECT_EQ(other.hash(), world.hash());
}

TYPED_TEST(NearTheEdge, ShapesThatComeAndGoLeaveTheMassOfThoseThatStay) {
  BasicWorld<TypeParam> world(weightless());
  const BodyId body = world.create_body({.position = {5, 5}});
  std::vector<ShapeId> made;
  for (int i = 0; i < 10; ++i)
    made.push_back(world.create_shape(body, {.geometry = Box{1, 1}, .position = {1.0 * i, 0}}));
  EXPECT_EQ(world.shapes(body), made) << "in the order in which they were made";
  for (const int i : {0, 9, 4}) world.destroy(made[static_cast<std::size_t>(i)]);
  world.step();
  EXPECT_NEAR(world.mass(body), 7, 1e-5);
  EXPECT_NEAR(world.centre(body).x, 5 + (45 - 13) / 7.0, 1e-5);
  double inertia = 0;
  for (const int i : {1, 2, 3, 5, 6, 7, 8}) inertia += 1 / 6.0 + std::pow(i - 32 / 7.0, 2);
  EXPECT_NEAR(world.inertia(body), inertia, 1e-4);
}

TYPED_TEST(NearTheEdge, CreateBodyTellsTheHandlesOfItsShapes) {
  BasicWorld<TypeParam> world;
  const std::vector<ShapeDefinition> shapes = {
      {.geometry = Circle{1}, .user_data = 7}, {.geometry = Box{1, 1}, .user_data = 8}, {.user_data = 9}};
  std::vector<ShapeId> made;
  const BodyId body = world.create_body({}, shapes, made);
  ASSERT_EQ(made.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(world.user_data(made[i]), 7 + i);
  EXPECT_EQ(made, world.shapes(body));
  std::vector<JointId> joints;
  const BodyId other = add_box(world, {3, 0});
  for (int i = 0; i < 3; ++i)
    joints.push_back(world.create_joint(body, other, {.kind = DistanceDefinition{.length = 3}}));
  EXPECT_EQ(world.joints(body), joints);
  EXPECT_EQ(world.joints(other), joints);
}

// ---- Gravity of its own

TYPED_TEST(NearTheEdge, GravityScaleCountsInContactsAndJointsToo) {
  for (const double scale : {0.5, 0.97, 1.03, 2.0}) {
    BasicWorld<TypeParam> world(without_sleep());
    add_ground(world);
    const BodyId box = add_box(world, {0, 0.5});
    world.set_gravity_scale(box, scale);
    const BodyId nail = world.create_body({.type = BodyType::Static, .position = {5, 9}});
    const BodyId hung = add_box(world, {5, 6});
    world.set_gravity_scale(hung, scale);
    const JointId rod = world.create_joint(nail, hung, {.kind = DistanceDefinition{.length = 3}});
    run(world, 180);
    double pressed = 0;
    for (const ContactReading& contact : world.contacts(box))
      for (int i = 0; i < contact.count; ++i) pressed += contact.impulses[i];
    EXPECT_NEAR(pressed * 240, scale * kGravity, 0.01 * scale * kGravity);
    EXPECT_NEAR(world.read(rod).force, scale * kGravity, 0.01 * scale * kGravity);
  }
}

// ---- What joints bear

template <class Real>
bool breaks(const JointKind& kind, Vec2d at, double force, double torque) {
  BasicWorld<Real> world(without_sleep());
  const BodyId nail = world.create_body({.type = BodyType::Static});
  const BodyId body = add_box(world, at);
  const JointId joint =
      world.create_joint(nail, body, {.kind = kind, .break_force = force, .break_torque = torque});
  run(world, 120);
  return !world.valid(joint);
}

TYPED_TEST(NearTheEdge, JointsBreakAtTheForceThatTheyWereGiven) {
  using Real = TypeParam;
  const double weight = kGravity;  // of 1 kg
  const std::pair<const char*, JointKind> kinds[] = {
      {"distance", DistanceDefinition{.length = 2}},
      {"revolute", RevoluteDefinition{.anchor_b = {0, 2}}},
      {"weld", WeldDefinition{.anchor_b = {0, 2}}},
      {"prismatic", PrismaticDefinition{.anchor_b = {0, 2}, .axis = {1, 0}}},
      {"wheel", WheelDefinition{.anchor_b = {0, 2}, .axis = {1, 0}}},
  };
  for (const auto& [name, kind] : kinds) {
    EXPECT_FALSE(breaks<Real>(kind, {0, -2}, 1.02 * weight, 0)) << name;
    EXPECT_TRUE(breaks<Real>(kind, {0, -2}, 0.98 * weight, 0)) << name;
  }
  // A beam of 2 m that stands out from the wall bears m g times 2 m there.
  const JointKind weld = WeldDefinition{.anchor_b = {-2, 0}};
  EXPECT_FALSE(breaks<Real>(weld, {2, 0}, 0, 1.02 * 2 * weight));
  EXPECT_TRUE(breaks<Real>(weld, {2, 0}, 0, 0.98 * 2 * weight));
}

TYPED_TEST(NearTheEdge, APrismaticJointLetsItsBodySlideAlongItsAxisAlone) {
  BasicWorld<TypeParam> world(without_sleep());
  const BodyId rail = world.create_body({.type = BodyType::Static});
  const BodyId sleeve = add_box(world, {0, 0});
  const Vec2d axis{std::cos(kPi / 6), -std::sin(kPi / 6)};
  const JointId joint = world.create_joint(rail, sleeve, {.kind = PrismaticDefinition{.axis = axis}});
  run(world, 60);
  const double way = kGravity * std::sin(kPi / 6) / 2;
  EXPECT_NEAR(world.read(joint).translation, way, 0.01 * way);
  EXPECT_NEAR(cross(axis, world.position(sleeve)), 0, 1e-3);
  EXPECT_NEAR(world.angle(sleeve), 0, 1e-3);
  EXPECT_NEAR(world.read(joint).force, kGravity * std::cos(kPi / 6), 0.02 * kGravity);
}

TYPED_TEST(NearTheEdge, AWheelTurnsFreelyAndKeepsToItsAxis) {
  BasicWorld<TypeParam> world(without_sleep());
  const BodyId cart = world.create_body({.type = BodyType::Static});
  const BodyId wheel = world.create_body({.angular_velocity = 3}, ShapeDefinition{.geometry = Circle{0.5}});
  const JointId joint =
      world.create_joint(cart, wheel, {.kind = WheelDefinition{.axis = {0, 1}, .spring = Spring{4, 1}}});
  world.apply_impulse(wheel, {2, 0});  // across the axis
  run(world, 240);
  EXPECT_NEAR(world.position(wheel).x, 0, 2e-3);
  EXPECT_NEAR(world.angular_velocity(wheel), 3, 0.03);
  EXPECT_LT(world.read(joint).translation, 0);
}

// ---- What just touches

TYPED_TEST(NearTheEdge, OverlapBeginsWhereShapesTouch) {
  for (const double gap : {-2e-3, 2e-3}) {
    BasicWorld<TypeParam> world(weightless());
    const BodyId zone =
        world.create_body({.type = BodyType::Static}, ShapeDefinition{.geometry = Box{2, 2}, .sensor = true});
    const BodyId box = add_box(world, {1.5 + gap, 0});
    add_body(world, {0, 1.5 + gap}, {.geometry = Circle{0.5}});
    world.step();
    EXPECT_EQ(world.events().sensor_begin.size(), gap < 0 ? 2u : 0u) << gap;
    EXPECT_EQ(world.overlapping(world.shapes(zone)[0]).size(), gap < 0 ? 2u : 0u);
    std::vector<ShapeId> found;
    overlap_shape(world, QueryShape(Box{2, 2}), {}, 0, {}, found);
    EXPECT_EQ(found.size(), gap < 0 ? 2u : 0u);
    overlap_box(world, {{-1, -1}, {1, 1}}, {}, found);
    EXPECT_EQ(found.size(), gap < 0 ? 2u : 0u);
    EXPECT_NEAR(distance(world, world.shapes(zone)[0], world.shapes(box)[0]).distance, gap, 1e-5);
  }
}

// ---- Wind

// The sail stands 1 m off the axis and is 2 m long: the air that it meets at 3 m/s presses rho/2 9 on each
// metre.
TYPED_TEST(NearTheEdge, AirAtRestBrakesWhatSpins) {
  BasicWorld<TypeParam> world(weightless());
  const BodyId sail = world.create_body(
      {.angular_velocity = 3, .mass = MassProperties{.mass = 1000, .centre = {0, 0}, .inertia = 100}},
      ShapeDefinition{.geometry = Box{2, 0.2}, .position = {1, 0}});
  const double dt = 1.0 / 60, force = 0.5 * 1.2 * 9 * 2;
  apply_wind(world, {}, dt);
  world.step(dt, 4);
  EXPECT_NEAR(world.angular_velocity(sail) - 3, -force / 100 * dt, 0.02 * force / 100 * dt);
  EXPECT_NEAR(world.velocity(sail).y, -force / 1000 * dt, 0.02 * force / 1000 * dt);
}

// ---- Recordings and hashes

TYPED_TEST(NearTheEdge, CallsWithDefaultValuesAreRecorded) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("plumb_defaults_" + std::to_string(sizeof(TypeParam)) + ".rec");
  int calls = 0;
  const auto count = [&](auto&&) { ++calls; };
  {
    RecordedWorld<TypeParam> world(file);
    const WorldDefinition defaults;
    const BodyId body =
        world.create_body({.gravity_scale = 2, .linear_damping = 1, .lock_x = true},
                          ShapeDefinition{.geometry = Box{1, 1}, .material = {.friction = 0}});
    ++calls;
    world.set_gravity(defaults.gravity), count("set_gravity");
    world.set_sleeping(true), count("set_sleeping");
    world.set_continuous(true), count("set_continuous");
    world.set_solver(defaults.solver), count("set_solver");
    world.set_iterations(defaults.iterations), count("set_iterations");
    world.set_direct_islands(true), count("set_direct_islands");
    world.set_quarantine(true), count("set_quarantine");
    world.set_gravity_scale(body, 1), count("set_gravity_scale");
    world.set_damping(body, 0, 0), count("set_damping");
    world.set_locks(body, false, false, false), count("set_locks");
    world.set_awake(body, true), count("set_awake");
    world.set_may_sleep(body, true), count("set_may_sleep");
    world.set_velocity(body, {}), count("set_velocity");
    world.set_angular_velocity(body, 0), count("set_angular_velocity");
    world.set_position(body, {}, 0), count("set_position");
    world.apply_force(body, {}), count("apply_force");
    world.apply_torque(body, 0), count("apply_torque");
    world.apply_impulse(body, {}), count("apply_impulse");
    world.apply_angular_impulse(body, 0), count("apply_angular_impulse");
    world.set_type(body, BodyType::Dynamic), count("set_type");
    world.use_densities(body), count("use_densities");
    world.set_material(world->shapes(body)[0], {}), count("set_material");
    world.set_filter(world->shapes(body)[0], {}), count("set_filter");
    world.create_shape(body, {}), count("create_shape");
    world.release(body), count("release");
    for (int i = 0; i < 10; ++i) world.step(), ++calls;
    EXPECT_NEAR(world->velocity(body).y, -kGravity / 6, 1e-4);
  }
  const ReplayReport report = replay<TypeParam>(file);
  EXPECT_EQ(report.calls, calls);
  EXPECT_FALSE(report.first_difference) << "in step " << *report.first_difference;
  EXPECT_EQ(report.message, "");
  std::filesystem::remove(file);
}

TYPED_TEST(NearTheEdge, HashesTellEachNumberOfAState) {
  const auto hash_of = [](const BodyDefinition& body) {
    BasicWorld<TypeParam> world(weightless());
    world.create_body(body, ShapeDefinition{.geometry = Circle{1}});
    return world.hash();
  };
  const std::uint64_t usual = hash_of({});
  EXPECT_EQ(hash_of({}), usual);
  EXPECT_NE(hash_of({.position = {1e-6, 0}}), usual);
  EXPECT_NE(hash_of({.position = {0, 1e-6}}), usual);
  EXPECT_NE(hash_of({.angle = 1e-6}), usual);
  EXPECT_NE(hash_of({.velocity = {1e-6, 0}}), usual);
  EXPECT_NE(hash_of({.velocity = {0, 1e-6}}), usual);
  EXPECT_NE(hash_of({.angular_velocity = 1e-6}), usual);
}

}  // namespace
}  // namespace plumb
