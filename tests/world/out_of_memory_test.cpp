// Each allocation of a call fails once: the world can be used on and destroyed, and what creates has changed
// nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <new>

#include "engine/world/force_laws.h"
#include "engine/world/rollback.h"
#include "engine/world/snapshot.h"
#include "engine/world/snapshot_check.h"
#include "engine/world/world_data.h"
#include "tests/world/allocations.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

template <class Real>
BasicWorld<Real> make_heap(int count) {
  // The direct islands' memory is a pool of the standard library's, which does not bear a failure in g++
  // 12's.
  BasicWorld<Real> world({.direct_islands = false});
  const BodyId ground =
      world.create_body({.type = BodyType::Static}, ShapeDefinition{.geometry = Box{40, 1}});
  world.create_chain(ground, {.points = {{20, 3}, {10, 1}, {-10, 1}, {-20, 3}}});
  world.create_shape(ground, {.geometry = Box{6, 6}, .position = {0, 3}, .sensor = true});
  BodyId last = ground;
  for (int i = 0; i < count; ++i) {
    const BodyId body = world.create_body({.name = "a body with a long name, number " + std::to_string(i),
                                           .position = {0.4 * (i % 7), 1.5 + 0.7 * i},
                                           .angle = 0.3 * i,
                                           .user_data = 3},
                                          ShapeDefinition{.geometry = Box{0.8, 0.6}, .hit_events = true});
    if (i % 5 == 4)
      world.create_joint(last, body, {.kind = DistanceDefinition{.length = 1}, .break_force = 50});
    last = body;
  }
  return world;
}

template <class Real>
struct Operation {
  const char* name;
  int warm;     ///< steps before it
  bool strong;  ///< all or nothing
  std::function<void(BasicWorld<Real>&)> run;
};

template <class Real>
std::vector<Operation<Real>> operations() {
  using W = BasicWorld<Real>;
  const ShapeDefinition box{.geometry = Box{1, 1}, .user_data = 4};
  const auto steps = [](W& w, int n) { run(w, n); };
  return {
      {"create_body", 20, true,
       [=](W& w) {
         w.create_body({.name = "a body with quite a long name",
                        .position = {3, 30},
                        .gravity_scale = 0.5,
                        .user_data = 7},
                       box);
       }},
      {"create_body asleep", 20, true,
       [=](W& w) {
         w.create_body({.position = {3, 30}, .awake = false, .user_data = 7}, box);
       }},
      {"create_body with 20 shapes", 20, true,
       [=](W& w) {
         std::vector<ShapeDefinition> all;
         for (int i = 0; i < 20; ++i)
           all.push_back({.geometry = Polygon{.points = {{0, 0}, {1, 0}, {1.2, 0.5}, {0.5, 1}}},
                          .position = {i * 1.0, 0}});
         w.create_body({.position = {3, 30}}, all);
       }},
      {"create_shape", 20, true,
       [](W& w) {
         w.create_shape(w.bodies()[3],
                        {.geometry = Capsule{{0, 0}, {1, 0}, 0.5}, .sensor = true, .user_data = 4});
       }},
      {"create_shape of the ground", 20, true, [=](W& w) { w.create_shape(w.bodies()[0], box); }},
      {"create_chain", 20, true,
       [](W& w) {
         std::vector<Vec2d> points;
         for (int i = 0; i < 40; ++i) points.push_back({20. - i, std::sin(i * 1.0)});
         w.create_chain(w.bodies()[0], {.points = points});
       }},
      {"create_joint", 20, true,
       [](W& w) { w.create_joint(w.bodies()[3], w.bodies()[4], {.kind = RevoluteDefinition{}}); }},
      {"create_joint that breaks", 20, true,
       [](W& w) {
         w.create_joint(w.bodies()[3], w.bodies()[5], {.kind = PulleyDefinition{}, .break_force = 2});
       }},
      {"destroy body", 40, false, [](W& w) { w.destroy(w.bodies()[5]); }},
      {"destroy ground", 60, false, [](W& w) { w.destroy(w.bodies()[0]); }},
      {"destroy joint", 40, false,
       [](W& w) {
         for (const BodyId body : w.bodies()) {
           for (const JointId joint : w.joints(body)) return w.destroy(joint);
         }
       }},
      {"set_type static", 40, false, [](W& w) { w.set_type(w.bodies()[5], BodyType::Static); }},
      {"set_type kinematic", 40, false, [](W& w) { w.set_type(w.bodies()[0], BodyType::Kinematic); }},
      {"set_position", 40, false,
       [](W& w) {
         w.set_position(w.bodies()[5], {3, 3}, 1);
       }},
      {"set_filter", 40, false,
       [](W& w) { w.set_filter(w.shapes(w.bodies()[5])[0], {.category = 2, .mask = 1}); }},
      {"set_filter none", 40, false, [](W& w) { w.set_filter(w.shapes(w.bodies()[5])[0], {.mask = 0}); }},
      {"set_mass", 40, false,
       [](W& w) {
         w.set_mass(w.bodies()[5], {.mass = 3, .centre = {0.1, 0.1}, .inertia = 2});
       }},
      {"set_gravity_scale", 40, false, [](W& w) { w.set_gravity_scale(w.bodies()[0], 3); }},
      {"apply_force", 40, false,
       [](W& w) {
         w.apply_force(w.bodies()[5], {3, 3});
       }},
      {"set_awake false", 40, false, [](W& w) { w.set_awake(w.bodies()[5], false); }},
      {"set_awake true", 400, false, [](W& w) { w.set_awake(w.bodies()[5], true); }},
      {"set_gravity", 400, false,
       [](W& w) {
         w.set_gravity({0, -9});
       }},
      {"first step", 0, false, [=](W& w) { steps(w, 1); }},
      {"30 steps", 0, false, [=](W& w) { steps(w, 30); }},
      {"later steps", 60, false, [=](W& w) { steps(w, 30); }},
      {"steps to sleep", 250, false, [=](W& w) { steps(w, 60); }},
      {"quarantine", 40, false,
       [=](W& w) {
         w.apply_impulse(w.bodies()[5], {1e12, 1e12}), steps(w, 2);
       }},
      {"xpbd", 40, false, [=](W& w) { w.set_solver(Solver::Xpbd), steps(w, 3); }},
      {"explode", 40, false,
       [=](W& w) {
         explode(w, {.centre = {0, 1}, .radius = 5, .impulse = 3}, {.occlusion = true}), steps(w, 1);
       }},
      {"water", 40, false, [=](W& w) { apply_water(w, {.level = 5}, 1. / 60), steps(w, 1); }},
      {"restore", 40, false,
       [=](W& w) {
         const auto state = save(w);
         steps(w, 1), restore(w, state);
       }},
      {"rollback", 40, false,
       [=](W& w) {
         Rollback<Real> back(w, 3);
         back.save(), steps(w, 1), back.save(), steps(w, 1), back.back_to(back.oldest());
       }},
  };
}

template <class Real>
void expect_sound(BasicWorld<Real>& world, const std::string& where) {
  EXPECT_NO_THROW(check_state(world.data())) << where;
  EXPECT_TRUE(world.data().static_tree.valid() && world.data().dynamic_tree.valid()) << where;
  for (const BodyId body : world.bodies()) {
    const BodyState s = world.state(body);
    ASSERT_TRUE(std::isfinite(s.position.x + s.position.y + s.angle + s.velocity.x + s.velocity.y)) << where;
  }
}

// Of many allocations the usual run takes fewer and fewer.
long stride() { return std::getenv("PLUMB_PROPERTY_CASES") != nullptr ? 1000000 : 15; }

template <class Real>
class OutOfMemory : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(OutOfMemory, Reals);

TYPED_TEST(OutOfMemory, LeavesAWorldThatCanBeUsedAndDestroyed) {
  using Real = TypeParam;
  int failures = 0;
  for (const Operation<Real>& operation : operations<Real>()) {
    BasicWorld<Real> model = make_heap<Real>(18);
    run(model, operation.warm);
    const std::vector<std::byte> before = save(model);
    for (long nth = 0; nth < 4000; nth += 1 + nth / stride()) {
      const std::string where = std::string(operation.name) + ", allocation " + std::to_string(nth);
      BasicWorld<Real> world;
      restore(world, before);
      test::fail_after(nth);
      bool threw = false;
      try {
        operation.run(world);
      } catch (const std::bad_alloc&) {
        threw = true;
      } catch (const std::exception& error) {
        test::fail_after(-1);
        FAIL() << where << ": " << error.what();
      }
      const bool failed = test::has_failed();
      test::fail_after(-1);
      if (!failed) break;
      ++failures;
      EXPECT_TRUE(threw) << where;
      expect_sound(world, where);
      if (operation.strong) {
        EXPECT_EQ(world.counts().bodies, model.counts().bodies) << where;
        EXPECT_TRUE(save(world) == before) << where;
      }
      run(world, 10);
      expect_sound(world, where + ", later");
      for (const BodyId body : world.bodies()) world.destroy(body);
      world.step();
      if (this->HasFailure()) return;
    }
  }
  EXPECT_GT(failures, 300);
}

}  // namespace
}  // namespace plumb
