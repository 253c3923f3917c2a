// Whatever a call could change is awake: each call of World on what sleeps acts as on a twin that is awake.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "engine/scene/error.h"
#include "engine/world/snapshot.h"
#include "tests/world/calls_of_world.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

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

// A fast kinematic body meets a sleeping rod within a step, before they have a contact.
TYPED_TEST(Waking, WhatAFastKinematicBodyMovesIsAwake) {
  for (const double speed : {1.0, 5.0, 20.0, 60.0}) {
    for (const double gap : {0.006, 0.1, 0.5, 2.0}) {
      BasicWorld<TypeParam> world;
      world.set_gravity({});
      const BodyId rod = world.create_body({}, {.geometry = Box{0.2, 0.01}});
      world.create_body({.type = BodyType::Kinematic, .position = {0, gap + 0.1}, .velocity = {0, -speed}},
                        {.geometry = Box{0.4, 0.2}});
      world.set_awake(rod, false);
      for (int i = 0; i < 150; ++i) {
        const double before = world.position(rod).y;
        world.step(1.0 / 60);
        std::vector<BodyId> moved(2);
        moved.resize(world.moved(moved));
        const bool reported = std::find(moved.begin(), moved.end(), rod) != moved.end();
        if (world.position(rod).y == before) continue;
        EXPECT_TRUE(reported && world.awake(rod)) << speed << " m/s, gap " << gap << " m, step " << i;
      }
      EXPECT_LT(world.position(rod).y, 0) << speed << " m/s, gap " << gap << " m";
    }
  }
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

// A body teleported away from its joint is drawn back by corrections of positions, which give it no velocity.
TYPED_TEST(Waking, NothingFallsAsleepWhileItsJointCloses) {
  for (const JointKind& kind :
       {JointKind(RevoluteDefinition{.anchor_b = {0, 1}}), JointKind(DistanceDefinition{.length = 1}),
        JointKind(WeldDefinition{.anchor_b = {0, 1}}), JointKind(PrismaticDefinition{.anchor_b = {0, 1}})}) {
    BasicWorld<TypeParam> world;
    const BodyId ground = world.create_body({.type = BodyType::Static});
    const BodyId body = world.create_body({.position = {0, -1}}, {.geometry = Box{0.5, 0.5}});
    const JointId joint = world.create_joint(ground, body, {.kind = kind});
    run(world, 60);
    world.set_position(body, {0, -21}, 0);
    run(world, 1200);
    EXPECT_LT(world.read(joint).linear_error, 1e-3) << kind.index();
  }
}

// Without shapes a body's extent is 0, but it spins.
TYPED_TEST(Waking, AFlywheelWithoutShapesSpinsOn) {
  BasicWorld<TypeParam> world;
  const BodyId wheel = world.create_body({.angular_velocity = 9, .mass = MassProperties{1, {}, 1}});
  const BodyId driven = world.create_body({.mass = MassProperties{1, {}, 1}});
  const BodyId axle = world.create_body({.type = BodyType::Static});
  world.set_gravity({});
  world.create_joint(axle, driven,
                     {.kind = RevoluteDefinition{.motor = Motor{.speed = 5, .max_force = 100}}});
  run(world, 240);
  EXPECT_NEAR(world.angular_velocity(wheel), 9, 1e-6);
  EXPECT_NEAR(world.angular_velocity(driven), 5, 1e-3);
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
