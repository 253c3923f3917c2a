// Whatever a call could change is awake: each call of World on what sleeps acts as on a twin that is awake.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <regex>
#include <set>

#include "engine/scene/error.h"
#include "engine/world/force_laws.h"
#include "engine/world/queries.h"
#include "engine/world/snapshot.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

/// Sleepers on, beside and under bodies of every type, and one far away on the same ground.
struct Ids {
  BodyId ground, lift, box, top, rider, hung, a, b, on_chain, far, wall;
  ShapeId tile, sensor;
  ChainId chain;
  JointId hinge, rod;
};

template <class Real>
Ids lay_to_sleep(BasicWorld<Real>& world) {
  Ids s;
  const auto body = [&](Vec2d at, double size) {
    return world.create_body({.position = at}, ShapeDefinition{.geometry = Box{size, size}});
  };
  s.ground = world.create_body({.type = BodyType::Static});
  s.tile = world.create_shape(s.ground, {.geometry = Box{4, 1}, .position = {0, -0.5}});
  world.create_shape(s.ground, {.geometry = Box{4, 1}, .position = {40, -0.5}});
  world.create_shape(s.ground, {.geometry = Box{6, 1}, .position = {10, -0.5}});
  s.chain = world.create_chain(s.ground, {.points = {{22, 0}, {18, 0}}});
  s.lift = world.create_body({.type = BodyType::Kinematic, .position = {-10, 0}},
                             ShapeDefinition{.geometry = Box{3, 0.5}});
  s.wall = world.create_body({.type = BodyType::Static, .position = {0, 30}},
                             ShapeDefinition{.geometry = Box{1, 1}});
  s.box = body({0, 0.5}, 1), s.top = body({0, 1.4}, 0.8);
  s.rider = body({-10, 0.75}, 1);
  s.hung = body({-20, 4}, 1);
  s.hinge = world.create_joint(s.ground, s.hung,
                               {.kind = RevoluteDefinition{.anchor_a = {-20, 6}, .anchor_b = {0, 2}}});
  s.a = body({9, 0.5}, 1), s.b = body({11, 0.5}, 1);
  s.rod = world.create_joint(s.a, s.b, {.kind = DistanceDefinition{.length = 2}});
  s.on_chain = body({20, 0.5}, 1);
  s.far = body({40, 0.5}, 1);
  s.sensor = world.create_shape(s.ground, {.geometry = Box{1, 1}, .position = {0, 60}, .sensor = true});
  for (int i = 0; i < 300 && world.counts().awake > 0; ++i) world.step();
  return s;
}

template <class Real>
using Call = std::function<void(BasicWorld<Real>&, const Ids&)>;

template <class Real>
struct Row {
  std::string call;
  Call<Real> run;
  bool far_wakes = false;  ///< it acts on all
};

/// Changes that can be made to a body.
template <class Real>
std::vector<Row<Real>> rows_of_body(BodyId Ids::*who, bool dynamic) {
  using W = BasicWorld<Real>;
  using S = const Ids;
  const auto at = [who](W& w, S& s, Vec2d by) { return w.position(s.*who) + by; };
  std::vector<Row<Real>> rows = {
      {"set_position",
       [=](W& w, S& s) {
         w.set_position(s.*who, at(w, s, {0.1, 0.3}), 0);
       }},
      {"set_velocity",
       [=](W& w, S& s) {
         w.set_velocity(s.*who, {0.3, 0.4});
       }},
      {"set_angular_velocity", [=](W& w, S& s) { w.set_angular_velocity(s.*who, 0.5); }},
      {"move_towards",
       [=](W& w, S& s) {
         w.move_towards(s.*who, at(w, s, {0.2, 0.1}), 0.1, 1);
       }},
      {"apply_force",
       [=](W& w, S& s) {
         w.apply_force(s.*who, {900, 0});
       }},
      {"apply_force",
       [=](W& w, S& s) {
         w.apply_force(s.*who, {900, 0}, at(w, s, {0, 0.2}));
       }},
      {"apply_torque", [=](W& w, S& s) { w.apply_torque(s.*who, 300); }},
      {"apply_impulse",
       [=](W& w, S& s) {
         w.apply_impulse(s.*who, {3, 0});
       }},
      {"apply_impulse",
       [=](W& w, S& s) {
         w.apply_impulse(s.*who, {3, 0}, at(w, s, {0, 0.2}));
       }},
      {"apply_angular_impulse", [=](W& w, S& s) { w.apply_angular_impulse(s.*who, 2); }},
      {"set_type", [=](W& w, S& s) { w.set_type(s.*who, BodyType::Static); }},
      {"set_type", [=](W& w, S& s) { w.set_type(s.*who, BodyType::Kinematic); }},
      {"set_type", [=](W& w, S& s) { w.set_type(s.*who, BodyType::Dynamic); }},
      {"set_mass",
       [=](W& w, S& s) {
         w.set_mass(s.*who, {.mass = 2, .centre = {0.9, 0}, .inertia = 0.3});
       }},
      {"use_densities", [=](W& w, S& s) { w.use_densities(s.*who); }},
      {"set_gravity_scale", [=](W& w, S& s) { w.set_gravity_scale(s.*who, -1); }},
      {"set_damping", [=](W& w, S& s) { w.set_damping(s.*who, 1, 1); }},
      {"set_locks", [=](W& w, S& s) { w.set_locks(s.*who, true, false, true); }},
      {"set_may_sleep", [=](W& w, S& s) { w.set_may_sleep(s.*who, false); }},
      {"set_awake", [=](W& w, S& s) { w.set_awake(s.*who, true); }},
      {"release", [=](W& w, S& s) { w.release(s.*who); }},
      {"set_user_data", [=](W& w, S& s) { w.set_user_data(s.*who, 5); }},
      {"set_continuous", [=](W& w, S& s) { w.set_continuous(s.*who, false); }},
      {"set_name", [=](W& w, S& s) { w.set_name(s.*who, "other"); }},
      {"set_enabled", [=](W& w, S& s) { w.set_enabled(s.*who, false); }},
      {"set_enabled",
       [=](W& w, S& s) {
         w.set_enabled(s.*who, false);
         w.set_enabled(s.*who, true);
       }},
      {"set_density", [=](W& w, S& s) { w.set_density(w.shapes(s.*who)[0], 5); }},
      {"set_sensor", [=](W& w, S& s) { w.set_sensor(w.shapes(s.*who)[0], true); }},
      {"set_hit_events", [=](W& w, S& s) { w.set_hit_events(w.shapes(s.*who)[0], true); }},
      {"set_pre_solve", [=](W& w, S& s) { w.set_pre_solve(w.shapes(s.*who)[0], true); }},
      {"destroy", [=](W& w, S& s) { w.destroy(s.*who); }},
      {"destroy", [=](W& w, S& s) { w.destroy(w.shapes(s.*who)[0]); }},
      {"create_shape",
       [=](W& w, S& s) {
         w.create_shape(s.*who, {.geometry = Box{1, 1}, .position = {1.2, 0.1}, .density = 9});
       }},
      {"create_chain",
       [=](W& w, S& s) {
         w.create_chain(s.*who, {.points = {{0.2, 0.7}, {-0.2, 0.7}}});
       }},
      {"set_material",
       [=](W& w, S& s) {
         const ShapeId shape = w.shapes(s.*who)[0];
         w.set_material(shape, {.friction = 1, .surface_speed = 1});
       }},
      {"set_filter", [=](W& w, S& s) { w.set_filter(w.shapes(s.*who)[0], {.mask = 0}); }},
      {"set_filter", [=](W& w, S& s) { w.set_filter(w.shapes(s.*who)[0], {.category = 2}); }},
      {"create_joint",
       [=](W& w, S& s) {
         w.create_joint(s.*who, s.far, {.kind = DistanceDefinition{.length = 1, .spring = Spring{0.05, 1}}});
       },
       true},
  };
  if (!dynamic) return rows;
  const JointDefinition pull{
      .kind = DistanceDefinition{.anchor_a = {0, 0}, .length = 0.5, .spring = Spring{0.05, 1}}};
  const std::vector<BodyId Ids::*> others = {&Ids::wall, &Ids::lift, &Ids::a};
  for (const auto other : others) {
    if (other == who) continue;
    rows.push_back({"create_joint", [=](W& w, S& s) { w.create_joint(s.*who, s.*other, pull); }});
    rows.push_back({"create_joint", [=](W& w, S& s) { w.create_joint(s.*other, s.*who, pull); }});
  }
  return rows;
}

template <class Real>
std::vector<Row<Real>> rows_of_world() {
  using W = BasicWorld<Real>;
  using S = const Ids;
  const ShapeDefinition block{.geometry = Box{1, 1}};
  return {
      {"step", [](W& w, S&) { w.step(); }},
      {"set_gravity",
       [](W& w, S&) {
         w.set_gravity({2, 4});
       },
       true},
      {"set_sleeping", [](W& w, S&) { w.set_sleeping(false); }, true},
      {"set_continuous", [](W& w, S&) { w.set_continuous(false); }},
      {"set_solver", [](W& w, S&) { w.set_solver(Solver::Xpbd); }, true},
      {"set_iterations", [](W& w, S&) { w.set_iterations(3); }, true},
      {"set_direct_islands", [](W& w, S&) { w.set_direct_islands(false); }, true},
      {"set_quarantine", [](W& w, S&) { w.set_quarantine(false); }},
      {"combine_with", [](W& w, S&) { w.combine_with(nullptr, nullptr); }},
      {"set_profiling", [](W& w, S&) { w.set_profiling(false); }},
      {"set_threads", [](W& w, S&) { w.set_threads(2); }},
      {"set_task_system", [](W& w, S&) { w.set_task_system({}); }},
      {"on_filter", [](W& w, S&) { w.on_filter([](ShapeId, ShapeId) { return false; }); }},
      {"set_thresholds", [](W& w, S&) { w.set_thresholds({.sleep = 0.01}); }, true},
      {"on_pre_solve", [](W& w, S&) { w.on_pre_solve([](const ContactReading&) { return false; }); }},
      {"create_body",
       [=](W& w, S&) {
         w.create_body({.type = BodyType::Static, .position = {0.9, 0.5}}, block);
       }},
      {"create_body",
       [=](W& w, S&) {
         w.create_body({.type = BodyType::Static, .position = {-10.9, 0.75}}, block);
       }},
      {"create_body",
       [=](W& w, S&) {
         std::vector<ShapeId> made;
         w.create_body({.type = BodyType::Kinematic, .position = {0.9, 0.5}}, std::vector{block}, made);
       }},
      {"create_body",
       [=](W& w, S&) {
         w.create_body({.position = {0.9, 0.5}}, block);
       }},
      {"set_position",
       [](W& w, S& s) {
         w.set_position(s.wall, {0.9, 0.5}, 0);
       }},
      {"set_position",
       [](W& w, S& s) {
         w.set_position(s.wall, {-20.9, 4}, 0);
       }},
      {"create_chain",
       [](W& w, S& s) {
         w.create_chain(s.ground, {.points = {{3, 0.3}, {-3, 0.3}}});
       }},
      {"create_shape",
       [=](W& w, S& s) {
         w.create_shape(s.ground, {.geometry = Box{1, 1}, .position = {0.9, 0.5}});
       }},
      {"destroy", [](W& w, S& s) { w.destroy(s.chain); }},
      {"destroy", [](W& w, S& s) { w.destroy(s.tile); }},
      {"destroy", [](W& w, S& s) { w.destroy(s.hinge); }},
      {"destroy", [](W& w, S& s) { w.destroy(s.rod); }},
      {"destroy", [](W& w, S& s) { w.destroy(s.sensor); }},
      {"set_filter", [](W& w, S& s) { w.set_filter(s.tile, {.mask = 0}); }},
      {"set_sensor", [](W& w, S& s) { w.set_sensor(s.tile, true); }},
      {"set_sensor", [](W& w, S& s) { w.set_sensor(s.sensor, false); }},
      {"set_material", [](W& w, S& s) { w.set_material(s.tile, {.friction = 1, .surface_speed = 1}); }},
      {"change",
       [](W& w, S& s) {
         RevoluteDefinition driven{.anchor_a = {-20, 6}, .anchor_b = {0, 2}};
         driven.motor = Motor{1, 1000};
         w.change(s.hinge, driven);
       }},
      {"change", [](W& w, S& s) { w.change(s.rod, DistanceDefinition{.length = 1.5}); }},
      {"set_load_events", [](W& w, S& s) { w.set_load_events(s.rod, 1, 1); }},
  };
}

template <class Real>
class Waking : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Waking, Reals);

template <class Real>
BasicWorld<Real> world_of(const std::vector<std::byte>& state) {
  BasicWorld<Real> world;
  restore(world, state);
  return world;
}

template <class Real>
void expect_like_awake_twin(const std::vector<std::byte>& asleep, const Ids& ids, const Row<Real>& row) {
  BasicWorld<Real> sleeping = world_of<Real>(asleep), twin = world_of<Real>(asleep);
  ASSERT_EQ(sleeping.counts().awake, 0);
  for (const BodyId body : twin.bodies()) twin.set_awake(body, true);
  try {
    row.run(twin, ids);
  } catch (const Error&) {  // a joint of two static bodies
    EXPECT_THROW(row.run(sleeping, ids), Error);
    return;
  }
  row.run(sleeping, ids);
  run(sleeping, 25), run(twin, 25);
  for (const BodyId body : twin.bodies()) {
    const Vec2d apart = sleeping.centre(body) - twin.centre(body);
    EXPECT_LT(std::abs(apart.x) + std::abs(apart.y), 0.02) << "body " << body.index;
    EXPECT_NEAR(sleeping.angle(body), twin.angle(body), 0.03) << "body " << body.index;
  }
  if (sleeping.valid(ids.far)) {
    EXPECT_EQ(sleeping.awake(ids.far), row.far_wakes);
  }
}

TYPED_TEST(Waking, EveryCallActsAsOnATwinThatIsAwake) {
  using Real = TypeParam;
  BasicWorld<Real> world;
  const Ids ids = lay_to_sleep(world);
  const std::vector<std::byte> asleep = save(world);
  for (const Row<Real>& row : rows_of_world<Real>()) {
    SCOPED_TRACE("world: " + row.call);
    expect_like_awake_twin(asleep, ids, row);
  }
  const std::pair<const char*, BodyId Ids::*> bodies[] = {
      {"box", &Ids::box},   {"top", &Ids::top}, {"lift", &Ids::lift}, {"rider", &Ids::rider},
      {"hung", &Ids::hung}, {"a", &Ids::a},     {"wall", &Ids::wall}, {"on_chain", &Ids::on_chain}};
  for (const auto& [name, body] : bodies) {
    const bool dynamic = world.type(ids.*body) == BodyType::Dynamic;
    for (const Row<Real>& row : rows_of_body<Real>(body, dynamic)) {
      SCOPED_TRACE(std::string(name) + ": " + row.call);
      expect_like_awake_twin(asleep, ids, row);
    }
  }
}

// Hooks are no part of snapshots.
TYPED_TEST(Waking, AHookThatIsSetIsAskedAboutWhatSleeps) {
  BasicWorld<TypeParam> world;
  world.create_body({.type = BodyType::Static},
                    ShapeDefinition{.geometry = Box{9, 1}, .position = {0, -0.5}, .pre_solve = true});
  const BodyId box = add_box(world, {0, 0.5});
  run(world, 60);
  ASSERT_FALSE(world.awake(box));
  world.on_pre_solve([](const ContactReading&) { return false; });
  run(world, 30);
  EXPECT_LT(world.position(box).y, 0);
}

// A kinematic body is no bridge: who is woken on it does not wake the others on it.
TYPED_TEST(Waking, WhatLiesOnAPlatformSleepsByItself) {
  BasicWorld<TypeParam> world;
  const BodyId lift =
      world.create_body({.type = BodyType::Kinematic}, ShapeDefinition{.geometry = Box{20, 1}});
  const BodyId left = add_box(world, {-5, 1}), right = add_box(world, {5, 1});
  run(world, 90);
  ASSERT_EQ(world.counts().awake, 0);
  world.apply_impulse(left, {0, 1});
  run(world, 20);
  EXPECT_FALSE(world.awake(right));
  EXPECT_NEAR(world.velocity(right).y, 0, 0);
  world.set_velocity(lift, {0, 1});
  EXPECT_TRUE(world.awake(left) && world.awake(right));
  run(world, 30);
  EXPECT_NEAR(world.position(right).y - world.position(lift).y, 1, 0.02);
}

template <class Real>
std::vector<Row<Real>> all_rows() {
  std::vector<Row<Real>> all = rows_of_world<Real>();
  for (Row<Real>& row : rows_of_body<Real>(&Ids::box, true)) all.push_back(std::move(row));
  const auto push = [](const LawBody&) -> Wrench<double> { return {{1, 0}, 0}; };
  all.push_back({"apply_law", [=](auto& w, const Ids&) { apply_law(w, push, {.wakes = true}); }});
  all.push_back({"apply_linear_drag", [](auto& w, const Ids&) { apply_linear_drag(w, {1, 1}, 0.1); }});
  all.push_back({"apply_quadratic_drag", [](auto& w, const Ids&) { apply_quadratic_drag(w, 1, 0.1); }});
  all.push_back({"apply_attraction", [](auto& w, const Ids&) { apply_attraction(w, {}, {}, 0.1); }});
  all.push_back({"apply_wind", [](auto& w, const Ids&) { apply_wind(w, {}, 0.1); }});
  all.push_back({"apply_water", [](auto& w, const Ids&) { apply_water(w, {}, 0.1); }});
  all.push_back({"apply_spring", [](auto& w, const Ids& s) {
                   apply_spring(w, s.box, {}, s.far, {}, {}, 0.1, {.wakes = true});
                 }});
  all.push_back({"explode", [](auto& w, const Ids&) { explode(w, {.radius = 3, .impulse = 1}); }});
  all.push_back({"restore", [](auto& w, const Ids&) { restore(w, {}); }});
  all.push_back({"move assignment", [](BasicWorld<Real>& w, const Ids&) { w = BasicWorld<Real>(); }});
  return all;
}

template <class Real>
int refused(BasicWorld<Real>& world, const Ids& ids) {
  int count = 0;
  for (const Row<Real>& row : all_rows<Real>()) {
    try {
      row.run(world, ids);
      ADD_FAILURE() << row.call << " was not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Unsupported) << row.call << ": " << error.what();
      ++count;
    }
  }
  return count;
}

// ---- Code of the user's that the world calls

TYPED_TEST(Waking, NoCallbackMayChangeTheWorld) {
  using Real = TypeParam;
  BasicWorld<Real> world;
  const Ids ids = lay_to_sleep(world);
  for (const BodyId body : world.bodies()) world.set_awake(body, true);
  const std::vector<std::byte> before = save(world);
  int count = 0;
  const auto look = [&] {
    if (count == 0) count = refused(world, ids);
  };
  const auto expect_same = [&](const char* where) {
    EXPECT_GT(count, 60) << where;
    EXPECT_TRUE(save(world) == before) << where;
    count = 0;
  };
  apply_law(world, [&](const LawBody&) -> Wrench<double> { return look(), Wrench<double>{}; });
  expect_same("law");
  overlap_box(world, {{-50, -50}, {50, 50}}, {}, [&](ShapeId) { return look(), true; });
  expect_same("overlap_box");
  overlap_shape(world, QueryShape(Circle{50}), {}, 0, {}, [&](ShapeId) { return look(), true; });
  expect_same("overlap_shape");
  shapes_at(world, {0, 0.5}, {}, [&](ShapeId) { return look(), true; });
  expect_same("shapes_at");
  ray_cast(world, {-50, 0.5}, {100, 0}, {}, [&](const RayResult&) { return look(), 1.0; });
  expect_same("ray_cast");
  cast_shape(world, QueryShape(Circle{0.2}), {-50, 0.5}, 0, {100, 0}, {},
             [&](const CastShapeResult&) { return look(), 1.0; });
  expect_same("cast_shape");
  const auto condition = [&](ShapeId) { return look(), true; };
  QueryFilter filter;
  filter.condition = condition;
  std::vector<ShapeId> found;
  std::vector<RayResult> hits;
  ray_cast_closest(world, {-50, 0.5}, {100, 0}, filter), expect_same("filter of ray_cast_closest");
  ray_cast_all(world, {-50, 0.5}, {100, 0}, filter, hits), expect_same("filter of ray_cast_all");
  cast_shape_closest(world, QueryShape(Circle{0.2}), {-50, 0.5}, 0, {100, 0}, filter);
  expect_same("filter of cast_shape_closest");
  overlap_box(world, {{-50, -50}, {50, 50}}, filter, found), expect_same("filter of overlap_box");
  overlap_shape(world, QueryShape(Circle{50}), {}, 0, filter, found), expect_same("filter of overlap_shape");
  shapes_at(world, {0, 0.5}, filter, found), expect_same("filter of shapes_at");
  nearest(world, {0, 3}, 100, filter), expect_same("filter of nearest");
}

TYPED_TEST(Waking, AHookThatChangesTheWorldIsRefusedAndTheStepGoesOn) {
  using Real = TypeParam;
  const auto after = [](bool tries) {
    BasicWorld<Real> world;
    const Ids ids = lay_to_sleep(world);
    const BodyId ball = world.create_body({.position = {0, 2.5}},
                                          ShapeDefinition{.geometry = Circle{0.4}, .pre_solve = true});
    int count = 0;
    world.on_pre_solve([&](const ContactReading&) {
      if (tries && count == 0) count = refused(world, ids);
      EXPECT_TRUE(world.valid(ball));
      EXPECT_THROW(save(world), Error);
      return true;
    });
    run(world, 60);
    EXPECT_TRUE(!tries || count > 60);
    return world.hash();
  };
  EXPECT_EQ(after(true), after(false));
}

TYPED_TEST(Waking, WhatCallbacksThrowLeavesTheWorldAsItWas) {
  using Real = TypeParam;
  struct Boom {};
  BasicWorld<Real> world;
  const Ids ids = lay_to_sleep(world);
  for (const BodyId body : world.bodies()) world.set_awake(body, true);
  const std::vector<std::byte> before = save(world);
  int calls = 0;
  EXPECT_THROW(apply_law(world,
                         [&](const LawBody&) -> Wrench<double> {
                           if (++calls == 3) throw Boom();
                           return {{1, 0}, 0};
                         }),
               Boom);
  EXPECT_THROW(overlap_box(world, {{-50, -50}, {50, 50}}, {}, [&](ShapeId) -> bool { throw Boom(); }), Boom);
  EXPECT_TRUE(save(world) == before);
  world.set_velocity(ids.box, {1, 0});  // not locked any more
  world.step();
}

TYPED_TEST(Waking, AWorldMayBeDestroyedFromItsOwnCallbacks) {
  using Real = TypeParam;
  auto world = std::make_unique<BasicWorld<Real>>();
  add_ground(*world);
  world->create_body({.position = {0, 0.4}}, ShapeDefinition{.geometry = Circle{0.5}, .pre_solve = true});
  world->on_pre_solve([&](const ContactReading&) { return world.reset(), true; });
  BasicWorld<Real>& alias = *world;
  alias.step();
  EXPECT_EQ(world, nullptr);
  world = std::make_unique<BasicWorld<Real>>();
  add_box(*world, {0, 0.5});
  apply_law(*world, [&](const LawBody&) -> Wrench<double> {
    return world.reset(), Wrench<double>{{1, 0}, 0};
  });
}

TYPED_TEST(Waking, AWorldThatWasMovedAwaySaysSo) {
  using Real = TypeParam;
  BasicWorld<Real> world;
  const Ids ids = lay_to_sleep(world);
  BasicWorld<Real> other = std::move(world);
  for (const Row<Real>& row : all_rows<Real>()) {
    if (row.call == "move assignment") continue;
    try {
      row.run(world, ids);
      ADD_FAILURE() << row.call << " was not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Name) << row.call;
    }
  }
  EXPECT_THROW(world.step_count(), Error);
  EXPECT_THROW(world.hash(), Error);
  EXPECT_THROW(world.valid(ids.box), Error);
  EXPECT_THROW(save(world), Error);
  EXPECT_THROW(world.shapes(ids.box), Error);
  EXPECT_THROW(world.joints(ids.box), Error);
  EXPECT_THROW(world.contacts(std::span<ContactReading>()), Error);
  EXPECT_THROW(world.box(ids.box), Error);
  EXPECT_THROW(world.user_data(ids.box), Error);
  world = std::move(other);
  world.step();
}

/// The functions of world.h that are not const.
std::set<std::string> calls_that_change() {
  std::ifstream in(std::filesystem::path(PLUMB_ENGINE) / "world" / "world.h");
  EXPECT_TRUE(in) << "world.h cannot be read; this test needs the sources";
  std::string text;
  for (std::string line; std::getline(in, line);) text += line.substr(0, line.find("//")) + " ";
  text = text.substr(text.find("class BasicWorld"));
  text = text.substr(0, text.find(" private:"));
  text = std::regex_replace(text, std::regex(R"(std::function<[^>]*>)"), "Hook");
  text = std::regex_replace(text, std::regex(R"( = [^,();]*)"), "");
  static const std::regex kFunction(R"((\w+)\(([^()]*)\)( const)?( noexcept)?;)");
  std::set<std::string> all;
  for (std::sregex_iterator it(text.begin(), text.end(), kFunction), end; it != end; ++it) {
    const std::string name = (*it)[1];
    if (!(*it)[3].matched && name != "BasicWorld" && name != "data") all.insert(name);
  }
  return all;
}

TEST(WakingRows, NameEveryCallThatChangesAWorld) {
  std::set<std::string> named;
  for (const auto& row : rows_of_world<float>()) named.insert(row.call);
  for (const auto& row : rows_of_body<float>(&Ids::box, true)) named.insert(row.call);
  const std::set<std::string> all = calls_that_change();
  EXPECT_GT(all.size(), 30u) << "the header was not understood";
  for (const std::string& call : all) EXPECT_TRUE(named.count(call)) << call;
}

}  // namespace
}  // namespace plumb
