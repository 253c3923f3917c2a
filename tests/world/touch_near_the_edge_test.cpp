// Asks each question about shapes that just touch or just do not; recordings of calls with default values;
// hashes that tell each number.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "engine/world/queries.h"
#include "engine/world/recorder.h"
#include "engine/world/replay.h"
#include "engine/world/snapshot/body_hash.h"
#include "engine/world/state_hash.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

template <class Real>
class TouchNearTheEdge : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(TouchNearTheEdge, Reals);

constexpr double kPi = std::numbers::pi;

// ---- Overlap

/// A geometry, and how far it reaches along x at y = 0, m.
struct Reaching {
  const char* name;
  ShapeGeometry geometry;
  double reach;
};

std::vector<Reaching> reaching_shapes() {
  return {{"circle", Circle{0.5}, 0.5},
          {"box", Box{1, 2}, 0.5},
          {"capsule", Capsule{{-0.25, 0}, {0.25, 0}, 0.25}, 0.5},
          {"triangle", Polygon{{{0.5, -1}, {0.5, 1}, {-1, 0}}}, 0.5},
          {"rounded", Polygon{{{0.375, -1}, {0.375, 1}, {-1, 0}}, 0.125}, 0.5},
          {"segment", Segment{{0.5, -1}, {0.5, 1}}, 0.5}};
}

TYPED_TEST(TouchNearTheEdge, OverlapOfEachShapeBeginsWhereItTouches) {
  for (const Reaching& shape : reaching_shapes()) {
    for (const double turned : {0.0, 0.3, 2.0}) {
      for (const double gap : {-0.01, 0.01}) {  // 2 % of the probe's radius
        SCOPED_TRACE(std::string(shape.name) + " " + std::to_string(turned) + " " + std::to_string(gap));
        const std::size_t touched = gap < 0 ? 1 : 0;
        BasicWorld<TypeParam> world(weightless());
        const Vec2d from{20, -10}, way{std::cos(turned), std::sin(turned)};
        const BodyId body = world.create_body({.type = BodyType::Static, .position = from, .angle = turned},
                                              ShapeDefinition{.geometry = shape.geometry});
        const Vec2d probe = from + (shape.reach + 0.5 + gap) * way;
        const BodyId visitor =
            world.create_body({.position = probe}, ShapeDefinition{.geometry = Circle{0.5}, .sensor = true});
        std::vector<ShapeId> found;
        const QueryFilter solid{.ignore = visitor};
        overlap_shape(world, QueryShape(Circle{0.5}), probe, 0, solid, found);
        EXPECT_EQ(found.size(), touched);
        overlap_shape(world, QueryShape(Box{1, 0.5}), probe, turned, solid, found);
        EXPECT_EQ(found.size(), touched);
        overlap_shape(world, QueryShape(Capsule{{0, 0}, {0.25, 0}, 0.25}),
                      from + (shape.reach + 0.25 + gap) * way, turned, solid, found);
        EXPECT_EQ(found.size(), touched);
        const ShapeId there = world.shapes(body)[0], sensor = world.shapes(visitor)[0];
        EXPECT_NEAR(distance(world, there, sensor).distance, gap, 1e-5);
        // Towards it from 1 m away: what is 2 % too short does not arrive.
        const auto cast =
            cast_shape_closest(world, QueryShape(Circle{0.5}), probe + way, 0, -1.0 * way, solid);
        EXPECT_EQ(cast.has_value(), touched == 1);
        world.step();
        EXPECT_EQ(world.events().sensor_begin.size(), touched);
      }
    }
  }
}

TYPED_TEST(TouchNearTheEdge, PointsAndRaysMeetEachShapeUpToItsEdge) {
  for (const Reaching& shape : reaching_shapes()) {
    if (std::holds_alternative<Segment>(shape.geometry)) continue;  // has no inside
    for (const double turned : {0.0, 0.3, 2.0}) {
      for (const double share : {0.98, 1.02}) {
        SCOPED_TRACE(std::string(shape.name) + " " + std::to_string(turned) + " " + std::to_string(share));
        BasicWorld<TypeParam> world(weightless());
        const Vec2d from{20, -10}, way{std::cos(turned), std::sin(turned)}, across{-way.y, way.x};
        world.create_body({.type = BodyType::Static, .position = from, .angle = turned},
                          ShapeDefinition{.geometry = shape.geometry});
        std::vector<ShapeId> found;
        shapes_at(world, from + (share * shape.reach) * way, {}, found);
        EXPECT_EQ(found.size(), share < 1 ? 1u : 0u);
        const Vec2d passing = from + (share * shape.reach) * way - 3.0 * across;
        EXPECT_EQ(ray_cast_closest(world, passing, 6.0 * across, {}).has_value(), share < 1);
        // Towards it: its surface is `reach` from the middle, and a ray that ends 2 % before it meets
        // nothing.
        const double left = 2 - shape.reach;
        EXPECT_EQ(ray_cast_closest(world, from + 2.0 * way, (-(2 - share) * left) * way, {}).has_value(),
                  share < 1);
      }
    }
  }
}

TYPED_TEST(TouchNearTheEdge, ChainsThatAreSensorsSeeWhatTouchesThem) {
  for (const double gap : {-0.01, 0.01}) {
    BasicWorld<TypeParam> world(weightless());
    const BodyId ground = world.create_body({.type = BodyType::Static});
    world.create_chain(ground, {.points = {{-5, 0}, {0, 0}, {5, 0}}, .sensor = true});
    add_body(world, {-2, 0.5 + gap}, {.geometry = Circle{0.5}});
    world.step();
    EXPECT_EQ(world.events().sensor_begin.size(), gap < 0 ? 1u : 0u);
  }
}

// ---- Recordings

template <class Real>
using Call = std::pair<WorldCall, void (*)(RecordedWorld<Real>&)>;

template <class Real>
BodyId only_body(const RecordedWorld<Real>& world) {
  return world->bodies().back();
}

// Each call as it is with nothing but default values, on a world where they are not what is there.
template <class Real>
std::vector<Call<Real>> default_calls() {
  using W = RecordedWorld<Real>;
  return {
      {WorldCall::Step, [](W& w) { w.step(); }},
      {WorldCall::SetGravity, [](W& w) { w.set_gravity(WorldDefinition{}.gravity); }},
      {WorldCall::SetSleeping, [](W& w) { w.set_sleeping(WorldDefinition{}.sleeping); }},
      {WorldCall::SetContinuous, [](W& w) { w.set_continuous(WorldDefinition{}.continuous); }},
      {WorldCall::CreateBody, [](W& w) { w.create_body({}); }},
      {WorldCall::CreateBodyWithShape, [](W& w) { w.create_body({}, ShapeDefinition{}); }},
      {WorldCall::DestroyBody, [](W& w) { w.destroy(only_body(w)); }},
      {WorldCall::SetPosition, [](W& w) { w.set_position(only_body(w), {}, 0); }},
      {WorldCall::SetVelocity, [](W& w) { w.set_velocity(only_body(w), {}); }},
      {WorldCall::SetAngularVelocity, [](W& w) { w.set_angular_velocity(only_body(w), 0); }},
      {WorldCall::MoveTowards, [](W& w) { w.move_towards(only_body(w), {}, 0, 1.0 / 60); }},
      {WorldCall::ApplyForce, [](W& w) { w.apply_force(only_body(w), {}); }},
      {WorldCall::ApplyForceAt, [](W& w) { w.apply_force(only_body(w), {}, {}); }},
      {WorldCall::ApplyTorque, [](W& w) { w.apply_torque(only_body(w), 0); }},
      {WorldCall::ApplyImpulse, [](W& w) { w.apply_impulse(only_body(w), {}); }},
      {WorldCall::ApplyImpulseAt, [](W& w) { w.apply_impulse(only_body(w), {}, {}); }},
      {WorldCall::ApplyAngularImpulse, [](W& w) { w.apply_angular_impulse(only_body(w), 0); }},
      {WorldCall::SetType, [](W& w) { w.set_type(only_body(w), BodyDefinition{}.type); }},
      {WorldCall::SetMass, [](W& w) { w.set_mass(only_body(w), {}); }},
      {WorldCall::UseDensities, [](W& w) { w.use_densities(only_body(w)); }},
      {WorldCall::SetGravityScale,
       [](W& w) { w.set_gravity_scale(only_body(w), BodyDefinition{}.gravity_scale); }},
      {WorldCall::SetDamping, [](W& w) { w.set_damping(only_body(w), 0, 0); }},
      {WorldCall::SetLocks, [](W& w) { w.set_locks(only_body(w), false, false, false); }},
      {WorldCall::SetAwake, [](W& w) { w.set_awake(only_body(w), true); }},
      {WorldCall::SetMaySleep, [](W& w) { w.set_may_sleep(only_body(w), true); }},
      {WorldCall::CreateShape, [](W& w) { w.create_shape(only_body(w), {}); }},
      {WorldCall::DestroyShape, [](W& w) { w.destroy(w->shapes(only_body(w)).front()); }},
      {WorldCall::SetMaterial, [](W& w) { w.set_material(w->shapes(only_body(w)).front(), {}); }},
      {WorldCall::SetFilter, [](W& w) { w.set_filter(w->shapes(only_body(w)).front(), {}); }},
      {WorldCall::CreateChain,
       [](W& w) {
         w.create_chain(only_body(w), {.points = {{0, 0}, {1, 0}}});
       }},
      {WorldCall::DestroyChain,
       [](W& w) {
         w.destroy(w.create_chain(only_body(w), {.points = {{0, 0}, {1, 0}}}));
       }},
      {WorldCall::CreateJoint, [](W& w) { w.create_joint(w->bodies().front(), only_body(w), {}); }},
      {WorldCall::DestroyJoint, [](W& w) { w.destroy(w->joints(w->bodies().front()).front()); }},
      {WorldCall::Change,
       [](W& w) { w.change(w->joints(w->bodies().front()).front(), DistanceDefinition{}); }},
      {WorldCall::SetSolver, [](W& w) { w.set_solver(WorldDefinition{}.solver); }},
      {WorldCall::SetIterations, [](W& w) { w.set_iterations(WorldDefinition{}.iterations); }},
      {WorldCall::SetDirectIslands, [](W& w) { w.set_direct_islands(WorldDefinition{}.direct_islands); }},
      {WorldCall::SetQuarantine, [](W& w) { w.set_quarantine(WorldDefinition{}.quarantine); }},
      {WorldCall::Release, [](W& w) { w.release(only_body(w)); }},
      {WorldCall::SetBodyData, [](W& w) { w.set_user_data(only_body(w), 0); }},
      {WorldCall::SetShapeData, [](W& w) { w.set_user_data(w->shapes(only_body(w)).front(), 0); }},
      {WorldCall::SetJointData, [](W& w) { w.set_user_data(w->joints(w->bodies().front()).front(), 0); }},
      {WorldCall::SetName, [](W& w) { w.set_name(only_body(w), ""); }},
      {WorldCall::SetEnabled, [](W& w) { w.set_enabled(only_body(w), true); }},
      {WorldCall::SetDensity,
       [](W& w) { w.set_density(w->shapes(only_body(w)).front(), ShapeDefinition{}.density); }},
      {WorldCall::SetGeometry,
       [](W& w) { w.set_geometry(w->shapes(only_body(w)).front(), ShapeDefinition{}.geometry); }},
      {WorldCall::SetSensor, [](W& w) { w.set_sensor(w->shapes(only_body(w)).front(), false); }},
      {WorldCall::SetHitEvents, [](W& w) { w.set_hit_events(w->shapes(only_body(w)).front(), false); }},
      {WorldCall::SetShapePreSolve, [](W& w) { w.set_pre_solve(w->shapes(only_body(w)).front(), false); }},
      {WorldCall::SetBodyContinuous,
       [](W& w) { w.set_continuous(only_body(w), BodyDefinition{}.continuous); }},
      {WorldCall::SetLoadEvents,
       [](W& w) { w.set_load_events(w->joints(w->bodies().front()).front(), 0, 0); }},
      {WorldCall::SetThresholds, [](W& w) { w.set_thresholds(Thresholds{}); }},
  };
}

// A world in which no value is the default.
template <class Real>
BasicWorld<Real> unusual_world() {
  BasicWorld<Real> world({.gravity = {1, -3},
                          .sleeping = false,
                          .continuous = false,
                          .solver = Solver::SequentialImpulses,
                          .iterations = 7,
                          .direct_islands = false,
                          .quarantine = false,
                          .thresholds = {.hit = 3, .bounce = 2, .sleep = 0.1}});
  const BodyId anchor = world.create_body({.type = BodyType::Static, .position = {-3, 0}});
  const BodyId other = world.create_body({.position = {-2, -1}}, ShapeDefinition{.geometry = Box{0.3, 0.2}});
  world.create_joint(
      anchor, other,
      {.kind = DistanceDefinition{.length = 1.4, .spring = Spring{3, 0.1}}, .report_force = 7});
  const BodyId body = world.create_body(
      {.position = {4, 5},
       .angle = 0.4,
       .velocity = {1, 2},
       .angular_velocity = 3,
       .mass = MassProperties{.mass = 3, .centre = {0.2, 0.1}, .inertia = 2},
       .gravity_scale = 0.5,
       .linear_damping = 0.7,
       .angular_damping = 0.6,
       .may_sleep = false},
      std::vector<ShapeDefinition>{
          {.geometry = Box{1, 2}, .material = {.friction = 0.1, .restitution = 0.4}, .filter = {.group = -3}},
          {.geometry = Circle{0.3}, .position = {1, 0}, .density = 4}});
  world.set_locks(body, false, false, true);
  return world;
}

TYPED_TEST(TouchNearTheEdge, EachCallWithDefaultValuesIsRecordedAndReplayed) {
  std::set<WorldCall> tried;
  for (const auto& [which, call] : default_calls<TypeParam>()) {
    SCOPED_TRACE(kWorldCallNames[static_cast<int>(which)]);
    EXPECT_TRUE(tried.insert(which).second);
    const auto file = std::filesystem::temp_directory_path() /
                      ("plumb_default_call_" + std::to_string(sizeof(TypeParam)) + ".rec");
    int calls = 3;
    {
      RecordedWorld<TypeParam> world(file, unusual_world<TypeParam>());
      calls += which == WorldCall::DestroyChain ? 2 : 1;
      call(world);
      for (int i = 0; i < 3; ++i) world.step(1.0 / 50, 3);
    }
    const ReplayReport report = replay<TypeParam>(file);
    EXPECT_EQ(report.calls, calls);
    EXPECT_FALSE(report.first_difference) << "in step " << *report.first_difference;
    EXPECT_EQ(report.message, "");
    std::filesystem::remove(file);
  }
  EXPECT_EQ(static_cast<int>(tried.size()), kWorldCalls) << "a call is missing here";
}

// ---- Hashes

// By a few roundings, and by the sign alone: what a step would make of the difference plays no part.
TYPED_TEST(TouchNearTheEdge, HashesTellTheSpinOfEachBodyAlone) {
  using Real = TypeParam;
  const double usual[] = {0.5, -2, 1};
  const auto world_with = [&](int which, double spin) {
    BasicWorld<Real> world(weightless());
    for (int i = 0; i < 3; ++i)
      world.create_body({.position = {3.0 * i, 0}, .angular_velocity = i == which ? spin : usual[i]},
                        ShapeDefinition{.geometry = Circle{1}});
    return world;
  };
  const auto hashes_of = [](const BasicWorld<Real>& world) {
    std::vector<BodyHash> bodies;
    hash_awake_bodies(world.data(), bodies);
    return bodies;
  };
  const BasicWorld<Real> reference = world_with(-1, 0);
  for (int which = 0; which < 3; ++which) {
    const BasicWorld<Real> same = world_with(which, usual[which]);
    const std::vector<BodyHash> one = hashes_of(reference);
    EXPECT_EQ(same.hash(), reference.hash());
    EXPECT_EQ(full_hash(same), full_hash(reference));
    EXPECT_EQ(hashes_of(same), one);
    for (const double spin : {usual[which] + 1e-6, -usual[which]}) {
      SCOPED_TRACE(testing::Message() << "body " << which << ", spin " << spin);
      const BasicWorld<Real> other = world_with(which, spin);
      EXPECT_NE(other.hash(), reference.hash());
      EXPECT_NE(full_hash(other), full_hash(reference));
      const std::vector<BodyHash> two = hashes_of(other);
      for (std::size_t body = 0; body < 3; ++body)
        EXPECT_EQ(one[body] == two[body], static_cast<int>(body) != which);
    }
  }
}

}  // namespace
}  // namespace plumb
