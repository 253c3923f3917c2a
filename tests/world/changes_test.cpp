// Changes bodies, shapes and joints after they were made: the same motion as if they had been made so.
// Readers that fill a span give what those that return a vector give.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <unordered_map>
#include <vector>

#include "engine/world/queries.h"
#include "engine/world/recorder.h"
#include "engine/world/replay.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "engine/world/world.h"

namespace plumb {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

template <class Real>
class Changes : public testing::Test {
 protected:
  BodyId add(BodyType type, Vec2d position, ShapeDefinition shape = {.geometry = Box{1, 1}}) {
    return world.create_body({.type = type, .position = position}, shape);
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) world.step();
  }

  BasicWorld<Real> world;
  BodyId ground = add(BodyType::Static, {0, -0.5}, {.geometry = Box{40, 1}});
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Changes, Reals);

TYPED_TEST(Changes, NamesAndUserDataAreWhatWasSet) {
  BasicWorld<TypeParam>& w = this->world;
  const BodyId body = this->add(BodyType::Dynamic, {0, 3}), other = this->add(BodyType::Dynamic, {0, 5});
  const ShapeId shape = w.shapes(body)[0];
  const JointId joint = w.create_joint(body, other, {.kind = DistanceDefinition{.length = 2}});
  w.set_user_data(body, 1), w.set_user_data(shape, 2), w.set_user_data(joint, 3), w.set_name(body, "crate");
  EXPECT_EQ(w.user_data(body), 1u);
  EXPECT_EQ(w.user_data(shape), 2u);
  EXPECT_EQ(w.user_data(joint), 3u);
  EXPECT_EQ(w.name(body), "crate");
  EXPECT_EQ(w.user_data(other), 0u);
  EXPECT_EQ(w.name(other), "");
  const BodyId next = this->add(BodyType::Dynamic, {0, 9});
  EXPECT_EQ(w.user_data(next), 0u);
  try {
    w.set_damping(body, -1, 0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), "body 'crate'") << "messages have the new name";
  }
}

TYPED_TEST(Changes, ADensityMovesLikeOneThatWasThereFromTheStart) {
  const auto seesaw = [&](double density, bool later) {
    BasicWorld<TypeParam> w;
    const BodyId body = w.create_body({.position = {0, 5}}, ShapeDefinition{.geometry = Box{1, 1}});
    const ShapeId shape =
        w.create_shape(body, {.geometry = Circle{0.3}, .position = {1, 0}, .density = later ? 1 : density});
    if (later) w.set_density(shape, density);
    EXPECT_EQ(w.density(shape), density);
    w.apply_impulse(body, {0, 1}, {0, 5});
    for (int i = 0; i < 30; ++i) w.step();
    return std::pair(w.mass(body), w.hash());
  };
  EXPECT_EQ(seesaw(4, true), seesaw(4, false));
  // 1 kg of the box and pi r^2 density of the disc.
  EXPECT_NEAR(seesaw(4, true).first, 1 + 3.14159265358979 * 0.09 * 4, 1e-6);
  BasicWorld<TypeParam>& w = this->world;
  const BodyId body = this->add(BodyType::Dynamic, {0, 3});
  w.set_mass(body, {.mass = 7, .inertia = 2});
  w.set_density(w.shapes(body)[0], 3);
  EXPECT_EQ(w.mass(body), 7) << "a mass that was given stays";
}

TYPED_TEST(Changes, AShapeBecomesASensorAndBack) {
  BasicWorld<TypeParam>& w = this->world;
  const BodyId body = this->add(BodyType::Dynamic, {0, 0.5});
  const ShapeId shape = w.shapes(body)[0], floor = w.shapes(this->ground)[0];
  this->run(90);
  ASSERT_FALSE(w.awake(body));
  w.set_sensor(floor, true);
  EXPECT_TRUE(w.sensor(floor));
  EXPECT_TRUE(w.awake(body)) << "what lost its support falls";
  this->run(1);
  EXPECT_EQ(w.events().end.size(), 1u);
  EXPECT_THAT(w.overlapping(floor), ElementsAre(shape));
  this->run(20);
  EXPECT_LT(w.position(body).y, 0.2);
  w.set_sensor(floor, false);
  this->run(1);
  EXPECT_EQ(w.events().sensor_end.size(), 1u);
  EXPECT_THROW(w.overlapping(floor), Error);
  this->run(120);
  EXPECT_NEAR(w.position(body).y, 0.5, 0.01) << "it is pushed out and rests";
}

TYPED_TEST(Changes, HitEventsAndTheHookAreSwitchedForContactsThatExist) {
  BasicWorld<TypeParam>& w = this->world;
  const BodyId body = this->add(BodyType::Dynamic, {0, 3});
  const ShapeId shape = w.shapes(body)[0];
  w.set_hit_events(shape, true);
  EXPECT_TRUE(w.hit_events(shape));
  std::size_t hits = 0;
  for (int i = 0; i < 90; ++i) {
    w.step();
    hits += w.events().hits.size();
  }
  EXPECT_EQ(hits, 1u);
  int calls = 0;
  w.on_pre_solve([&](const ContactReading&) { return ++calls > 0; });
  this->run(2);
  EXPECT_EQ(calls, 0);
  w.set_pre_solve(shape, true);
  this->run(2);
  EXPECT_GT(calls, 0);
  w.set_pre_solve(shape, false);
  const int before = calls;
  w.set_awake(body, true);
  this->run(2);
  EXPECT_EQ(calls, before);
}

TYPED_TEST(Changes, ADisabledBodyIsNotThereUntilItIsEnabled) {
  BasicWorld<TypeParam>& w = this->world;
  const BodyId below = this->add(BodyType::Dynamic, {0, 0.5}), above = this->add(BodyType::Dynamic, {0, 1.5});
  this->run(90);
  const double height = w.position(above).y;
  w.set_enabled(below, false);
  EXPECT_FALSE(w.enabled(below));
  EXPECT_TRUE(w.awake(above)) << "what lay on it wakes";
  EXPECT_EQ(w.type(below), BodyType::Dynamic);
  EXPECT_FALSE(ray_cast_closest(w, {-5, 0.5}, {10, 0}).has_value());
  this->run(90);
  EXPECT_NEAR(w.position(above).y, height - 1, 0.01);
  EXPECT_NEAR(w.position(below).y, 0.5, 0.01) << "it stays where it was";
  EXPECT_FALSE(w.quarantined(below));
  EXPECT_THAT(w.quarantined(), IsEmpty());
  EXPECT_THAT(w.events().quarantined, IsEmpty());
  w.release(below);
  EXPECT_FALSE(w.enabled(below)) << "releasing is for quarantine";
  const std::vector<std::byte> saved = save(w);
  BasicWorld<TypeParam> copy;
  restore(copy, saved);
  EXPECT_FALSE(copy.enabled(below));
  w.set_position(above, {5, 0.5}, 0);
  w.set_enabled(below, true), w.set_enabled(below, true);
  EXPECT_TRUE(w.enabled(below) && w.awake(below));
  w.apply_impulse(below, {1, 0});
  this->run(5);
  EXPECT_GT(w.position(below).x, 0.01);
}

TYPED_TEST(Changes, AJointOfADisabledBodyHoldsAgainWhenItIsEnabled) {
  BasicWorld<TypeParam>& w = this->world;
  const BodyId hung = this->add(BodyType::Dynamic, {0, 5});
  const JointId joint =
      w.create_joint(this->ground, hung, {.kind = RevoluteDefinition{.anchor_a = {0, 5.5}}});
  w.set_enabled(hung, false);
  this->run(30);
  EXPECT_EQ(w.position(hung).y, 5);
  w.set_enabled(hung, true);
  this->run(60);
  EXPECT_NEAR(w.position(hung).y, 5, 1e-3);
  EXPECT_NEAR(w.read(joint).force, 9.81, 0.1);
}

// A prefab is built disabled, joint by joint, in any order of the bodies: enabled, it moves as one that was
// built enabled.
TYPED_TEST(Changes, JointsOfDisabledBodiesHoldFromWhenTheyAreEnabled) {
  const auto build = [](BasicWorld<TypeParam>& w, bool disabled) {
    const BodyId wall = w.create_body({.type = BodyType::Static, .position = {0, 5}});
    std::vector<BodyId> links;
    for (int i = 0; i < 3; ++i)
      links.push_back(w.create_body({.position = {i + 0.5, 5}}, ShapeDefinition{.geometry = Box{1, 0.2}}));
    if (disabled)
      for (const BodyId link : links) w.set_enabled(link, false);
    const RevoluteDefinition hinge{.anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}};
    const JointId first = w.create_joint(wall, links[0], {.kind = RevoluteDefinition{.anchor_b = {-0.5, 0}}});
    w.create_joint(links[0], links[1], {.kind = hinge});
    w.create_joint(links[1], links[2], {.kind = WeldDefinition{.anchor_a = {0.5, 0}, .anchor_b = {-0.5, 0}}});
    const JointId mouse = w.create_joint(
        wall, links[2], {.kind = MouseDefinition{.anchor_b = {0.5, 0}, .target = {3, 5}, .max_force = 1}});
    w.change(first, w.kind(first)), w.change(mouse, w.kind(mouse));
    if (disabled) {
      for (int i = 0; i < 30; ++i) w.step();
      EXPECT_EQ(w.position(links[2]).y, 5) << "a disabled body does not move";
      for (const BodyId link : links) w.set_enabled(link, true);
    }
    for (int i = 0; i < 60; ++i) w.step();
    return w.position(links[2]);
  };
  BasicWorld<TypeParam> plain, late;
  const Vec2d expected = build(plain, false);
  EXPECT_LT(expected.y, 4);
  EXPECT_EQ(build(late, true), expected);
}

// Bodies that are frozen, held by a joint that was there or made while they were, then released.
TYPED_TEST(Changes, JointsBetweenFrozenBodiesHoldOnceOneIsDynamic) {
  for (const BodyType frozen : {BodyType::Static, BodyType::Kinematic}) {
    for (const bool made_frozen : {false, true}) {
      BasicWorld<TypeParam> w;
      const BodyId wall = w.create_body({.type = frozen, .position = {0, 5}});
      const BodyId bob = w.create_body({.type = made_frozen ? frozen : BodyType::Dynamic, .position = {1, 5}},
                                       ShapeDefinition{.geometry = Box{0.2, 0.2}});
      const JointId joint = w.create_joint(wall, bob, {.kind = RevoluteDefinition{.anchor_b = {-1, 0}}});
      w.set_type(bob, frozen);
      w.change(joint, w.kind(joint));
      w.change(joint, DistanceDefinition{.length = 1});
      for (int i = 0; i < 30; ++i) w.step();
      EXPECT_EQ(w.position(bob), (Vec2d{1, 5}));
      EXPECT_EQ(w.read(joint).force, 0);
      const std::vector<std::byte> saved = save(w);
      w.set_type(bob, BodyType::Dynamic);
      double farthest = 0, lowest = 5;
      for (int i = 0; i < 60; ++i) {
        w.step();
        lowest = std::min(lowest, w.position(bob).y);
        farthest = std::max(farthest, std::abs(length(w.position(bob) - Vec2d{0, 5}) - 1));
      }
      EXPECT_LT(lowest, 4.01) << "it swings";
      EXPECT_LT(farthest, 1e-3);
      BasicWorld<TypeParam> again;
      restore(again, saved);
      again.set_type(bob, BodyType::Dynamic);
      for (int i = 0; i < 60; ++i) again.step();
      EXPECT_EQ(again.hash(), w.hash());
      w.set_type(bob, BodyType::Static);
      w.set_enabled(wall, false), w.set_enabled(wall, true);
      w.step();
      EXPECT_EQ(w.read(joint).force, 0);
    }
  }
}

// Mouse joints pull only their body b: one that is frozen stays, and its partner does not feel it.
TYPED_TEST(Changes, AMouseJointWaitsForItsBodyToBecomeDynamic) {
  BasicWorld<TypeParam> w({.gravity = {0, 0}});
  const BodyId partner = w.create_body({}, ShapeDefinition{}),
               held = w.create_body({.type = BodyType::Static, .position = {5, 0}}, ShapeDefinition{});
  w.create_joint(partner, held, {.kind = MouseDefinition{.target = {5, 3}, .max_force = 1000}});
  for (int i = 0; i < 30; ++i) w.step();
  EXPECT_EQ(w.position(held), (Vec2d{5, 0}));
  EXPECT_EQ(w.position(partner), (Vec2d{0, 0}));
  w.set_type(held, BodyType::Dynamic);
  for (int i = 0; i < 300; ++i) w.step();
  EXPECT_NEAR(w.position(held).y, 3, 1e-2);
}

TYPED_TEST(Changes, AreReplayed) {
  const std::string file = testing::TempDir() + "changes." + std::to_string(sizeof(TypeParam));
  std::uint64_t hash = 0;
  {
    RecordedWorld<TypeParam> w(file);
    w.create_body({.type = BodyType::Static, .position = {0, -0.5}}, ShapeDefinition{.geometry = Box{40, 1}});
    const BodyId a = w.create_body({.position = {0, 0.5}}, ShapeDefinition{.geometry = Box{1, 1}});
    const BodyId b = w.create_body({.position = {0, 1.5}}, ShapeDefinition{.geometry = Box{1, 1}});
    for (int i = 0; i < 20; ++i) w.step();
    const ShapeId shape = w->shapes(b)[0];
    w.set_density(shape, 3), w.set_user_data(shape, 4), w.set_user_data(a, 5), w.set_name(a, "lower");
    w.set_hit_events(shape, true), w.set_pre_solve(shape, true);
    w.set_enabled(a, false);
    for (int i = 0; i < 20; ++i) w.step();
    w.set_enabled(a, true);
    w.set_sensor(w->shapes(a)[0], true);
    for (int i = 0; i < 20; ++i) w.step();
    hash = full_hash(*w);
  }
  Replay<TypeParam> replayed(file);
  while (replayed.step()) {
  }
  EXPECT_FALSE(replayed.report().first_difference.has_value()) << replayed.report().message;
  EXPECT_EQ(full_hash(replayed.world()), hash);
}

TYPED_TEST(Changes, ReadersFillASpanAsFarAsItGoes) {
  BasicWorld<TypeParam>& w = this->world;
  const BodyId gone = this->add(BodyType::Dynamic, {9, 9});
  std::vector<BodyId> tower;
  for (int i = 0; i < 4; ++i) tower.push_back(this->add(BodyType::Dynamic, {0, 0.5 + i}));
  w.destroy(gone);
  this->run(20);
  std::vector<BodyId> bodies(8);
  std::vector<BodyPose> poses(8);
  std::vector<BodyState> states(8);
  ASSERT_EQ(w.bodies(bodies), 5u);
  ASSERT_EQ(w.poses(poses), 5u);
  ASSERT_EQ(w.states(states), 5u);
  bodies.resize(5);
  EXPECT_EQ(bodies, w.bodies());
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(poses[i].position, w.position(bodies[i]));
    EXPECT_EQ(poses[i].angle, w.angle(bodies[i]));
    EXPECT_EQ(states[i], w.state(bodies[i]));
  }
  std::vector<ContactReading> contacts(9);
  ASSERT_EQ(w.contacts(contacts), 4u) << "each once, though it is in two bodies' lists";
  ASSERT_EQ(w.contacts(tower[1], std::span(contacts)), 2u);
  EXPECT_EQ(contacts[0].points[0], w.contacts(tower[1])[0].points[0]);
  EXPECT_EQ(w.contacts(tower[1], std::span<ContactReading>{}), 2u);
  bodies.assign(2, {});
  EXPECT_EQ(w.bodies(std::span(bodies).first(1)), 5u);
  EXPECT_EQ(bodies[1], BodyId{}) << "beyond the span nothing is written";
}

TYPED_TEST(Changes, MovedBodiesAreThoseThatAStepCouldMove) {
  BasicWorld<TypeParam>& w = this->world;
  const BodyId rests = this->add(BodyType::Dynamic, {0, 0.5});
  std::vector<BodyId> moved(8);
  ASSERT_EQ(w.moved(moved), 1u);
  EXPECT_EQ(moved[0], rests);
  int last = 0;
  for (int i = 0; i < 200 && w.awake(rests); ++i) {
    w.step();
    last = static_cast<int>(w.moved(moved));
  }
  EXPECT_EQ(last, 1) << "the step that puts it to sleep may move it";
  w.step();
  EXPECT_EQ(w.moved(moved), 0u);
  const BodyId falls = this->add(BodyType::Dynamic, {5, 5});
  w.step();
  ASSERT_EQ(w.moved(moved), 1u);
  EXPECT_EQ(moved[0], falls);
}

TYPED_TEST(Changes, BoxesContainTheShapes) {
  BasicWorld<TypeParam>& w = this->world;
  const BodyId body = w.create_body({.position = {3, 4}, .angle = 3.14159265358979 / 4},
                                    ShapeDefinition{.geometry = Box{2, 2}});
  w.create_shape(body, {.geometry = Circle{0.5}, .position = {4, 0}});
  const double reach = std::sqrt(2.0), along = 4 / reach;
  const Aabb<double> square = w.box(w.shapes(body)[0]), all = w.box(body);
  EXPECT_NEAR(square.lower.x, 3 - reach, 1e-5);
  EXPECT_NEAR(square.upper.y, 4 + reach, 1e-5);
  EXPECT_NEAR(all.lower.y, 4 - reach, 1e-5);
  EXPECT_NEAR(all.upper.x, 3 + along + 0.5, 1e-5);
  const BodyId empty = w.create_body({.position = {7, 8}});
  EXPECT_EQ(w.box(empty).lower, w.box(empty).upper);
  EXPECT_EQ(w.box(empty).lower, (Vec2d{7, 8}));
}

TYPED_TEST(Changes, OneShapeAnswersRaysAndPoints) {
  BasicWorld<TypeParam>& w = this->world;
  const BodyId near = this->add(BodyType::Dynamic, {2, 5}), far = this->add(BodyType::Dynamic, {4, 5});
  const ShapeId shape = w.shapes(far)[0];
  const auto hit = ray_cast(w, shape, {0, 5}, {10, 0});
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->fraction, 0.35, 1e-6);
  EXPECT_EQ(hit->body, far) << "what stands in front is not asked";
  EXPECT_EQ(ray_cast(w, w.shapes(near)[0], {0, 5}, {10, 0})->fraction,
            ray_cast_closest(w, {0, 5}, {10, 0})->fraction);
  EXPECT_FALSE(ray_cast(w, shape, {0, 5}, {3, 0}).has_value());
  EXPECT_TRUE(contains(w, shape, {4.4, 5.4}));
  EXPECT_FALSE(contains(w, shape, {4.6, 5.4}));
  w.set_filter(shape, {.mask = 0});
  EXPECT_TRUE(contains(w, shape, {4, 5})) << "no filter is asked";
}

TYPED_TEST(Changes, SegmentsKnowTheirChain) {
  BasicWorld<TypeParam>& w = this->world;
  const ChainId chain = w.create_chain(this->ground, {.points = {{1, 1}, {0, 1}, {-1, 1}}});
  for (const ShapeId segment : w.segments(chain)) EXPECT_EQ(w.chain(segment), chain);
  EXPECT_EQ(w.chain(w.shapes(this->ground)[0]), ChainId{});
}

TEST(Handles, AreKeysOfMaps) {
  const BodyId first{1, 1}, second{1, 3}, third{2, 1};
  std::map<BodyId, int> ordered{{third, 3}, {first, 1}, {second, 2}};
  std::unordered_map<BodyId, int> hashed(ordered.begin(), ordered.end());
  EXPECT_EQ(ordered.begin()->first, first);
  EXPECT_EQ(ordered.rbegin()->first, third);
  EXPECT_EQ(hashed.at(second), 2);
  EXPECT_NE(std::hash<BodyId>{}(first), std::hash<BodyId>{}(second));
}

}  // namespace
}  // namespace plumb
