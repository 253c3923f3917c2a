// States in memory, recordings with a hook, the monitor and the settings of the C interface.
#include "engine/world/rollback.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "engine/world/state_hash.h"
#include "tests/bindings/c/fixture.h"

namespace {

using plumb::tests::C;
using plumb::tests::kDt;
using ::testing::HasSubstr;

TEST_F(C, RollsBackAndTakesALateInput) {
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  const plumb_body player = box(PLUMB_DYNAMIC, {0, 3}, 1, 1);
  plumb_rollback* rollback = plumb_rollback_create(world, 8);
  ASSERT_NE(rollback, nullptr);
  EXPECT_EQ(plumb_rollback_oldest(rollback), -1);
  std::vector<uint64_t> hashes;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(plumb_rollback_save(rollback), PLUMB_OK);
    hashes.push_back(plumb_world_full_hash(world));
    plumb_world_step(world, kDt, 4);
  }
  EXPECT_EQ(plumb_rollback_size(rollback), 8);
  EXPECT_EQ(plumb_rollback_oldest(rollback), 12);
  EXPECT_EQ(plumb_rollback_latest(rollback), 19);
  EXPECT_TRUE(plumb_rollback_holds(rollback, 14));
  const uint64_t end = plumb_world_full_hash(world);

  EXPECT_EQ(plumb_rollback_back_to(rollback, 3), PLUMB_VALUE);
  EXPECT_THAT(plumb_last_error().message, HasSubstr("3"));
  EXPECT_EQ(plumb_world_full_hash(world), end);
  ASSERT_EQ(plumb_rollback_back_to(rollback, 14), PLUMB_OK);
  EXPECT_EQ(plumb_world_full_hash(world), hashes[14]);
  EXPECT_EQ(plumb_world_step_count(world), 14);
  EXPECT_FALSE(plumb_rollback_holds(rollback, 15));
  for (int i = 14; i < 20; ++i) plumb_world_step(world, kDt, 4);
  EXPECT_EQ(plumb_world_full_hash(world), end);

  ASSERT_EQ(plumb_rollback_back_to(rollback, 14), PLUMB_OK);
  plumb_body_apply_impulse(world, player, {2, 0});  // the input that came late
  for (int i = 14; i < 20; ++i) plumb_world_step(world, kDt, 4);
  EXPECT_NEAR(plumb_body_position(world, player).x, 2 * 6 * kDt, 1e-5);
  plumb_rollback_destroy(rollback);

  EXPECT_EQ(plumb_rollback_create(world, 0), nullptr);
  EXPECT_STREQ(plumb_last_error().field, "frames");
  EXPECT_EQ(plumb_rollback_save(nullptr), PLUMB_VALUE);
}

TEST_F(C, ARecordedWorldRollsBackAndReplays) {
  const std::string file = ::testing::TempDir() + "c_rollback.recording";
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  box(PLUMB_DYNAMIC, {0, 3}, 1, 1);
  plumb_rollback* early = plumb_rollback_create(world, 2);
  plumb_monitor* watch = plumb_monitor_create(world, nullptr);
  ASSERT_EQ(plumb_world_record(world, file.c_str(), true), PLUMB_OK);
  // Recording has moved the world away from under them.
  EXPECT_EQ(plumb_rollback_save(early), PLUMB_UNSUPPORTED);
  EXPECT_THAT(plumb_last_error().message, HasSubstr("plumb_world_record"));
  EXPECT_EQ(plumb_monitor_begin_step(watch), PLUMB_UNSUPPORTED);
  plumb_rollback_destroy(early);
  plumb_monitor_destroy(watch);

  plumb_rollback* rollback = plumb_rollback_create(world, 4);
  plumb_rollback_save(rollback);
  for (int i = 0; i < 10; ++i) plumb_world_step(world, kDt, 4);
  ASSERT_EQ(plumb_rollback_back_to(rollback, 0), PLUMB_OK);
  plumb_wind wind = plumb_default_wind();
  wind.velocity = {5, 0};
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(plumb_world_apply_wind(world, &wind, kDt, false), PLUMB_OK);
    plumb_world_step(world, kDt, 4);
  }
  const uint64_t hash = plumb_world_hash(world);
  plumb_rollback_destroy(rollback);
  plumb_replay_report report;
  ASSERT_EQ(plumb_replay(file.c_str(), PLUMB_FLOAT, &report), PLUMB_OK);
  EXPECT_EQ(report.steps, 30);
  EXPECT_EQ(report.first_difference, -1) << report.message;
  EXPECT_EQ(report.hash, hash);
  EXPECT_STREQ(report.message, "");
  EXPECT_EQ(report.difference_count, 0u);
  std::remove(file.c_str());
}

TEST_F(C, AReplayNeedsTheHookThatTheWorldHad) {
  const std::string file = ::testing::TempDir() + "c_hook.recording";
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  plumb_body_definition body = plumb_default_body();
  body.position = {0, 0.5};
  plumb_shape_definition shape = plumb_default_shape();
  shape.geometry = plumb_box(1, 1);
  shape.pre_solve = true;
  const plumb_body ghost = plumb_body_create(world, &body, &shape, 1);
  plumb_world_record(world, file.c_str(), true);
  const plumb_pre_solve_function never = [](const plumb_contact*, void*) { return false; };
  plumb_world_on_pre_solve(world, never, nullptr);
  for (int i = 0; i < 30; ++i) plumb_world_step(world, kDt, 4);
  plumb_replay_report report;
  plumb_body differing{};
  ASSERT_EQ(plumb_replay_with(file.c_str(), PLUMB_FLOAT, never, nullptr, &report, &differing, 1), PLUMB_OK);
  EXPECT_EQ(report.first_difference, -1);
  ASSERT_EQ(plumb_replay_with(file.c_str(), PLUMB_FLOAT, nullptr, nullptr, &report, &differing, 1), PLUMB_OK);
  EXPECT_GT(report.first_difference, 0);
  EXPECT_THAT(report.message, HasSubstr("hook"));
  ASSERT_EQ(report.difference_count, 1u);
  EXPECT_EQ(differing.index, ghost.index);
  std::remove(file.c_str());
}

TEST_F(C, TheMonitorNamesTheBoundThatIsMissed) {
  box(PLUMB_STATIC, {0, -1}, 40, 2);
  const plumb_body falls = box(PLUMB_DYNAMIC, {0, 1}, 1, 1);
  const auto run = [&](const plumb_monitor_bounds* bounds) {
    plumb_monitor* monitor = plumb_monitor_create(world, bounds);
    EXPECT_NE(monitor, nullptr);
    plumb_status status = PLUMB_OK;
    for (int i = 0; i < 60 && status == PLUMB_OK; ++i) {
      EXPECT_EQ(plumb_monitor_begin_step(monitor), PLUMB_OK);
      plumb_world_step(world, kDt, 4);
      status = plumb_monitor_end_step(monitor);
    }
    EXPECT_EQ(plumb_monitor_reset(monitor), PLUMB_OK);
    plumb_monitor_destroy(monitor);
    return status;
  };
  EXPECT_EQ(run(nullptr), PLUMB_OK) << plumb_last_error().message;
  plumb_body_set_pose(world, falls, {{0, 1}, 0});
  plumb_monitor_bounds strict = plumb_default_monitor();
  strict.overlap = 1e-9;  // a resting box overlaps by more
  strict.lasting = 1;
  EXPECT_EQ(run(&strict), PLUMB_RUN);
  EXPECT_THAT(plumb_last_error().message, HasSubstr("overlap"));
}

TEST_F(C, TheMonitorRefusesBoundsThatNothingMeetsAndStepsThatWereNotBegun) {
  for (double plumb_monitor_bounds::*bound :
       {&plumb_monitor_bounds::joint_gap, &plumb_monitor_bounds::overlap, &plumb_monitor_bounds::energy}) {
    for (const double value : {-1.0, std::nan("")}) {
      plumb_monitor_bounds bounds = plumb_default_monitor();
      bounds.*bound = value;
      EXPECT_EQ(plumb_monitor_create(world, &bounds), nullptr) << value;
      EXPECT_EQ(plumb_last_error().status, PLUMB_VALUE);
    }
  }
  plumb_monitor_bounds bounds = plumb_default_monitor();
  bounds.lasting = 0;
  EXPECT_EQ(plumb_monitor_create(world, &bounds), nullptr);
  EXPECT_STREQ(plumb_last_error().field, "lasting");

  plumb_monitor* monitor = plumb_monitor_create(world, nullptr);
  EXPECT_EQ(plumb_monitor_end_step(monitor), PLUMB_UNSUPPORTED);
  EXPECT_EQ(plumb_monitor_begin_step(monitor), PLUMB_OK);
  plumb_world_step(world, kDt, 4);
  EXPECT_EQ(plumb_monitor_end_step(monitor), PLUMB_OK);
  EXPECT_EQ(plumb_monitor_end_step(monitor), PLUMB_UNSUPPORTED);
  plumb_monitor_destroy(monitor);
}

TEST_F(C, SettingsAndStatesReadBack) {
  plumb_world_definition given = plumb_default_world();
  given.precision = PLUMB_DOUBLE;
  given.gravity = {1, 2};
  given.solver = PLUMB_XPBD;
  given.combine_restitution = PLUMB_AVERAGE;
  given.threads = 2;
  plumb_world_destroy(world);
  world = plumb_world_create(&given);
  plumb_world_set_iterations(world, 7);
  plumb_world_set_sleeping(world, false);
  plumb_world_set_continuous(world, false);
  plumb_world_set_direct_islands(world, false);
  plumb_world_set_quarantine(world, false);
  const plumb_world_definition now = plumb_world_get_definition(world);
  EXPECT_EQ(now.precision, PLUMB_DOUBLE);
  EXPECT_EQ(now.gravity.y, 2);
  EXPECT_EQ(now.solver, PLUMB_XPBD);
  EXPECT_EQ(now.combine_restitution, PLUMB_AVERAGE);
  EXPECT_EQ(now.iterations, 7);
  EXPECT_EQ(now.threads, 2);
  EXPECT_FALSE(now.sleeping || now.continuous || now.direct_islands || now.quarantine);

  plumb_body_definition body = plumb_default_body();
  body.position = {1, 2}, body.angle = 0.5, body.velocity = {3, 4}, body.angular_velocity = 5;
  body.lock_y = true, body.may_sleep = false;
  plumb_shape_definition shape = plumb_default_shape();
  shape.position = {1, 0};  // so that the centre of mass is not at the origin
  shape.hit_events = true;
  const plumb_body made = plumb_body_create(world, &body, &shape, 1);
  const plumb_locks locks = plumb_body_locks(world, made);
  EXPECT_TRUE(locks.y && !locks.x && !locks.rotation);
  EXPECT_FALSE(plumb_body_may_sleep(world, made));
  plumb_body_state state;
  ASSERT_EQ(plumb_world_states(world, &state, 1), 1u);
  EXPECT_EQ(state.position.x, plumb_body_centre(world, made).x);
  EXPECT_EQ(state.angular_velocity, 5);
  EXPECT_EQ(plumb_body_get_state(world, made).velocity.x, state.velocity.x);
  plumb_shape first;
  plumb_body_shapes(world, made, &first, 1);
  EXPECT_TRUE(plumb_shape_hit_events(world, first));
  EXPECT_FALSE(plumb_shape_pre_solve(world, first));

  const plumb_vec2 points[] = {{3, 0}, {0, 0}, {-3, 1}};
  plumb_chain_definition line = plumb_default_chain();
  line.points = points, line.point_count = 3, line.user_data = 6, line.material.friction = 0.25;
  const plumb_chain chain = plumb_chain_create(world, made, &line);
  const plumb_chain_definition back = plumb_chain_get_definition(world, chain);
  ASSERT_EQ(back.point_count, 3u);
  EXPECT_EQ(back.points[2].x, -3);
  EXPECT_EQ(back.user_data, 6u);
  EXPECT_EQ(back.material.friction, 0.25);
  EXPECT_FALSE(back.closed);
  EXPECT_EQ(plumb_last_error().status, PLUMB_OK) << plumb_last_error().message;
}

TEST_F(C, ThreadsAndAJobSystemChangeNoBit) {
  const auto hash_with = [&](auto&& prepare) {
    plumb_world_destroy(world);
    world = plumb_world_create(nullptr);
    prepare();
    box(PLUMB_STATIC, {0, -1}, 400, 2);
    for (int i = 0; i < 600; ++i) box(PLUMB_DYNAMIC, {-40 + 1.3 * (i % 60), 1 + 1.2 * (i / 60)}, 1, 1);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(plumb_world_step(world, kDt, 4), PLUMB_OK);
    return plumb_world_full_hash(world);
  };
  const uint64_t alone = hash_with([] {});
  EXPECT_EQ(hash_with([&] { EXPECT_EQ(plumb_world_set_threads(world, 2), PLUMB_OK); }), alone);
  int started = 0;
  const plumb_task_system tasks{[](void* user, plumb_task task, void* data, int count) -> void* {
                                  ++*static_cast<int*>(user);
                                  for (int i = 0; i < count; ++i) task(data, i);
                                  return nullptr;
                                },
                                [](void*, void*) {}, &started};
  EXPECT_EQ(hash_with([&] {
              plumb_world_set_threads(world, 2);
              EXPECT_EQ(plumb_world_set_task_system(world, &tasks), PLUMB_OK);
            }),
            alone);
  EXPECT_GT(started, 0);
  EXPECT_EQ(plumb_world_set_task_system(world, nullptr), PLUMB_OK);
  plumb_task_system half = tasks;
  half.finish = nullptr;
  EXPECT_EQ(plumb_world_set_task_system(world, &half), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().subject, "finish");
  EXPECT_EQ(plumb_world_set_threads(world, 65), PLUMB_VALUE);
  EXPECT_THAT(plumb_last_error().message, HasSubstr("65"));
}

}  // namespace
