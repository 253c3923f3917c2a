// The user's code that a world calls may read it but not change it, and worlds that were moved away say so.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <span>

#include "engine/scene/error.h"
#include "engine/world/debug_draw.h"
#include "engine/world/force_laws.h"
#include "engine/world/queries.h"
#include "engine/world/snapshot.h"
#include "tests/world/calls_of_world.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

template <class Real>
class Callbacks : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Callbacks, Reals);

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

/// Calls a function for each item that is drawn.
struct Looking : DebugDraw {
  explicit Looking(std::function<void()> function) : look(std::move(function)) {}
  void polygon(std::span<const Vec2d>, double, DrawRole) override { look(); }
  void circle(Vec2d, double, Vec2d, DrawRole) override { look(); }
  void capsule(Vec2d, Vec2d, double, DrawRole) override { look(); }
  void segment(Vec2d, Vec2d, DrawRole) override { look(); }
  void point(Vec2d, DrawRole) override { look(); }
  void text(Vec2d, std::string_view, DrawRole) override { look(); }
  std::function<void()> look;
};

TYPED_TEST(Callbacks, NoCallbackMayChangeTheWorld) {
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
  Looking drawing(look);
  draw(world, drawing), expect_same("drawing");
  draw(world, PastPoses<Real>{}, 0.5, drawing), expect_same("drawing between steps");
}

TYPED_TEST(Callbacks, AHookThatChangesTheWorldIsRefusedAndTheStepGoesOn) {
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

TYPED_TEST(Callbacks, WhatCallbacksThrowLeavesTheWorldAsItWas) {
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

TYPED_TEST(Callbacks, AWorldMayBeDestroyedFromItsOwnCallbacks) {
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
  world = std::make_unique<BasicWorld<Real>>();
  add_box(*world, {0, 0.5});
  Looking drawing([&] { world.reset(); });
  draw(*world, drawing);
}

std::function<void()> in_rule;
double rule_that_calls(double a, double b) {
  if (in_rule) in_rule();
  return std::min(a, b);
}

// Setting a material calls rules between steps, several times for a shape with several contacts.
TYPED_TEST(Callbacks, ACombineRuleMayDestroyTheWorldAndChangeNothing) {
  using Real = TypeParam;
  for (const bool asleep : {false, true}) {
    auto world = std::make_unique<BasicWorld<Real>>();
    const ShapeId ground = world->shapes(add_ground(*world))[0];
    world->combine_with(rule_that_calls, rule_that_calls);
    for (int i = 0; i < 5; ++i) add_box(*world, {2.0 * i, 0.5});
    run(*world, asleep ? 120 : 3);
    ASSERT_EQ(world->counts().awake == 0, asleep);
    int refusals = 0;
    in_rule = [&] {
      try {
        world->set_gravity({});
      } catch (const Error& error) {
        refusals += error.kind() == Error::Kind::Unsupported ? 1 : 0;
      }
    };
    world->set_material(ground, {.friction = 0.3});
    EXPECT_GT(refusals, 9);
    in_rule = [&] { world.reset(); };
    BasicWorld<Real>& alias = *world;
    alias.set_material(ground, {.friction = 0.4});
    EXPECT_EQ(world, nullptr);
    // Within a step.
    in_rule = nullptr;
    world = std::make_unique<BasicWorld<Real>>();
    add_ground(*world);
    world->combine_with(rule_that_calls, rule_that_calls);
    for (int i = 0; i < 5; ++i) add_box(*world, {2.0 * i, 0.5});
    in_rule = [&] { world.reset(); };
    BasicWorld<Real>& other = *world;
    other.step();
    EXPECT_EQ(world, nullptr);
    in_rule = nullptr;
  }
}

// The filter is asked in steps alone.
TYPED_TEST(Callbacks, AFilterMayDestroyTheWorld) {
  using Real = TypeParam;
  for (const bool fast : {false, true}) {
    auto world = std::make_unique<BasicWorld<Real>>();
    const ShapeId ground = world->shapes(add_ground(*world))[0];
    add_body(*world, {0, fast ? 3 : 0.4}, {.geometry = Circle{0.5}}, {0, fast ? -300.0 : 0});
    int asked = 0;
    world->on_filter([&](ShapeId, ShapeId) { return ++asked, world.reset(), true; });
    world->set_filter(ground, {.category = 2});
    world->set_geometry(ground, Box{200, 2}, {0, -1});
    ASSERT_EQ(asked, 0);
    BasicWorld<Real>& alias = *world;
    alias.step();
    EXPECT_EQ(world, nullptr);
  }
}

TYPED_TEST(Callbacks, AWorldThatWasMovedAwaySaysSo) {
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

}  // namespace
}  // namespace plumb
