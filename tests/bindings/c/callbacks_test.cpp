// Callbacks of the C interface may read the world; whatever would change or end it is refused.
#include <gmock/gmock.h>

#include <cstdio>
#include <string>

#include "tests/bindings/c/fixture.h"

namespace {

using plumb::tests::C;
using plumb::tests::kDt;
using ::testing::HasSubstr;

std::string recording_file() { return ::testing::TempDir() + "callbacks_test.plumbrec"; }

/// Refused calls of a callback. Combine rules have no context, so it is a static one.
struct Refusals {
  plumb_world* world = nullptr;
  int calls = 0;
};
Refusals now;

void refuse_all() {
  ++now.calls;
  plumb_world* const world = now.world;
  const int bodies = plumb_world_counts(world).bodies;
  plumb_clear_error();
  plumb_world_destroy(world);
  EXPECT_EQ(plumb_last_error().status, PLUMB_UNSUPPORTED);
  EXPECT_EQ(plumb_world_record(world, recording_file().c_str(), true), PLUMB_UNSUPPORTED);
  const plumb_body_definition body = plumb_default_body();
  EXPECT_EQ(plumb_body_create(world, &body, nullptr, 0).index, PLUMB_NO_INDEX);
  EXPECT_EQ(plumb_world_step(world, kDt, 4), PLUMB_UNSUPPORTED);
  EXPECT_EQ(plumb_world_set_gravity(world, {0, 0}), PLUMB_UNSUPPORTED);
  EXPECT_EQ(plumb_world_counts(world).bodies, bodies);
  plumb_clear_error();
}

class Callbacks : public C {
 protected:
  Callbacks() {
    std::remove(recording_file().c_str());
    plumb_shape_definition shape = plumb_default_shape();
    shape.geometry = plumb_box(2, 2);
    shape.pre_solve = true;
    const plumb_body_definition body = plumb_default_body();
    plumb_body_create(world, &body, &shape, 1);
    plumb_body_definition other = body;
    other.position.x = 1.9;
    moved = plumb_body_create(world, &other, &shape, 1);
    now = {world, 0};
  }
  /// Each callback was called, the world lives on, and nothing was recorded.
  void expect_unharmed() {
    EXPECT_GT(now.calls, 0);
    EXPECT_EQ(plumb_world_step(world, kDt, 4), PLUMB_OK);
    EXPECT_EQ(plumb_world_counts(world).bodies, 2);
    std::FILE* file = std::fopen(recording_file().c_str(), "rb");
    EXPECT_EQ(file, nullptr) << "a recording was begun";
    if (file != nullptr) std::fclose(file);
  }
  plumb_body moved{};
};

TEST_F(Callbacks, OfTheFilterCannotChangeOrEndTheWorld) {
  plumb_world_on_filter(
      world,
      [](plumb_shape, plumb_shape, void*) {
        refuse_all();
        return true;
      },
      nullptr);
  EXPECT_EQ(plumb_world_step(world, kDt, 4), PLUMB_OK);
  expect_unharmed();
}
TEST_F(Callbacks, OfPreSolveCannotChangeOrEndTheWorld) {
  plumb_world_on_pre_solve(
      world,
      [](const plumb_contact*, void*) {
        refuse_all();
        return true;
      },
      nullptr);
  EXPECT_EQ(plumb_world_step(world, kDt, 4), PLUMB_OK);
  expect_unharmed();
}
TEST_F(Callbacks, OfCombineRulesCannotChangeOrEndTheWorldInAStepOrBetween) {
  const plumb_combine_function rule = [](double, double) {
    refuse_all();
    return 0.5;
  };
  EXPECT_EQ(plumb_world_combine_with(world, rule, rule), PLUMB_OK);
  EXPECT_EQ(plumb_world_step(world, kDt, 4), PLUMB_OK);
  expect_unharmed();
  const int calls = now.calls;
  plumb_shape shape;
  plumb_body_shapes(world, moved, &shape, 1);
  EXPECT_EQ(plumb_shape_set_material(world, shape, plumb_default_shape().material), PLUMB_OK);
  EXPECT_GT(now.calls, calls);
  expect_unharmed();
}
TEST_F(Callbacks, OfALawCannotChangeOrEndTheWorld) {
  const plumb_law_function law = [](const plumb_law_body*, void*) {
    refuse_all();
    return plumb_wrench{};
  };
  EXPECT_EQ(plumb_world_apply_law(world, law, nullptr, kDt, false), PLUMB_OK);
  expect_unharmed();
}
TEST_F(Callbacks, OfQueriesCannotChangeOrEndTheWorld) {
  plumb_query_filter filter = plumb_default_query_filter();
  filter.condition = [](plumb_shape, void*) {
    refuse_all();
    return true;
  };
  plumb_ray_hit hit;
  EXPECT_TRUE(plumb_ray_cast_closest(world, {-9, 0}, {20, 0}, &filter, &hit));
  const int calls = now.calls;
  EXPECT_EQ(plumb_ray_cast(
                world, {-9, 0}, {20, 0}, nullptr,
                [](const plumb_ray_hit*, void*) {
                  refuse_all();
                  return 1.0;
                },
                nullptr),
            PLUMB_OK);
  EXPECT_GT(now.calls, calls);
  expect_unharmed();
}
TEST_F(Callbacks, OfDrawingCannotChangeOrEndTheWorld) {
  plumb_debug_draw draw{};
  draw.polygon = [](const plumb_vec2*, size_t, double, plumb_draw_role, void*) { refuse_all(); };
  EXPECT_EQ(plumb_world_draw(world, &draw, nullptr), PLUMB_OK);
  EXPECT_EQ(now.calls, 2);
  plumb_past_poses* past = plumb_past_poses_create();
  plumb_past_poses_keep(past, world);
  EXPECT_EQ(plumb_world_draw_between(world, past, 0.5, &draw, nullptr), PLUMB_OK);
  EXPECT_EQ(now.calls, 4);
  plumb_past_poses_destroy(past);
  expect_unharmed();
}
// Poses that are drawn, and how often functions that draw were refused to change them.
struct Posed {
  plumb_past_poses* past;
  plumb_world* world;
  int refusals = 0;
};
TEST_F(Callbacks, OfDrawingCannotEndOrReplaceThePosesThatAreDrawn) {
  Posed posed{plumb_past_poses_create(), world};
  plumb_debug_draw draw{};
  draw.context = &posed;
  draw.polygon = [](const plumb_vec2*, size_t, double, plumb_draw_role, void* context) {
    Posed& p = *static_cast<Posed*>(context);
    plumb_past_poses_destroy(p.past);
    p.refusals += plumb_last_error().status == PLUMB_UNSUPPORTED ? 1 : 0;
    p.refusals += plumb_past_poses_keep(p.past, p.world) == PLUMB_UNSUPPORTED ? 1 : 0;
    plumb_clear_error();
    plumb_pose pose;
    EXPECT_GT(plumb_past_poses_between(p.past, p.world, 0.5, &pose, 1), 0u) << "reading is allowed";
    plumb_past_poses* other = plumb_past_poses_create();
    EXPECT_EQ(plumb_past_poses_keep(other, p.world), PLUMB_OK);
    plumb_past_poses_destroy(other);
    EXPECT_EQ(plumb_last_error().status, PLUMB_OK);
  };
  EXPECT_EQ(plumb_world_draw_between(world, posed.past, 0.5, &draw, nullptr), PLUMB_OK);
  EXPECT_EQ(posed.refusals, 4) << "nothing was kept yet";
  EXPECT_EQ(plumb_past_poses_keep(posed.past, world), PLUMB_OK);
  EXPECT_EQ(plumb_world_draw_between(world, posed.past, 0.5, &draw, nullptr), PLUMB_OK);
  EXPECT_EQ(posed.refusals, 8);
  EXPECT_EQ(plumb_past_poses_keep(posed.past, world), PLUMB_OK);
  plumb_past_poses_destroy(posed.past);
  EXPECT_EQ(plumb_last_error().status, PLUMB_OK);
}
TEST_F(Callbacks, MayEndAnotherWorld) {
  plumb_world* other = plumb_world_create(nullptr);
  plumb_clear_error();
  const plumb_law_function law = [](const plumb_law_body*, void* context) {
    auto** const gone = static_cast<plumb_world**>(context);
    plumb_world_destroy(*gone);
    *gone = nullptr;
    return plumb_wrench{};
  };
  EXPECT_EQ(plumb_world_apply_law(world, law, &other, kDt, false), PLUMB_OK);
  EXPECT_EQ(plumb_last_error().status, PLUMB_OK);
}
TEST_F(C, RecordedWorldsAreNotEndedWithinTheirCallbacks) {
  box(PLUMB_DYNAMIC, {0, 0}, 1, 1);
  ASSERT_EQ(plumb_world_record(world, recording_file().c_str(), false), PLUMB_OK);
  const plumb_law_function law = [](const plumb_law_body*, void* context) {
    plumb_world_destroy(static_cast<plumb_world*>(context));
    EXPECT_EQ(plumb_last_error().status, PLUMB_UNSUPPORTED);
    return plumb_wrench{};
  };
  EXPECT_EQ(plumb_world_apply_law(world, law, world, kDt, false), PLUMB_OK);
  EXPECT_EQ(plumb_world_step(world, kDt, 4), PLUMB_OK);
  plumb_replay_report report;
  EXPECT_EQ(plumb_replay(recording_file().c_str(), PLUMB_FLOAT, &report), PLUMB_OK);
  EXPECT_EQ(report.hash, report.recorded_hash);
  EXPECT_EQ(report.hash, plumb_world_hash(world));
  std::remove(recording_file().c_str());
}
TEST_F(C, CombineRulesAreQuotedWithAllTheirDigits) {
  box(PLUMB_DYNAMIC, {0, 0}, 1, 1), box(PLUMB_DYNAMIC, {0.9, 0}, 1, 1);
  plumb_world_combine_with(
      world, [](double, double) { return -1.25e-9; }, nullptr);
  EXPECT_EQ(plumb_world_step(world, kDt, 4), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().value, "-1.25e-09");
  EXPECT_THAT(plumb_last_error().message, HasSubstr("[0, 1e+09]"));
}

}  // namespace
