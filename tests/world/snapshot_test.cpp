#include "engine/world/snapshot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>
#include <string>

#include "engine/scene/error.h"
#include "engine/world/checksum.h"
#include "engine/world/snapshot/world_members.h"
#include "engine/world/state_hash.h"
#include "engine/world/world_data.h"
#include "tests/world/busy_world.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

using test::BusyWorld;
using test::make_busy_world;
using test::run;

template <class Real>
class Snapshot : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Snapshot, Precisions);

// The header: 8 bytes that say what it is, version, layout, then size and checksum of the rest.
constexpr std::size_t kHeader = 32, kSizeAt = 16, kSumAt = 24;

void sign_anew(std::vector<std::byte>& bytes) {
  const std::span<const std::byte> content = std::span(bytes).subspan(kHeader);
  const std::uint64_t size = content.size(), sum = checksum(content);
  std::memcpy(bytes.data() + kSizeAt, &size, 8);
  std::memcpy(bytes.data() + kSumAt, &sum, 8);
}

std::string refusal(BasicWorld<float>& world, std::span<const std::byte> bytes) {
  try {
    restore(world, bytes);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
    return error.subject() == "snapshot" ? error.field() : "another subject: " + error.subject();
  }
  return "";
}

// Never stopped, against saved at step 0, 37, 150, 400 and continued in a fresh world: by every step's hash.
TYPED_TEST(Snapshot, GoesOnWithTheSameBits) {
  for (const int saved_at : {0, 37, 150, 400}) {
    BusyWorld<TypeParam> straight = make_busy_world<TypeParam>();
    run(straight, saved_at);
    const std::vector<std::byte> bytes = save(straight.world);
    BusyWorld<TypeParam> restored = make_busy_world<TypeParam>(16);
    run(restored, 5);
    restore(restored.world, bytes);
    restored.handles() = straight.handles();
    ASSERT_EQ(full_hash(straight.world), full_hash(restored.world));
    for (int i = 0; i < 120; ++i) {
      run(straight, 1), run(restored, 1);
      ASSERT_EQ(straight.world.hash(), restored.world.hash()) << saved_at << " + " << i;
      ASSERT_EQ(full_hash(straight.world), full_hash(restored.world)) << saved_at << " + " << i;
      ASSERT_EQ(straight.world.events().begin.size(), restored.world.events().begin.size());
    }
  }
}

// An island that sleeps is kept asleep, and wakes alike.
TYPED_TEST(Snapshot, KeepsSleepers) {
  BasicWorld<TypeParam> world;
  const BodyId ground = world.create_body({.type = BodyType::Static}, {.geometry = Box{20, 1}});
  std::vector<BodyId> boxes;
  for (int i = 0; i < 5; ++i)
    boxes.push_back(world.create_body({.position = {0, 1.0 + i}}, {.geometry = Box{1, 1}}));
  world.create_joint(ground, boxes[4], {.kind = DistanceDefinition{.length = 8, .range = Range{0, 8}}});
  for (int i = 0; i < 200; ++i) world.step();
  ASSERT_EQ(world.counts().awake, 0);
  BasicWorld<TypeParam> other;
  restore(other, save(world));
  EXPECT_EQ(other.counts().awake, 0);
  EXPECT_EQ(other.counts().touching, world.counts().touching);
  world.apply_impulse(boxes[2], {1, 0}), other.apply_impulse(boxes[2], {1, 0});
  EXPECT_EQ(other.counts().awake, 5);
  for (int i = 0; i < 60; ++i) {
    world.step(), other.step();
    ASSERT_EQ(world.hash(), other.hash());
  }
}

TYPED_TEST(Snapshot, HandlesStayValid) {
  BusyWorld<TypeParam> busy = make_busy_world<TypeParam>();
  run(busy, 50);
  const BodyId gone = busy.pile[20], kept = busy.pile[21];
  busy.world.destroy(gone);
  const std::vector<std::byte> bytes = save(busy.world);
  busy.world.destroy(kept);
  const BodyId later = busy.world.create_body({}, test::shape_of(0));
  EXPECT_EQ(later.index, kept.index);
  restore(busy.world, bytes);
  EXPECT_TRUE(busy.world.valid(kept));
  EXPECT_FALSE(busy.world.valid(gone));
  EXPECT_FALSE(busy.world.valid(later));
  EXPECT_EQ(busy.world.name(kept), "body 21");
  EXPECT_EQ(busy.world.user_data(kept), 21u);
  EXPECT_TRUE(busy.world.valid(busy.joints[0]));
  EXPECT_TRUE(busy.world.valid(busy.chain));
  EXPECT_EQ(busy.world.segments(busy.chain).size(), 6u);
  // The slot that was freed last is taken next, in both.
  const BodyId next = busy.world.create_body({});
  EXPECT_EQ(next.index, gone.index);
}

TYPED_TEST(Snapshot, SavingWhatWasRestoredGivesTheSameBytes) {
  BusyWorld<TypeParam> busy = make_busy_world<TypeParam>();
  run(busy, 200);
  const std::vector<std::byte> bytes = save(busy.world);
  BasicWorld<TypeParam> other;
  restore(other, bytes);
  EXPECT_EQ(save(other), bytes);
  std::vector<std::byte> again{std::byte{1}};
  save(busy.world, again);
  EXPECT_EQ(again, bytes);
}

// Equal worlds in different memory: bytes that are not values (padding, pointers) would differ.
TYPED_TEST(Snapshot, EqualWorldsHaveEqualBytes) {
  const auto make = [](int dirt) {
    std::vector<char> heap(100000, static_cast<char>(dirt));
    heap.clear(), heap.shrink_to_fit();
    auto busy = std::make_unique<BusyWorld<TypeParam>>(make_busy_world<TypeParam>());
    run(*busy, 120);
    return save(busy->world);
  };
  EXPECT_EQ(make(0x11), make(0xEE));
}

TYPED_TEST(Snapshot, LeavesTheHookWhereItIs) {
  BusyWorld<TypeParam> busy = make_busy_world<TypeParam>();
  int asked = 0;
  ShapeDefinition box{.geometry = Box{1, 1}};
  box.pre_solve = true;
  busy.world.create_body({.position = {2, 1}}, box);
  busy.world.on_pre_solve([&](const ContactReading& contact) {
    asked += contact.count > 0 ? 1 : 0;
    return true;
  });
  const std::vector<std::byte> bytes = save(busy.world);
  const test::Handles handles = busy.handles();
  run(busy, 60);
  const int before = asked;
  EXPECT_GT(before, 0);
  restore(busy.world, bytes);
  busy.handles() = handles;
  run(busy, 60);
  EXPECT_EQ(asked, 2 * before);
}

TEST(SnapshotBytes, RefusesTheOtherPrecision) {
  const BasicWorld<double> other;
  BasicWorld<float> world;
  EXPECT_EQ(refusal(world, save(other)), "precision");
}

TEST(SnapshotBytes, RefusesWhatIsNoSnapshot) {
  BusyWorld<float> busy = make_busy_world<float>(15);
  const std::uint64_t before = full_hash(busy.world);
  EXPECT_EQ(refusal(busy.world, {}), "header");
  const std::vector<std::byte> zeros(1000);
  EXPECT_EQ(refusal(busy.world, zeros), "header");
  std::vector<std::byte> bytes = save(busy.world);
  bytes[8] ^= std::byte{2};
  EXPECT_EQ(refusal(busy.world, bytes), "version");
  bytes = save(busy.world);
  bytes.push_back(std::byte{0});
  EXPECT_EQ(refusal(busy.world, bytes), "size");
  sign_anew(bytes);
  EXPECT_EQ(refusal(busy.world, bytes), "size");
  EXPECT_EQ(full_hash(busy.world), before);
}

// No cut and no flipped bit goes unnoticed, and the world stays what it was.
TEST(SnapshotBytes, RefusesEveryTruncationAndFlippedBit) {
  BusyWorld<float> busy = make_busy_world<float>(16);
  run(busy, 90);
  const std::vector<std::byte> bytes = save(busy.world);
  const std::uint64_t before = full_hash(busy.world);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 97) {
    EXPECT_NE(refusal(busy.world, std::span(bytes).first(size)), "") << size;
  }
  std::vector<std::byte> changed = bytes;
  for (std::size_t at = 0; at < bytes.size(); at += 1 + at / 211) {
    changed[at] ^= std::byte{1} << (at % 8);
    EXPECT_NE(refusal(busy.world, changed), "") << at;
    changed[at] = bytes[at];
  }
  EXPECT_EQ(full_hash(busy.world), before);
}

// Two sign bits: a sum whose upper bits carry nothing downwards would let them cancel.
TEST(SnapshotBytes, ChecksumSeesTwoFlippedSigns) {
  std::vector<std::byte> bytes(64);
  const std::uint64_t before = checksum(bytes);
  bytes[15] = bytes[39] = std::byte{0x80};
  EXPECT_NE(checksum(bytes), before);
}

// A cut with a fitting checksum is refused as well: by what it holds.
TEST(SnapshotBytes, RefusesSignedTruncations) {
  BusyWorld<float> busy = make_busy_world<float>(16);
  run(busy, 90);
  const std::vector<std::byte> bytes = save(busy.world);
  for (std::size_t size = kHeader; size < bytes.size(); size += 1 + size / 61) {
    std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    sign_anew(cut);
    EXPECT_NE(refusal(busy.world, cut), "") << size;
  }
}

// Bytes that somebody changed on purpose, with the checksum made to fit: refused, or a world that can be
// stepped, changed and saved without reading or writing where nothing is (sanitizers watch), even though its
// physics may be nonsense.
TEST(SnapshotBytes, SignedDamageIsRefusedOrHarmless) {
  BusyWorld<float> busy = make_busy_world<float>(16);
  run(busy, 140);
  const std::vector<std::byte> bytes = save(busy.world);
  test::Random random;
  int refused = 0, taken = 0;
  std::vector<std::byte> changed = bytes;
  for (std::size_t at = kHeader; at < bytes.size(); at += 1 + static_cast<std::size_t>(random.below(15))) {
    const int how = random.below(3);
    changed[at] = how == 0   ? bytes[at] ^ (std::byte{1} << random.below(8))
                  : how == 1 ? std::byte{0xFF}
                             : std::byte{0x7F};
    sign_anew(changed);
    BasicWorld<float> world;
    try {
      restore(world, changed);
      ++taken;
      for (int i = 0; i < 4; ++i) world.step();
      for (const BodyId body : world.bodies()) world.apply_impulse(body, {0.1, 0.1});
      for (const BodyId body : world.bodies()) {
        if (random.below(4) == 0) world.destroy(body);
      }
      world.step();
      save(world);
    } catch (const Error& error) {
      const bool known = error.kind() == Error::Kind::Run || error.subject() == "snapshot";
      EXPECT_TRUE(known || error.kind() == Error::Kind::Value) << error.what();
      ++refused;
    }
    changed[at] = bytes[at];
  }
  // Most bytes are numbers that may be anything.
  EXPECT_GT(refused, 100);
  EXPECT_GT(taken, 100);
}

TYPED_TEST(Snapshot, PlacesFartherThanAnyCallAllowsAreRefused) {
  BusyWorld<TypeParam> busy = make_busy_world<TypeParam>(16);
  run(busy, 20);
  const std::vector<std::byte> sound = save(busy.world);
  for (const double far : {1e15, 1e100, 1e304, -1.7e308}) {
    for (const bool sideways : {false, true}) {
      restore(busy.world, sound);
      Vec2d& position = busy.world.data().position[busy.pile[0].index];
      (sideways ? position.x : position.y) = far;
      BasicWorld<TypeParam> other;
      EXPECT_THROW(restore(other, save(busy.world)), Error) << far;
    }
  }
}

// Impulses on such a body would gain energy without bound.
TYPED_TEST(Snapshot, NegativeInverseMassesAndInertiasAreRefused) {
  BusyWorld<TypeParam> busy = make_busy_world<TypeParam>(16);
  run(busy, 20);
  const std::vector<std::byte> sound = save(busy.world);
  for (const bool of_rotation : {false, true}) {
    restore(busy.world, sound);
    SolverBody<TypeParam>& motion = busy.world.data().motion[busy.pile[0].index];
    TypeParam& inverse = of_rotation ? motion.inverse_inertia : motion.inverse_mass;
    inverse = -inverse;
    BasicWorld<TypeParam> other;
    EXPECT_THROW(restore(other, save(busy.world)), Error) << "of rotation: " << of_rotation;
  }
}

// The middle box of three has a contact above and one below, of two colours: contacts of one are solved side
// by side. The world is told that both are of the first, as no run of it leaves them.
TEST(SnapshotBytes, RefusesContactsOfOneColourThatShareABody) {
  World world(without_sleep());
  add_ground(world);
  for (int i = 0; i < 3; ++i) add_box(world, {0, i + 0.5});
  plumb::run(world, 5);
  const std::vector<std::byte> sound = save(world);
  auto& graph = world.data().graph;
  ASSERT_EQ(graph.colour(0).size(), 1u);
  ASSERT_EQ(graph.colour(1).size(), 1u);
  const int moved = graph.colour(1)[0].contact;
  graph.colour(0).push_back(graph.colour(1)[0]);
  graph.colour(1).clear();
  world.data().contacts[moved].colour = 0;
  world.data().contacts[moved].index = 1;
  const std::vector<std::byte> damaged = save(world);
  World fresh;
  EXPECT_EQ(refusal(fresh, sound), "");
  EXPECT_EQ(refusal(fresh, damaged), "contacts");
}

// A box falls onto the ground and slides: a restored world mixes contacts that begin later by its own rule.
TEST(SnapshotRules, RestoringKeepsTheRulesThatTheWorldHas) {
  const auto ice = [](double, double) { return 0.0; };
  const auto build = [](World& world) {
    world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{60, 2}});
    return world.create_body({.position = {0, 0.6}, .velocity = {3, 0}}, {.geometry = Box{2, 1}});
  };
  const auto speed_after = [](World& world, BodyId box) {
    for (int i = 0; i < 60; ++i) world.step();
    return world.velocity(box).x;
  };
  World plain({.sleeping = false}), slippery({.sleeping = false});
  const BodyId box = build(plain);
  slippery.combine_with(ice, nullptr);
  build(slippery);
  // In the air: no contact has been mixed yet.
  const std::vector<std::byte> from_plain = save(plain), from_slippery = save(slippery);
  restore(slippery, from_plain);
  EXPECT_NEAR(speed_after(slippery, box), 3, 1e-5);
  restore(plain, from_slippery);
  EXPECT_LT(speed_after(plain, box), 0.1);
}

// Shapes of static and kinematic bodies may have a mass that no number holds, or whose reciprocal none holds.
// A dynamic body's may not: the last one would have an inertia of 1.6e-48 kg m^2.
TEST(Snapshot, HoldsBodiesOfAnySize) {
  World world;
  const BodyId huge = world.create_body({.type = BodyType::Kinematic}, {.geometry = Circle{1e12}});
  const BodyId light = world.create_body({.type = BodyType::Static, .position = {3, 4}},
                                         {.geometry = Circle{1e-12}, .density = 1e-12});
  EXPECT_TRUE(std::isfinite(world.centre(light).x));
  EXPECT_EQ(world.position(light), (Vec2d{3, 4}));
  const auto goes_round = [&] {
    const std::vector<std::byte> saved = save(world);
    EXPECT_NO_THROW(restore(world, saved));
  };
  goes_round();
  EXPECT_EQ(world.mass(huge), 0);
  EXPECT_THROW(world.create_body({.position = {9, 9}}, {.geometry = Circle{1e-12}}), Error);
  goes_round();
}

// A world keeps what it has found out about its islands and mechanisms until something changes it; a restored
// one finds it anew.
TYPED_TEST(Snapshot, AfterEachCallARestoredWorldGoesOnAlike) {
  using W = BasicWorld<TypeParam>;
  using Call = void (*)(W&, BodyId, JointId);
  const std::pair<const char*, Call> calls[] = {
      {"no call", [](W&, BodyId, JointId) {}},
      {"set_direct_islands", [](W& w, BodyId, JointId) { w.set_direct_islands(false); }},
      {"set_direct_islands on", [](W& w, BodyId, JointId) { w.set_direct_islands(true); }},
      {"set_solver", [](W& w, BodyId, JointId) { w.set_solver(Solver::Direct); }},
      {"set_solver XPBD", [](W& w, BodyId, JointId) { w.set_solver(Solver::Xpbd); }},
      {"set_iterations", [](W& w, BodyId, JointId) { w.set_iterations(7); }},
      {"set_sleeping", [](W& w, BodyId, JointId) { w.set_sleeping(false); }},
      {"set_gravity",
       [](W& w, BodyId, JointId) {
         w.set_gravity({1, 0});
       }},
      {"set_continuous", [](W& w, BodyId, JointId) { w.set_continuous(false); }},
      {"set_thresholds", [](W& w, BodyId, JointId) { w.set_thresholds({.sleep = 0.5}); }},
      {"set_locks", [](W& w, BodyId body, JointId) { w.set_locks(body, true, false, false); }},
      {"set_type", [](W& w, BodyId body, JointId) { w.set_type(body, BodyType::Static); }},
      {"set_mass", [](W& w, BodyId body, JointId) { w.set_mass(body, {.mass = 900, .inertia = 100}); }},
      {"set_enabled", [](W& w, BodyId body, JointId) { w.set_enabled(body, false); }},
      {"set_awake", [](W& w, BodyId body, JointId) { w.set_awake(body, false); }},
      {"set_position", [](W& w, BodyId body, JointId) { w.set_position(body, {0.3, 0.1}, 1); }},
      {"change", [](W& w, BodyId, JointId joint) { w.change(joint, WeldDefinition{.anchor_b = {0, 1}}); }},
      {"destroy a joint", [](W& w, BodyId, JointId joint) { w.destroy(joint); }},
      {"destroy a body", [](W& w, BodyId body, JointId) { w.destroy(body); }}};
  for (const bool direct : {true, false}) {
    for (const auto& [name, call] : calls) {
      W world({.sleeping = false, .direct_islands = direct});
      const BodyId ground =
          world.create_body({.type = BodyType::Static, .position = {0, -9}}, {.geometry = Box{90, 1}});
      const BodyId bob = world.create_body({.position = {1, -1}}, {.geometry = Box{0.5, 0.5}});
      const JointId hinge = world.create_joint(
          ground, bob, {.kind = RevoluteDefinition{.anchor_a = {0, 9}, .anchor_b = {-1, 1}}});
      BodyId last = ground;
      for (int i = 0; i < 3; ++i) {
        const BodyId next = world.create_body({.position = {9.5 + i, 0}},
                                              {.geometry = Box{0.9, 0.2}, .density = 1 + 30.0 * i});
        world.create_joint(last, next,
                           {.kind = RevoluteDefinition{.anchor_a = i == 0 ? Vec2d{9, 9} : Vec2d{0.5, 0},
                                                       .anchor_b = {-0.5, 0}}});
        last = next;
      }
      for (int i = 0; i < 4; ++i)
        world.create_body({.position = {-9, -8.0 + 1.01 * i}}, {.geometry = Box{1, 1}});
      for (int i = 0; i < 40; ++i) world.step();
      call(world, bob, hinge);
      W restored;
      restore(restored, save(world));
      for (int i = 0; i < 20; ++i) {
        world.step(), restored.step();
        ASSERT_EQ(full_hash(world), full_hash(restored))
            << name << (direct ? ", with" : ", without") << " direct islands, step " << i;
      }
    }
  }
}

// The rules of a pulley and a ratchet follow from what they have met since they were made, and a joint that
// sleeps is not prepared for a step.
TYPED_TEST(Snapshot, JointsThatSleepReadAsBefore) {
  BasicWorld<TypeParam> world({.gravity = {0, 0}});
  const BodyId ground = world.create_body({.type = BodyType::Static});
  const BodyId one = world.create_body({.position = {-1, -2}}, {.geometry = Box{0.5, 0.5}}),
               other = world.create_body({.position = {1, -1.7}}, {.geometry = Box{0.5, 0.5}}),
               wheel = world.create_body({.position = {5, 0}, .angle = 0.73, .angular_velocity = 2},
                                         {.geometry = Circle{0.5}});
  const JointId joints[] = {
      world.create_joint(one, other, {.kind = PulleyDefinition{.ground_a = {-1, 0}, .ground_b = {1, 0}}}),
      world.create_joint(ground, wheel, {.kind = RatchetDefinition{.tooth = 0.3}})};
  EXPECT_EQ(world.read(joints[0]).linear_error, 0) << "before the first step";
  for (int i = 0; i < 20; ++i) world.step();
  world.set_angular_velocity(wheel, 0);
  for (int i = 0; i < 60; ++i) world.step();
  ASSERT_EQ(world.counts().awake, 0);
  BasicWorld<TypeParam> restored;
  restore(restored, save(world));
  for (const JointId joint : joints) {
    const JointReading before = world.read(joint), after = restored.read(joint);
    EXPECT_EQ(before.linear_error, after.linear_error);
    EXPECT_EQ(before.angular_error, after.angular_error);
  }
  EXPECT_LT(world.read(joints[0]).linear_error, 1e-5);
}

}  // namespace
}  // namespace plumb
