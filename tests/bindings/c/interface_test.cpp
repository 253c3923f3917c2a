// The C interface against the same calls of the C++ interface: equal bits, and errors that name what is
// wrong.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "engine/world/mover.h"
#include "engine/world/queries.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "engine/world/world.h"
#include "tests/bindings/c/fixture.h"

namespace {

using plumb::tests::C;
using plumb::tests::kDt;
using ::testing::HasSubstr;

TEST_F(C, StepsLikeCppInBothPrecisions) {
  for (const plumb_precision precision : {PLUMB_FLOAT, PLUMB_DOUBLE}) {
    plumb_world_definition definition = plumb_default_world();
    definition.precision = precision;
    plumb_world_destroy(world);
    world = plumb_world_create(&definition);
    box(PLUMB_STATIC, {0, -1}, 40, 2);
    for (int row = 0; row < 5; ++row) box(PLUMB_DYNAMIC, {0.1 * row, 0.6 + 1.1 * row}, 1, 1);
    for (int i = 0; i < 120; ++i) ASSERT_EQ(plumb_world_step(world, kDt, 4), PLUMB_OK);
    const auto same = [&]<class World>(World cpp) {
      const plumb::ShapeDefinition shape{.geometry = plumb::Box{1, 1}, .hit_events = true};
      cpp.create_body({.type = plumb::BodyType::Static, .position = {0, -1}},
                      {.geometry = plumb::Box{40, 2}, .hit_events = true});
      for (int row = 0; row < 5; ++row) cpp.create_body({.position = {0.1 * row, 0.6 + 1.1 * row}}, shape);
      for (int i = 0; i < 120; ++i) cpp.step(kDt, 4);
      EXPECT_EQ(plumb_world_hash(world), cpp.hash());
      EXPECT_EQ(plumb_world_full_hash(world), plumb::full_hash(cpp));
    };
    if (precision == PLUMB_FLOAT) {
      same(plumb::World{});
    } else {
      same(plumb::DoubleWorld{});
    }
  }
}

TEST_F(C, DefaultsAreThoseOfCpp) {
  const plumb::WorldDefinition w;
  const plumb_world_definition d = plumb_default_world();
  EXPECT_EQ(d.gravity.y, w.gravity.y);
  EXPECT_EQ(static_cast<int>(d.combine_restitution), static_cast<int>(w.combine_restitution));
  EXPECT_TRUE(d.sleeping && d.continuous && d.direct_islands && d.quarantine);
  EXPECT_EQ(d.iterations, w.iterations);
  const plumb_shape_definition shape = plumb_default_shape();
  EXPECT_EQ(shape.material.friction, plumb::Material{}.friction);
  EXPECT_EQ(shape.filter.mask, ~std::uint64_t{0});
  EXPECT_EQ(shape.density, 1);
}

TEST_F(C, FillsArraysOfAllBodies) {
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  const plumb_body gone = box(PLUMB_DYNAMIC, {5, 5}, 1, 1);
  const plumb_body stays = box(PLUMB_DYNAMIC, {-5, 7}, 1, 1);
  plumb_body_set_velocity(world, stays, {1, 2});
  plumb_body_set_angular_velocity(world, stays, 3);
  plumb_body_destroy(world, gone);
  EXPECT_EQ(plumb_world_bodies(world, nullptr, 0), 2u);
  plumb_body bodies[2];
  plumb_pose poses[2];
  plumb_velocity velocities[2];
  ASSERT_EQ(plumb_world_bodies(world, bodies, 2), 2u);
  ASSERT_EQ(plumb_world_poses(world, poses, 2), 2u);
  ASSERT_EQ(plumb_world_velocities(world, velocities, 2), 2u);
  EXPECT_EQ(bodies[1].index, stays.index);
  EXPECT_EQ(poses[1].position.x, -5);
  EXPECT_EQ(poses[1].position.y, 7);
  EXPECT_EQ(velocities[1].linear.y, 2);
  EXPECT_EQ(velocities[1].angular, 3);
  poses[1].position.x = 99;
  EXPECT_EQ(plumb_world_poses(world, poses, 1), 2u);
  EXPECT_EQ(poses[1].position.x, 99) << "beyond the capacity nothing is written";
}

TEST_F(C, NamesWhatIsWrongWithAValue) {
  plumb_body_definition body = plumb_default_body();
  body.name = "ball";
  plumb_shape_definition shape = plumb_default_shape();
  shape.geometry = plumb_circle(-0.5);
  const plumb_body refused = plumb_body_create(world, &body, &shape, 1);
  EXPECT_EQ(refused.index, PLUMB_NO_INDEX);
  const plumb_error error = plumb_last_error();
  EXPECT_EQ(error.status, PLUMB_VALUE);
  EXPECT_THAT(error.message, HasSubstr("ball"));
  EXPECT_THAT(error.subject, HasSubstr("shape 0 of body 'ball'"));
  EXPECT_STREQ(error.field, "radius");
  EXPECT_STREQ(error.value, "-0.5");
  EXPECT_EQ(plumb_world_counts(world).bodies, 0);
  plumb_clear_error();
  EXPECT_EQ(plumb_last_error().status, PLUMB_OK);
  EXPECT_STREQ(plumb_last_error().message, "");
}

TEST_F(C, RefusesNullsWhereItWouldWrite) {
  plumb_ray_hit hit;
  const plumb_geometry circle = plumb_circle(0.5);
  const auto refused = [](auto found) {
    const bool named = plumb_last_error().status == PLUMB_VALUE &&
                       std::string(plumb_last_error().message).find("NULL") != std::string::npos;
    plumb_clear_error();
    return !found && named;
  };
  // Asks an empty world first, and then one with a box.
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(refused(plumb_ray_cast_closest(world, {-5, 0}, {9, 0}, nullptr, nullptr))) << i;
    EXPECT_TRUE(refused(plumb_cast_shape_closest(world, &circle, {{-5, 0}, 0}, {9, 0}, nullptr, nullptr)))
        << i;
    EXPECT_TRUE(refused(plumb_nearest(world, {0, 5}, 9, nullptr, nullptr))) << i;
    EXPECT_TRUE(refused(plumb_world_svg(world, nullptr, 100, nullptr, 5))) << i;
    EXPECT_GT(plumb_world_svg(world, nullptr, 100, nullptr, 0), 0u) << "asks for the size";
    box(PLUMB_DYNAMIC, {0, 0}, 1, 1);
  }
  EXPECT_TRUE(plumb_ray_cast_closest(world, {-5, 0}, {9, 0}, nullptr, &hit));
  EXPECT_EQ(plumb_last_error().status, PLUMB_OK);
}

TEST_F(C, RefusesStaleBodiesToIgnoreAndUnknownKindsOfJoints) {
  const plumb_body body = box(PLUMB_DYNAMIC, {0, 0}, 1, 1);
  ASSERT_EQ(plumb_body_destroy(world, body), PLUMB_OK);
  box(PLUMB_DYNAMIC, {0, 0}, 1, 1);  // takes its index
  plumb_query_filter filter = plumb_default_query_filter();
  filter.ignore = body;
  plumb_ray_hit hit;
  plumb_nearest_hit near;
  const plumb_geometry circle = plumb_circle(0.5);
  const auto refused = [](auto found) {
    const bool named = plumb_last_error().status == PLUMB_NAME;
    plumb_clear_error();
    return !found && named;
  };
  EXPECT_TRUE(refused(plumb_ray_cast_closest(world, {-5, 0}, {9, 0}, &filter, &hit)));
  EXPECT_TRUE(refused(plumb_ray_cast_all(world, {-5, 0}, {9, 0}, &filter, &hit, 1)));
  EXPECT_TRUE(refused(plumb_overlap_shape(world, &circle, {{0, 0}, 0}, &filter, nullptr, 0)));
  EXPECT_TRUE(refused(plumb_overlap_box(world, {-1, -1}, {1, 1}, &filter, nullptr, 0)));
  EXPECT_TRUE(refused(plumb_shapes_at(world, {0, 0}, &filter, nullptr, 0)));
  EXPECT_TRUE(refused(plumb_nearest(world, {0, 5}, 9, &filter, &near)));
  plumb_mover_options options = plumb_default_mover();
  options.filter = filter;
  const plumb_geometry capsule = plumb_capsule({0, 0.3}, {0, 1}, 0.3);
  EXPECT_TRUE(refused(plumb_move(world, &capsule, {3, 0}, {1, 0}, kDt, &options, nullptr, 0).on_ground));
  plumb_blast blast = plumb_default_blast();
  blast.occlusion = true, blast.cover.ignore = body;
  EXPECT_EQ(plumb_world_explode(world, &blast), PLUMB_NAME);
  plumb_clear_error();

  plumb_default_joint(static_cast<plumb_joint_kind>(13));
  EXPECT_EQ(plumb_last_error().status, PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().field, "kind");
  EXPECT_STREQ(plumb_last_error().value, "13");
  plumb_clear_error();
}

TEST_F(C, RefusesNullsDeadHandlesAndNumbersThatAreNoEnumerators) {
  EXPECT_EQ(plumb_world_step(nullptr, kDt, 4), PLUMB_VALUE);
  EXPECT_THAT(plumb_last_error().message, HasSubstr("world"));
  EXPECT_EQ(plumb_body_create(world, nullptr, nullptr, 0).index, PLUMB_NO_INDEX);
  const plumb_body body = box(PLUMB_DYNAMIC, {0, 0}, 1, 1);
  EXPECT_EQ(plumb_body_destroy(world, body), PLUMB_OK);
  EXPECT_EQ(plumb_body_set_velocity(world, body, {1, 0}), PLUMB_NAME);
  plumb_clear_error();
  EXPECT_EQ(plumb_body_position(world, body).x, 0);
  EXPECT_EQ(plumb_last_error().status, PLUMB_NAME) << "a reader says that it failed";
  EXPECT_EQ(plumb_world_set_solver(world, static_cast<plumb_solver>(7)), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().field, "solver");
  EXPECT_EQ(plumb_world_poses(world, nullptr, 3), 0u);
  EXPECT_EQ(plumb_last_error().status, PLUMB_VALUE);
}

TEST_F(C, JointsOfEveryKindReadBackAsMade) {
  const plumb_body a = box(PLUMB_STATIC, {0, 10}, 1, 1), b = box(PLUMB_DYNAMIC, {0, 8}, 1, 1);
  for (int kind = PLUMB_DISTANCE; kind <= PLUMB_FRICTION; ++kind) {
    plumb_joint_definition d = plumb_default_joint(static_cast<plumb_joint_kind>(kind));
    d.collide = true;
    d.break_force = 12;
    d.user_data = 77;
    d.anchor_b = {0, 0.5};
    if (kind == PLUMB_GEAR || kind == PLUMB_MOTOR || kind == PLUMB_RATCHET) d.anchor_b = {0, 0};
    if (kind == PLUMB_PULLEY) d.ground_a = {0, 12}, d.ground_b = {0, 12};
    const plumb_joint joint = plumb_joint_create(world, a, b, &d);
    ASSERT_NE(joint.index, PLUMB_NO_INDEX) << kind << ": " << plumb_last_error().message;
    const plumb_joint_definition back = plumb_joint_get_definition(world, joint);
    EXPECT_EQ(back.kind, kind);
    EXPECT_TRUE(back.collide);
    EXPECT_EQ(back.break_force, 12);
    EXPECT_EQ(back.user_data, 77u);
    EXPECT_EQ(back.anchor_b.y, d.anchor_b.y);
    EXPECT_EQ(back.spring.on, d.spring.on);
    EXPECT_EQ(back.ratio, d.ratio);
    plumb_body first, second;
    EXPECT_EQ(plumb_joint_bodies(world, joint, &first, &second), PLUMB_OK);
    EXPECT_EQ(second.index, b.index);
    EXPECT_EQ(plumb_joint_destroy(world, joint), PLUMB_OK);
  }
}

TEST_F(C, AMotorTurnsAndIsChanged) {
  const plumb_body base = box(PLUMB_STATIC, {0, 0}, 1, 1), wheel = box(PLUMB_DYNAMIC, {0, 3}, 1, 1);
  plumb_joint_definition d = plumb_default_joint(PLUMB_REVOLUTE);
  d.anchor_a = {0, 3};
  d.motor = {true, 2, 1000};
  const plumb_joint joint = plumb_joint_create(world, base, wheel, &d);
  for (int i = 0; i < 60; ++i) plumb_world_step(world, kDt, 4);
  EXPECT_NEAR(plumb_body_angular_velocity(world, wheel), 2, 1e-4);
  d.motor.speed = -1;
  EXPECT_EQ(plumb_joint_change(world, joint, &d), PLUMB_OK);
  for (int i = 0; i < 60; ++i) plumb_world_step(world, kDt, 4);
  EXPECT_NEAR(plumb_body_angular_velocity(world, wheel), -1, 1e-4);
  EXPECT_NEAR(plumb_joint_read(world, joint).angle, plumb_body_angle(world, wheel), 1e-6);
}

TEST_F(C, TellsTheStiffnessOfSpringsAndRefusesJointsWithout) {
  const plumb_body base = box(PLUMB_STATIC, {0, 0}, 1, 1), crate = box(PLUMB_DYNAMIC, {0, 3}, 1, 1);
  plumb_joint_definition d = plumb_default_joint(PLUMB_DISTANCE);
  const plumb_joint rod = plumb_joint_create(world, base, crate, &d);
  plumb_clear_error();
  EXPECT_EQ(plumb_joint_stiffness(world, rod).linear, 0);
  EXPECT_EQ(plumb_last_error().status, PLUMB_UNSUPPORTED);
  plumb_clear_error();
  d.spring = {true, 2, 0.5};
  const plumb_joint coil = plumb_joint_create(world, base, crate, &d);
  const double w = 4 * M_PI, mass = plumb_body_mass(world, crate);
  EXPECT_NEAR(plumb_joint_stiffness(world, coil).linear, mass * w * w, 1e-5 * mass * w * w);
  EXPECT_NEAR(plumb_joint_stiffness(world, coil).linear_damping, mass * w, 1e-5 * mass * w);
  EXPECT_EQ(plumb_joint_stiffness(world, coil).angular, 0);
  EXPECT_EQ(plumb_last_error().status, PLUMB_OK);
}

TEST_F(C, ReportsEventsAndContacts) {
  const plumb_body ground = box(PLUMB_STATIC, {0, -1}, 40, 2), falls = box(PLUMB_DYNAMIC, {0, 2}, 1, 1);
  size_t hits = 0, begins = 0;
  for (int i = 0; i < 90; ++i) {
    plumb_world_step(world, kDt, 4);
    const plumb_events events = plumb_world_events(world);
    hits += events.hit_count, begins += events.begin_count;
    if (events.hit_count > 0) {
      EXPECT_GT(events.hits[0].speed, 4);
    }
  }
  EXPECT_EQ(hits, 1u);
  EXPECT_EQ(begins, 1u);
  plumb_contact contacts[4];
  ASSERT_EQ(plumb_world_contacts(world, contacts, 4), 1u);
  EXPECT_EQ(contacts[0].count, 2);
  EXPECT_NEAR(std::abs(contacts[0].normal.y), 1, 1e-6);
  EXPECT_EQ(plumb_body_contacts(world, ground, nullptr, 0), 1u);
  EXPECT_EQ(plumb_body_contacts(world, falls, nullptr, 0), 1u);
}

TEST_F(C, QueriesAndTheMoverGiveWhatCppGives) {
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  const plumb_body target = box(PLUMB_DYNAMIC, {3, 0.5}, 1, 1);
  plumb::World cpp;
  cpp.create_body({.type = plumb::BodyType::Static, .position = {0, -1}}, {.geometry = plumb::Box{40, 2}});
  cpp.create_body({.position = {3, 0.5}}, {.geometry = plumb::Box{1, 1}});
  plumb_ray_hit hit;
  ASSERT_TRUE(plumb_ray_cast_closest(world, {0, 0.5}, {10, 0}, nullptr, &hit));
  EXPECT_EQ(hit.fraction, plumb::ray_cast_closest(cpp, {0, 0.5}, {10, 0})->fraction);
  EXPECT_EQ(hit.body.index, target.index);
  plumb_query_filter filter = plumb_default_query_filter();
  filter.ignore = target;
  EXPECT_FALSE(plumb_ray_cast_closest(world, {0, 0.5}, {10, 0}, &filter, &hit));
  filter = plumb_default_query_filter();
  filter.condition = [](plumb_shape, void* called) { return ++*static_cast<int*>(called) > 1000; };
  int called = 0;
  filter.context = &called;
  EXPECT_FALSE(plumb_ray_cast_closest(world, {0, 0.5}, {10, 0}, &filter, &hit));
  EXPECT_GT(called, 0);

  const plumb_geometry circle = plumb_circle(0.5);
  plumb_cast_hit cast;
  ASSERT_TRUE(plumb_cast_shape_closest(world, &circle, {{0, 0.6}, 0}, {10, 0}, nullptr, &cast));
  EXPECT_EQ(cast.fraction,
            plumb::cast_shape_closest(cpp, plumb::Circle{0.5}, {0, 0.6}, 0, {10, 0})->fraction);
  plumb_shape shapes[4];
  EXPECT_EQ(plumb_overlap_box(world, {2, 0.2}, {4, 2}, nullptr, shapes, 4), 1u);
  EXPECT_EQ(plumb_shapes_at(world, {3, 0.5}, nullptr, shapes, 4), 1u);
  plumb_nearest_hit near;
  ASSERT_TRUE(plumb_nearest(world, {3, 5}, 10, nullptr, &near));
  EXPECT_NEAR(near.distance, 4, 1e-6);

  const plumb_geometry capsule = plumb_capsule({0, 0.3}, {0, 1}, 0.3);
  const plumb_mover_result moved = plumb_move(world, &capsule, {0, 0.1}, {5, -1}, kDt, nullptr, nullptr, 0);
  const plumb::MoverResult want =
      plumb::move(cpp, plumb::Capsule{{0, 0.3}, {0, 1}, 0.3}, {0, 0.1}, {5, -1}, kDt);
  EXPECT_EQ(moved.position.x, want.position.x);
  EXPECT_EQ(moved.position.y, want.position.y);
  EXPECT_EQ(moved.on_ground, want.on_ground);
}

TEST_F(C, RestoresASnapshotAndRefusesOthers) {
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  box(PLUMB_DYNAMIC, {0, 3}, 1, 1);
  for (int i = 0; i < 30; ++i) plumb_world_step(world, kDt, 4);
  std::vector<char> bytes(plumb_world_save(world, nullptr, 0));
  ASSERT_EQ(plumb_world_save(world, bytes.data(), bytes.size()), bytes.size());
  for (int i = 0; i < 60; ++i) plumb_world_step(world, kDt, 4);
  const uint64_t end = plumb_world_full_hash(world);
  ASSERT_EQ(plumb_world_restore(world, bytes.data(), bytes.size()), PLUMB_OK);
  for (int i = 0; i < 60; ++i) plumb_world_step(world, kDt, 4);
  EXPECT_EQ(plumb_world_full_hash(world), end);
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_EQ(plumb_world_restore(world, bytes.data(), bytes.size()), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().subject, "snapshot");
  EXPECT_EQ(plumb_world_full_hash(world), end);
}

TEST_F(C, ARecordedWorldReplays) {
  const std::string file = ::testing::TempDir() + "c_interface.recording";
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  EXPECT_EQ(plumb_world_record(world, "/no/such/folder/x", true), PLUMB_IO);
  EXPECT_EQ(plumb_world_counts(world).bodies, 1) << "a refusal leaves the world as it was";
  ASSERT_EQ(plumb_world_record(world, file.c_str(), true), PLUMB_OK);
  const plumb_body falls = box(PLUMB_DYNAMIC, {0, 3}, 1, 1);
  plumb_body_set_velocity(world, falls, {1, 0});
  for (int i = 0; i < 30; ++i) plumb_world_step(world, kDt, 4);
  const uint64_t hash = plumb_world_hash(world);
  plumb_replay_report report;
  ASSERT_EQ(plumb_replay(file.c_str(), PLUMB_FLOAT, &report), PLUMB_OK);
  EXPECT_EQ(report.steps, 30);
  EXPECT_EQ(report.first_difference, -1);
  EXPECT_EQ(report.hash, hash);
  std::remove(file.c_str());
}

constexpr const char* kScene = R"({"name": "fall", "bodies": [{"name": "ball", "position": [0, 10], "mass": 1,
  "shapes": [{"type": "circle", "radius": 0.5}]}]})";

TEST_F(C, RunsScenesToATolerance) {
  for (const plumb_accuracy accuracy : {plumb_default_realtime(), plumb_default_precise()}) {
    plumb_simulation* simulation = plumb_simulation_create(kScene, &accuracy);
    ASSERT_NE(simulation, nullptr) << plumb_last_error().message;
    EXPECT_EQ(plumb_simulation_find(simulation, "ball"), 0);
    EXPECT_EQ(plumb_simulation_step(simulation, 60), PLUMB_OK);
    // y = 10 - g t^2 / 2 after one second.
    EXPECT_NEAR(plumb_simulation_state(simulation, 0).position.y, 10 - 9.81 / 2, 1e-12);
    EXPECT_EQ(plumb_simulation_find(simulation, "cube"), -1);
    EXPECT_EQ(plumb_last_error().status, PLUMB_NAME);
    plumb_simulation_destroy(simulation);
  }
  EXPECT_EQ(plumb_simulation_create("{\"bodies\": 3}", nullptr), nullptr);
  EXPECT_EQ(plumb_last_error().status, PLUMB_SYNTAX);
  plumb_body body;
  EXPECT_EQ(plumb_world_add_scene(world, kScene, &body, 1), 1u);
  EXPECT_EQ(plumb_body_position(world, body).y, 10);
}

TEST_F(C, HooksDisableContacts) {
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  plumb_body_definition body = plumb_default_body();
  body.position = {0, 0.5};
  plumb_shape_definition shape = plumb_default_shape();
  shape.geometry = plumb_box(1, 1);
  shape.pre_solve = true;
  const plumb_body falls = plumb_body_create(world, &body, &shape, 1);
  int calls = 0;
  plumb_world_on_pre_solve(
      world,
      [](const plumb_contact* contact, void* context) {
        ++*static_cast<int*>(context);
        return contact->count == 0;
      },
      &calls);
  for (int i = 0; i < 60; ++i) plumb_world_step(world, kDt, 4);
  EXPECT_GT(calls, 0);
  EXPECT_LT(plumb_body_position(world, falls).y, -2);
}

TEST_F(C, GamesSetTheirOwnRules) {
  const plumb_body ground = box(PLUMB_STATIC, {0, -1}, 40, 2);
  plumb_shape_definition shape = plumb_default_shape();
  EXPECT_EQ(shape.filter.mask, ~uint64_t{0});
  shape.geometry = plumb_box(1, 1);
  shape.hit_events = true;
  plumb_body_definition body = plumb_default_body();
  EXPECT_TRUE(body.continuous);
  body.position = {0, 1.5};
  const plumb_body solid = plumb_body_create(world, &body, &shape, 1);
  body.position = {3, 1.5};
  shape.filter.category = uint64_t{1} << 40;
  const plumb_body ghost = plumb_body_create(world, &body, &shape, 1);
  plumb_world_on_filter(
      world,
      [](plumb_shape a, plumb_shape b, void* context) {
        const auto* w = static_cast<const plumb_world*>(context);
        return (plumb_shape_filter(w, a).category | plumb_shape_filter(w, b).category) < (uint64_t{1} << 40);
      },
      world);
  plumb_joint_definition rope = plumb_default_joint(PLUMB_DISTANCE);
  rope.anchor_a = {-9, 9};
  rope.report_force = 5;
  body.position = {-9, 7};
  const plumb_body lamp = plumb_body_create(world, &body, &shape, 1);
  const plumb_joint joint = plumb_joint_create(world, ground, lamp, &rope);
  double hit = 0;
  size_t loaded = 0;
  for (int i = 0; i < 90; ++i) {
    plumb_world_step(world, kDt, 4);
    const plumb_events events = plumb_world_events(world);
    for (size_t k = 0; k < events.hit_count; ++k) hit += events.hits[k].impulse;
    for (size_t k = 0; k < events.loaded_count; ++k)
      loaded += events.loaded[k].joint.index == joint.index && events.loaded[k].force > 5;
  }
  // It fell 1 m with 1 kg.
  EXPECT_NEAR(hit, std::sqrt(2 * 9.81), 0.5);
  EXPECT_GT(loaded, 0u);
  EXPECT_NEAR(plumb_body_position(world, solid).y, 0.5, 0.01);
  EXPECT_LT(plumb_body_position(world, ghost).y, -3);
  plumb_contact contact;
  EXPECT_EQ(plumb_body_contacts(world, solid, &contact, 1), 1u);
  EXPECT_NEAR(contact.step_impulse, 9.81 * kDt, 1e-3);

  EXPECT_EQ(plumb_joint_get_definition(world, joint).report_force, 5);
  EXPECT_EQ(plumb_joint_set_load_events(world, joint, 0, 0), PLUMB_OK);
  EXPECT_EQ(plumb_body_set_continuous(world, solid, false), PLUMB_OK);
  EXPECT_FALSE(plumb_body_continuous(world, solid));
  EXPECT_EQ(plumb_world_get_thresholds(world).hit, -1);
  EXPECT_EQ(plumb_world_set_thresholds(world, {2, 3, 4}), PLUMB_OK);
  EXPECT_EQ(plumb_world_get_thresholds(world).sleep, 4);
  EXPECT_EQ(plumb_world_set_thresholds(world, {NAN, 3, 4}), PLUMB_VALUE);
  plumb_world_definition settings = plumb_default_world();
  settings.thresholds = {7, 8, 9};
  plumb_world* other = plumb_world_create(&settings);
  EXPECT_EQ(plumb_world_get_thresholds(other).bounce, 8);
  plumb_world_destroy(other);
  plumb_clear_error();
}

}  // namespace
