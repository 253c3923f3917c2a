#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <new>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "engine/encoding/encoding.h"
#include "engine/scene/error.h"
#include "tests/world/solver/allocations.h"
#include "tests/world/solver/joint_bench.h"

/// Checks the state of a set of joints: slots, colours, sleep, changes, bytes.
namespace plumb {
namespace {

constexpr double kStep = 1.0 / 60;

/// A net of `n` x `n` bodies with joints of many kinds, hung from its first row.
template <class Real>
JointBench<Real> net(int n) {
  JointBench<Real> bench;
  bench.gravity = {0, -10};
  for (int i = 0; i < n * n; ++i) {
    const bool fixed = i < n;
    bench.body({1.0 * (i % n), -1.0 * (i / n)}, fixed ? 0 : 1, fixed ? 0 : 4);
  }
  const Spring spring{3, 0.5};
  const auto kind = [&](int i, Vec2d a) -> JointKind {
    const Vec2d b = -a;
    switch (i % 12) {
      case 0:
        return DistanceDefinition{.length = 1};
      case 1:
        return RevoluteDefinition{
            .anchor_a = a, .anchor_b = b, .limits = Range{-0.5, 0.5}, .motor = Motor{1, 0.2}};
      case 2:
        return PrismaticDefinition{
            .anchor_a = a, .anchor_b = b, .limits = Range{-0.1, 0.1}, .spring = spring};
      case 3:
        return WeldDefinition{.anchor_a = a, .anchor_b = b};
      case 4:
        return WeldDefinition{.anchor_a = a, .anchor_b = b, .angular_spring = spring};
      case 5:
        return WheelDefinition{.anchor_a = a, .anchor_b = b, .spring = spring, .motor = Motor{2, 0.5}};
      case 6:
        return MotorDefinition{.target_position = 2 * a, .max_force = 3, .max_torque = 1};
      case 7:
        return GearDefinition{};
      case 8:
        return RatchetDefinition{.tooth = -0.1};
      case 9:
        return FrictionDefinition{.anchor_a = a, .anchor_b = b, .max_force = 1, .max_torque = 1};
      case 10:
        return PulleyDefinition{.ground_a = {-3, 3}, .ground_b = {9, 3}};
      default:
        return RevoluteDefinition{.anchor_a = a, .anchor_b = b};
    }
  };
  for (int i = n; i < n * n; ++i) {
    bench.join(RevoluteDefinition{.anchor_a = {0, -0.5}, .anchor_b = {0, 0.5}}, i - n, i);
    if (i % n > 0) bench.join(kind(i, {0.5, 0}), i - 1, i);
  }
  bench.join(MouseDefinition{.target = {5, -4}, .max_force = 5}, 0, n * n - 1);
  return bench;
}

template <class Real>
std::uint64_t hash(const JointBench<Real>& bench) {
  std::uint64_t h = 14695981039346656037ull;
  const auto add = [&](double value) { h = (h ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211ull; };
  for (std::size_t i = 0; i < bench.motion.size(); ++i) {
    add(bench.position[i].x), add(bench.position[i].y), add(bench.angle[i]);
    add(bench.motion[i].velocity.x), add(bench.motion[i].velocity.y), add(bench.motion[i].angular_velocity);
  }
  return h;
}

template <class Real>
void expect_colours_apart(const JointSet<Real>& joints, const JointBench<Real>& bench) {
  std::vector<std::set<int>> bodies(JointSet<Real>::colours());
  for (int joint = 0; joint < joints.slots(); ++joint) {
    if (!joints.contains(joint) || !joints.active(joint)) continue;
    const int colour = joints.colour(joint);
    ASSERT_LT(colour, JointSet<Real>::colours());
    if (colour == JointSet<Real>::colours() - 1) continue;
    const auto [a, b] = joints.bodies(joint);
    const bool mouse = std::holds_alternative<MouseDefinition>(joints.definition(joint));
    if (bench.dynamic(a) && !mouse) {
      ASSERT_TRUE(bodies[colour].insert(a).second);
    }
    if (bench.dynamic(b)) {
      ASSERT_TRUE(bodies[colour].insert(b).second);
    }
  }
}

TEST(JointState, SlotsAreStableAndTakenAgain) {
  JointBench<float> bench;
  const int a = bench.body({}, 1, 1), b = bench.body({1, 0}, 1, 1), c = bench.body({2, 0}, 1, 1);
  const int first = bench.join(RevoluteDefinition{}, a, b), second = bench.join(WeldDefinition{}, b, c);
  const int third = bench.join(RevoluteDefinition{}, a, c);
  bench.joints.remove(first);
  EXPECT_EQ(bench.joints.count(), 2);
  EXPECT_FALSE(bench.joints.contains(first));
  EXPECT_TRUE(std::holds_alternative<WeldDefinition>(bench.joints.definition(second)));
  EXPECT_EQ(bench.joints.bodies(third), (std::pair{a, c}));
  EXPECT_EQ(bench.join(GearDefinition{}, a, b), first);
  EXPECT_EQ(bench.joints.slots(), 3);
}

TEST(JointState, ColoursShareNoDynamicBody) {
  JointBench<float> bench = net<float>(9);
  expect_colours_apart(bench.joints, bench);
  // Joints come and go, and sleep, in no order.
  unsigned random = 1;
  std::vector<std::pair<JointKind, std::pair<int, int>>> out;
  for (int i = 0; i < 2000; ++i) {
    random = random * 1664525u + 1013904223u;
    const int joint = static_cast<int>(random >> 8) % bench.joints.slots();
    if (bench.joints.contains(joint) && i % 3 == 0) {
      out.push_back({bench.joints.definition(joint), bench.joints.bodies(joint)});
      bench.joints.remove(joint);
    } else if (bench.joints.contains(joint)) {
      bench.joints.set_active(joint, !bench.joints.active(joint));
    } else if (!out.empty()) {
      bench.join(out.back().first, out.back().second.first, out.back().second.second);
      out.pop_back();
    }
    if (i % 100 == 0) expect_colours_apart(bench.joints, bench);
  }
  expect_colours_apart(bench.joints, bench);
  bench.run(0.5, kStep);
  EXPECT_TRUE(std::isfinite(bench.position[50].x));
}

TEST(JointState, ABodyOfManyJointsOverflowsIntoTheLastColour) {
  JointBench<double> bench;
  const int hub = bench.body({}, 1, 1);
  const int last = JointSet<double>::colours() - 1;
  int in_last = 0;
  std::vector<int> joints;
  for (int i = 0; i < 40; ++i) {
    const int rim = bench.body({std::cos(0.1 * i), std::sin(0.1 * i)}, 1, 1);
    joints.push_back(bench.join(RevoluteDefinition{.anchor_a = bench.position[rim]}, hub, rim));
    in_last += bench.joints.colour(joints.back()) == last ? 1 : 0;
  }
  EXPECT_EQ(in_last, 40 - last);
  bench.motion[hub].angular_velocity = 1;
  bench.run(1, kStep);
  for (const int joint : joints) EXPECT_LT(bench.joints.error(joint, bench.bodies()).linear, 0.02);
}

TEST(JointState, BecomingDynamicKeepsColoursApart) {
  JointBench<float> bench;
  const int hub = bench.body({}, 0, 0), a = bench.body({1, 0}, 1, 1), b = bench.body({2, 0}, 1, 1);
  const int first = bench.join(RevoluteDefinition{}, hub, a),
            second = bench.join(RevoluteDefinition{}, hub, b);
  EXPECT_EQ(bench.joints.colour(first), bench.joints.colour(second));  // the hub does not give way
  bench.motion[hub].inverse_mass = bench.motion[hub].inverse_inertia = 1;
  bench.joints.set_dynamic(first, true, true, true);
  bench.joints.set_dynamic(second, true, true, true);
  expect_colours_apart(bench.joints, bench);
  bench.joints.set_dynamic(second, false, true, true);
  bench.joints.set_dynamic(first, false, true, true);
  EXPECT_EQ(bench.joints.colour(first), bench.joints.colour(second));
}

TEST(JointState, SleepingJointsKeepTheirImpulsesAndDoNothing) {
  JointBench<float> bench;
  bench.gravity = {0, -10};
  const int wall = bench.body({}, 0, 0), bar = bench.body({0, -1}, 0.5, 1);
  const int joint = bench.join(RevoluteDefinition{.anchor_b = {0, 1}}, wall, bar);
  bench.run(1, kStep);
  const float force = bench.joints.force(joint);
  EXPECT_NEAR(force, 20, 0.01);
  bench.joints.set_active(joint, false);
  EXPECT_EQ(bench.joints.active_count(), 0);
  bench.gravity = {};
  bench.motion[bar].velocity = {1, 0};
  bench.run(0.5, kStep);
  EXPECT_EQ(bench.motion[bar].velocity.x, 1);  // free
  EXPECT_EQ(bench.joints.force(joint), force);
  bench.joints.set_active(joint, true);
  EXPECT_EQ(bench.joints.active_count(), 1);
  EXPECT_EQ(bench.joints.force(joint), force);
}

TEST(JointState, ChangesKeepImpulsesOfTheSameKind) {
  JointBench<float> bench;
  bench.gravity = {0, -10};
  const int wall = bench.body({}, 0, 0), bar = bench.body({0, -1}, 0.5, 1);
  const RevoluteDefinition plain{.anchor_b = {0, 1}};
  RevoluteDefinition braked = plain;
  braked.motor = Motor{0, 1};
  const int joint = bench.join(plain, wall, bar);
  bench.run(1, kStep);
  const float force = bench.joints.force(joint);
  bench.joints.change(joint, braked);
  EXPECT_EQ(bench.joints.force(joint), force);
  bench.joints.change(joint, plain);
  EXPECT_EQ(bench.joints.force(joint), force);
  bench.joints.change(joint, WeldDefinition{.anchor_b = {0, 1}});
  EXPECT_EQ(bench.joints.force(joint), 0);
  bench.run(1, kStep);
  EXPECT_NEAR(bench.joints.force(joint), 20, 0.01);
}

TEST(JointState, RefusalsChangeNothing) {
  JointBench<float> bench = net<float>(4);
  const int wall = 0, free = 7;
  const auto before = bytes_of(bench.joints);
  EXPECT_THROW(bench.join(RevoluteDefinition{}, free, free), Error);
  EXPECT_THROW(bench.join(DistanceDefinition{.length = -1}, wall, free), Error);
  EXPECT_THROW(bench.joints.change(0, DistanceDefinition{.length = -1}), Error);
  EXPECT_THROW(bench.joints.length(0, bench.bodies()), Error);
  EXPECT_EQ(bytes_of(bench.joints), before);
}

TEST(JointState, RecentringMovesNoAnchor) {
  JointBench<double> bench;
  const int wall = bench.body({}, 0, 0), bar = bench.body({1, 0}, 1, 1);
  const int joint = bench.join(RevoluteDefinition{.anchor_b = {-1, 0}}, wall, bar);
  bench.position[bar] = {1.25, 0};  // the centre of mass is elsewhere now; the body is where it was
  EXPECT_DOUBLE_EQ(bench.joints.error(joint, bench.bodies()).linear, 0.25);
  bench.joints.recentre(joint, {}, {0.25, 0});
  EXPECT_DOUBLE_EQ(bench.joints.error(joint, bench.bodies()).linear, 0);
}

TEST(JointState, OtherSubstepsScaleTheImpulses) {
  JointBench<double> bench;
  bench.gravity = {0, -10};
  const int wall = bench.body({}, 0, 0), bob = bench.body({0, -1}, 0.5, 1);
  const int joint = bench.join(RevoluteDefinition{.anchor_b = {0, 1}}, wall, bob);
  bench.run(2, kStep);
  bench.substeps = 8;
  bench.step(kStep);
  EXPECT_NEAR(bench.joints.force(joint), 20, 1e-6);
  EXPECT_NEAR(bench.motion[bob].velocity.y, 0, 1e-9);
}

TEST(JointState, PlainHingesDoWhatGeneralOnesDo) {
  JointBench<double> plain, general;
  for (JointBench<double>* bench : {&plain, &general}) {
    bench->gravity = {0, -10};
    int previous = bench->body({}, 0, 0);
    for (int i = 0; i < 6; ++i) {
      const int link = bench->body({0.5 + i, 0.1 * i}, 1.0 / (1 + i), 5);
      RevoluteDefinition d{.anchor_a = {i ? 0.5 : 0, 0}, .anchor_b = {-0.5, 0}};
      if (bench == &general) d.motor = Motor{0, 0};  // present, and without any strength
      bench->join(d, previous, link);
      previous = link;
    }
    bench->run(0.5, kStep);
  }
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(plain.position[i].x, general.position[i].x, 1e-10);
    EXPECT_NEAR(plain.position[i].y, general.position[i].y, 1e-10);
    EXPECT_NEAR(plain.motion[i].angular_velocity, general.motion[i].angular_velocity, 1e-8);
  }
}

template <class Real>
void expect_same_continuation() {
  JointBench<Real> bench = net<Real>(7);
  bench.run(0.3, kStep);
  bench.joints.set_active(5, false);
  bench.joints.remove(9);
  bench.run(0.2, kStep);
  const auto bytes = bytes_of(bench.joints);
  JointBench<Real> copy = bench;
  copy.joints = JointSet<Real>();
  Decoder in(bytes, "snapshot");
  copy.joints.restore(in);
  EXPECT_TRUE(in.rest().empty());
  EXPECT_EQ(bytes_of(copy.joints), bytes);
  EXPECT_EQ(copy.joints.count(), bench.joints.count());
  for (int joint = 0; joint < bench.joints.slots(); ++joint) {
    if (!bench.joints.contains(joint)) continue;
    EXPECT_EQ(copy.joints.force(joint), bench.joints.force(joint));
    EXPECT_EQ(copy.joints.torque(joint), bench.joints.torque(joint));
  }
  for (JointBench<Real>* b : {&bench, &copy}) {
    b->run(0.5, kStep);
    b->joints.set_active(5, true);
    b->join(RevoluteDefinition{.anchor_a = {0.5, 0.5}, .anchor_b = {-0.5, -0.5}}, 10, 18);
    b->run(0.5, kStep);
  }
  EXPECT_EQ(hash(copy), hash(bench));
  EXPECT_EQ(bytes_of(copy.joints), bytes_of(bench.joints));
}

TEST(JointState, RestoredSetsContinueWithTheSameBits) {
  expect_same_continuation<float>();
  expect_same_continuation<double>();
}

TEST(JointState, BytesThatAreNoSetAreRefused) {
  JointBench<float> bench = net<float>(5);
  const auto bytes = bytes_of(bench.joints);
  for (std::size_t size = 0; size < bytes.size(); size += 97) {
    Decoder in(std::span<const std::byte>(bytes).first(size), "snapshot");
    EXPECT_THROW(bench.joints.restore(in), Error) << size;
  }
  EXPECT_EQ(bytes_of(bench.joints), bytes);
}

// Joints of one colour are solved side by side: the colours that a body has are those of its joints.
TEST(JointState, ColoursThatAreNotTheJointsAreRefused) {
  JointBench<float> bench = net<float>(5);
  const auto bytes = bytes_of(bench.joints);
  const std::array<std::uint32_t, 2> sound{7, 3}, unsound{3, 3};  // colours, a bit each, and joints of a body
  const std::size_t bodies = 2 * sizeof(std::int32_t) + 2 * sizeof(std::uint64_t);
  std::size_t at = bodies;
  while (std::memcmp(&bytes[at], sound.data(), sizeof sound) != 0 && at < 500) at += sizeof sound;
  ASSERT_LT(at, 500u);
  auto changed = bytes;
  std::memcpy(&changed[at], unsound.data(), sizeof unsound);
  Decoder as_saved(bytes, "snapshot"), as_changed(changed, "snapshot");
  EXPECT_NO_THROW(bench.joints.restore(as_saved));
  EXPECT_THROW(bench.joints.restore(as_changed), Error);
  EXPECT_EQ(bytes_of(bench.joints), bytes);
}

/// The same on every compiler and at every level of optimisation: whoever changes the mathematics changes it.
TEST(JointState, GoldenBits) {
  JointBench<float> bench = net<float>(8);
  bench.run(5, kStep);
  EXPECT_EQ(hash(bench), 11358205572015041337u);
}

TEST(JointState, StepsDoNotAllocate) {
  JointBench<float> bench = net<float>(8);
  bench.run(0.1, kStep);
  const long before = allocations();
  bench.run(0.5, kStep);
  EXPECT_EQ(allocations(), before);
  bench.substeps = 6;
  bench.run(0.1, kStep);
  EXPECT_EQ(allocations(), before);
  void* one = ::operator new(1000);  // a call, which no compiler may leave out
  EXPECT_GT(allocations(), before);  // they are counted
  ::operator delete(one);
}

}  // namespace

}  // namespace plumb
