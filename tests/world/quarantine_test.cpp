#include "engine/world/state/quarantine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "engine/scene/error.h"
#include "engine/world/force_laws.h"
#include "engine/world/recorder.h"
#include "engine/world/replay.h"
#include "engine/world/rollback.h"
#include "engine/world/snapshot.h"
#include "engine/world/snapshot_check.h"
#include "engine/world/state_hash.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class Real>
class Quarantine : public testing::Test {
 public:
  using World = BasicWorld<Real>;
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Quarantine, Precisions);

// The law of a game whose author divides by zero for one body.
template <class Real>
void apply_bad_law(BasicWorld<Real>& world, BodyId bad) {
  apply_law(world, [&](const LawBody& body) -> Wrench<double> {
    return {{body.id == bad ? kNan : 0.1 * body.mass, 0}, 0};
  });
}

// Two towers and a pendulum, and far from them a box on a ground of its own, which goes bad in the tenth
// step.
template <class Real>
std::vector<BodyId> build_bystanders(BasicWorld<Real>& world) {
  std::vector<BodyId> all{add_ground(world)};
  for (int i = 0; i < 5; ++i) all.push_back(add_box(world, {0, 0.5 + i}));
  for (int i = 0; i < 5; ++i) all.push_back(add_box(world, {9 + 0.1 * i, 0.7 + i}));
  all.push_back(add_box(world, {-19, 5}));
  world.create_joint(all[0], all.back(), {.kind = RevoluteDefinition{{-20, 6}, {-1, 1}}});
  return all;
}

TYPED_TEST(Quarantine, BystandersHaveTheBitsOfAWorldWithoutTheBadBody) {
  typename TestFixture::World with, without;
  const std::vector<BodyId> all = build_bystanders(with);
  build_bystanders(without);
  with.create_body({.type = BodyType::Static, .position = {500, -1}}, {.geometry = Box{20, 2}});
  const BodyId bad = with.create_body({.name = "bad", .position = {500, 0.5}}, {.geometry = Box{1, 1}});
  int told = 0;
  for (int step = 1; step <= 300; ++step) {
    const BodyId victim = step == 10 ? bad : BodyId{};
    apply_bad_law(with, victim), apply_bad_law(without, victim);
    with.step(), without.step();
    for (const QuarantineEvent& event : with.events().quarantined) {
      ++told;
      EXPECT_EQ(event.body, bad);
      EXPECT_EQ(event.name, "bad");
      EXPECT_EQ(event.field, BadField::Force);
      EXPECT_TRUE(std::isnan(event.value));
      EXPECT_EQ(event.step, 10);
      EXPECT_EQ(step, 10);
    }
    for (const BodyId body : all) {
      ASSERT_EQ(with.position(body), without.position(body)) << step;
      ASSERT_EQ(with.angle(body), without.angle(body)) << step;
      ASSERT_EQ(with.velocity(body), without.velocity(body)) << step;
    }
  }
  EXPECT_EQ(told, 1);
  ASSERT_EQ(with.quarantined().size(), 1u);
  EXPECT_TRUE(with.quarantined(bad));
  EXPECT_FALSE(with.quarantined(all[1]));
}

// A falling body stops where it was; released, it goes on: y = -g t^2 / 2 with the time of its absence left
// out. In float sums of 60 parabolas round by 1e-6 of 5 m.
TYPED_TEST(Quarantine, StaysAsItWasAndGoesOnWhenReleased) {
  typename TestFixture::World world;
  const BodyId ball = add_body(world, {0, 0}, {.geometry = Circle{0.5}});
  run(world, 30);
  const BodyState before = world.state(ball);
  apply_bad_law(world, ball);
  run(world, 50);
  EXPECT_EQ(world.position(ball), before.position);
  EXPECT_EQ(world.velocity(ball), before.velocity);
  EXPECT_FALSE(world.awake(ball));
  EXPECT_EQ(world.type(ball), BodyType::Dynamic);
  EXPECT_GT(world.mass(ball), 0);
  world.release(ball);
  EXPECT_TRUE(world.quarantined().empty());
  run(world, 30);
  EXPECT_NEAR(world.position(ball).y, -0.5 * kGravity, 1e-5);
  EXPECT_NEAR(world.velocity(ball).y, -kGravity, 1e-5);
}

// Bodies that lay on it fall, rays pass it, and it can be set right before it is released.
TYPED_TEST(Quarantine, NothingTouchesIt) {
  typename TestFixture::World world;
  const BodyId shelf = world.create_body({.type = BodyType::Kinematic}, {.geometry = Box{4, 1}});
  const BodyId box = add_box(world, {0, 1});
  run(world, 10);
  ASSERT_EQ(world.contacts(box).size(), 1u);
  quarantine_body(world.data(), static_cast<int>(shelf.index), BadField::Velocity, kNan);
  EXPECT_TRUE(world.contacts(box).empty());
  run(world, 60);
  EXPECT_NEAR(world.position(box).y, 1 - 0.5 * kGravity, 1e-2);
  world.set_position(shelf, {0, -20}, 0);
  world.set_velocity(shelf, {1, 0});
  run(world, 6);
  EXPECT_EQ(world.position(shelf), (Vec2d{0, -20}));
  world.release(shelf);
  run(world, 120);
  EXPECT_NEAR(world.position(shelf).x, 2, 1e-4);
  EXPECT_EQ(world.contacts(box).size(), 1u);
}

// The middle one of three links goes bad: its joints let go, the lower one falls freely, the upper one swings
// on; released, the middle one is held again.
TYPED_TEST(Quarantine, JointsLetGoAndHoldAgain) {
  typename TestFixture::World world(without_sleep());
  const BodyId hook = world.create_body({.type = BodyType::Static});
  BodyId before = hook;
  std::vector<BodyId> links;
  for (int i = 0; i < 3; ++i) {
    const BodyId link =
        world.create_body({.position = {0, -0.5 - i}, .mass = MassProperties{1, {}, 1.0 / 12}});
    const Vec2d end = i == 0 ? Vec2d{} : Vec2d{0, -0.5};
    world.create_joint(before, link, {.kind = RevoluteDefinition{end, {0, 0.5}}});
    links.push_back(before = link);
  }
  run(world, 10);
  const double start = world.position(links[2]).y, speed = world.velocity(links[2]).y;
  apply_bad_law(world, links[1]);
  run(world, 30);
  EXPECT_NEAR(world.position(links[2]).y, start + speed / 2 - 0.125 * kGravity, 1e-4);
  EXPECT_NEAR(world.position(links[0]).y, -0.5, 1e-3);
  world.set_position(links[2], {0, -2.5}, 0);
  world.set_velocity(links[2], {});
  world.release(links[1]);
  run(world, 120);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(world.position(links[i]).y, -0.5 - i, 2e-3);
}

// Forces and impulses that no float can follow are caught before anybody feels them.
TYPED_TEST(Quarantine, OverflowsNeverReachTheNeighbours) {
  for (const bool by_force : {true, false}) {
    typename TestFixture::World world;
    add_ground(world);
    const BodyId low = world.create_body(
        {.name = "low", .position = {0, 0.5}, .mass = MassProperties{1e-3, {}, 1}}, {.geometry = Box{1, 1}});
    const BodyId next = add_box(world, {5, 0.5});
    run(world, 5);
    if (by_force) {
      for (int i = 0; i < 3; ++i) world.apply_force(low, {0, 1e12});
    } else {
      world.apply_impulse(low, {1e12, 0});
    }
    world.step();
    ASSERT_EQ(world.events().quarantined.size(), 1u);
    EXPECT_EQ(world.events().quarantined[0].name, "low");
    EXPECT_EQ(world.events().quarantined[0].field, BadField::Velocity);
    EXPECT_EQ(world.events().quarantined[0].step, 6);
    EXPECT_LT(std::abs(world.velocity(low).y), 1);
    run(world, 60);
    EXPECT_NEAR(world.position(next).y, 0.5, 1e-3);
  }
}

// A velocity within the limits leads out of them in time: a position counts as much as a velocity.
TYPED_TEST(Quarantine, EndsAFlightBeyondTheLimits) {
  typename TestFixture::World world(weightless());
  const BodyId far = world.create_body({.name = "far", .position = {9e11, 5}, .velocity = {3e11, 0}},
                                       ShapeDefinition{.geometry = Box{1, 1}});
  const BodyId spins = world.create_body({.name = "spins", .angular_velocity = 9e11},
                                         ShapeDefinition{.geometry = Circle{1e-3}});
  std::vector<BadField> fields;
  for (int i = 0; i < 90; ++i) {
    world.step();
    for (const QuarantineEvent& event : world.events().quarantined) fields.push_back(event.field);
    ASSERT_LE(world.position(far).x, 1e12) << i;
    ASSERT_LE(std::abs(world.angle(spins)), 1e12) << i;
  }
  EXPECT_EQ(fields, (std::vector{BadField::Position, BadField::Angle}));
}

// One of two towers on a ground gets a velocity that is no number, and its contacts hand it to the ground and
// to all that stands on it. That one is taken out; the others are left out of one step.
TYPED_TEST(Quarantine, AFailureThatContactsPassOnTakesItsCauseOut) {
  typename TestFixture::World world(without_sleep());
  add_ground(world);
  std::vector<BodyId> boxes;
  for (int i = 0; i < 8; ++i) boxes.push_back(add_box(world, {i < 4 ? 0.0 : 1.5, 0.5 + i % 4}));
  run(world, 20);
  const int bad = static_cast<int>(boxes[1].index);
  world.data().motion[bad].velocity.x = std::numeric_limits<TypeParam>::quiet_NaN();
  world.step();
  ASSERT_EQ(world.quarantined().size(), 1u);
  EXPECT_EQ(world.quarantined()[0].body, boxes[1]);
  EXPECT_NO_THROW(check_state(world.data()));  // contacts of those left in hold nothing that is not finite
  run(world, 300);
  EXPECT_EQ(world.quarantined().size(), 1u);
  for (const int i : {0, 4, 5, 6, 7}) {
    EXPECT_NEAR(world.position(boxes[i]).y, 0.5 + i % 4, 5e-3) << i;
    EXPECT_NEAR(world.position(boxes[i]).x, i < 4 ? 0 : 1.5, 5e-3) << i;
  }
  EXPECT_NEAR(world.position(boxes[2]).y, 1.5, 5e-3);  // came down by one
}

TYPED_TEST(Quarantine, IsInSnapshotsAndRollbacks) {
  typename TestFixture::World world, other;
  build_bystanders(world);
  const BodyId bad = world.create_body({.name = "bad", .position = {3, 2}}, {.geometry = Box{1, 1}});
  world.create_joint(bad, world.bodies()[5], {.kind = RevoluteDefinition{}});
  run(world, 20);
  Rollback<TypeParam> past(world, 8);
  past.save();
  const std::uint64_t sound = full_hash(world);
  apply_bad_law(world, bad);
  run(world, 3);
  const std::vector<std::byte> bytes = save(world);
  restore(other, bytes);
  EXPECT_TRUE(other.quarantined(bad));
  for (int i = 0; i < 60; ++i) {
    if (i == 30) world.release(bad), other.release(bad);
    world.step(), other.step();
    ASSERT_EQ(full_hash(world), full_hash(other)) << i;
  }
  past.back_to(20);
  EXPECT_EQ(full_hash(world), sound);
  EXPECT_FALSE(world.quarantined(bad));
}

TEST(QuarantineRecording, IsReplayed) {
  const auto file = std::filesystem::temp_directory_path() / "plumb_quarantine_test.rec";
  std::uint64_t hash = 0;
  {
    RecordedWorld<float> world(file);
    const BodyId bad = world.create_body({.mass = MassProperties{1e-3, {}, 1}});
    world.create_body({.position = {4, 0}}, ShapeDefinition{});
    for (int i = 0; i < 40; ++i) {
      if (i == 10) world.apply_impulse(bad, {1e12, 0});
      if (i == 20) world.release(bad);
      if (i == 30) world.set_quarantine(false);
      world.step();
    }
    hash = world->hash();
  }
  Replay<float> replay(file);
  while (replay.step()) {
  }
  EXPECT_EQ(replay.world().hash(), hash);
  EXPECT_FALSE(replay.report().first_difference);
  EXPECT_EQ(replay.report().message, "");
  std::filesystem::remove(file);
}

TYPED_TEST(Quarantine, EndsWithTheBody) {
  typename TestFixture::World world(without_sleep());
  add_ground(world);
  const BodyId bad = add_box(world, {0, 0.5}), on_it = add_box(world, {0, 1.5});
  run(world, 5);
  apply_bad_law(world, bad);
  world.set_type(bad, BodyType::Static);
  world.create_shape(bad, {.geometry = Circle{0.1}, .position = {0.4, 0.4}});
  world.release(bad);
  EXPECT_EQ(world.type(bad), BodyType::Static);
  run(world, 60);
  EXPECT_NEAR(world.position(on_it).y, 1.5, 1e-2);
  apply_bad_law(world, on_it);
  world.step();
  world.destroy(on_it);
  EXPECT_TRUE(world.quarantined().empty());
  save(world);
  run(world, 5);
}

// Its mass as a static body is not known.
TYPED_TEST(Quarantine, ABodyMadeStaticAndDynamicAgainHasItsMass) {
  typename TestFixture::World world(without_sleep());
  const BodyId bad = add_box(world, {0, 0.5});
  run(world, 5);
  apply_bad_law(world, bad);
  world.set_type(bad, BodyType::Static);
  world.create_shape(bad, {.geometry = Box{1, 1}, .position = {1, 0}});
  world.set_type(bad, BodyType::Dynamic);
  EXPECT_NEAR(world.mass(bad), 2, 1e-6);
  world.release(bad);
  EXPECT_NEAR(world.mass(bad), 2, 1e-6);
  save(world);
  const double before = world.velocity(bad).y;
  world.apply_impulse(bad, {0, 2});
  EXPECT_NEAR(world.velocity(bad).y, before + 1, 1e-5);
}

}  // namespace
}  // namespace plumb
