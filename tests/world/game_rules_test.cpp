// A game sets its own rules: its filter, 64 categories, loads that are events, thresholds, continuous
// collision by body. Impulses of whole steps are held against the change of momentum.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/scene/json.h"
#include "engine/world/queries.h"
#include "engine/world/recorder.h"
#include "engine/world/replay.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "engine/world/world.h"

namespace plumb {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr double kG = 9.81, kDt = 1.0 / 60;

template <class World>
BodyId add_ground(World& world, const ShapeDefinition& shape = {.geometry = Box{40, 2}}) {
  return world.create_body({.type = BodyType::Static, .position = {0, -1}}, shape);
}

// ---- Impulses of whole steps

class StepImpulses : public testing::TestWithParam<Solver> {};

// Momentum: what gravity and contacts give a body in a step is what its velocity changes by, with any solver.
TEST_P(StepImpulses, AreTheChangeOfMomentum) {
  DoubleWorld world({.sleeping = false, .solver = GetParam()});
  add_ground(world);
  const BodyId box =
      world.create_body({.position = {0, 0.8}}, {.geometry = Box{1, 1}, .density = 3, .hit_events = true});
  double given = 0;
  for (int i = 0; i < 90; ++i) {
    const double before = world.velocity(box).y;
    world.step(kDt);
    double impulse = 0;
    for (const ContactReading& c : world.contacts(box)) impulse += c.step_impulse * c.normal.y;
    // Rounding of a few dozen impulses up to 10 N s.
    ASSERT_NEAR(3 * (world.velocity(box).y - before + kG * kDt), impulse, 1e-12) << "step " << i;
    given += impulse;
  }
  EXPECT_NEAR(given, 3 * kG * 1.5, 1e-2) << "it rests in the end";
}
INSTANTIATE_TEST_SUITE_P(Each, StepImpulses,
                         testing::Values(Solver::SoftSteps, Solver::SequentialImpulses, Solver::Direct),
                         [](const auto& each) { return kSolverNames[static_cast<int>(each.param)]; });

TEST(StepImpulse, OfAJointedIslandIsTheChangeOfMomentum) {
  DoubleWorld world({.sleeping = false, .solver = Solver::Direct});
  add_ground(world);
  const BodyId light = world.create_body({.position = {0, 0.7}}, {.geometry = Box{1, 1}, .hit_events = true});
  const BodyId heavy = world.create_body({.position = {0, 1.7}}, {.geometry = Box{1, 1}, .density = 50});
  world.create_joint(light, heavy, {.kind = WeldDefinition{.anchor_a = {0, 0.5}, .anchor_b = {0, -0.5}}});
  const auto momentum = [&] { return world.velocity(light).y + 50 * world.velocity(heavy).y; };
  for (int i = 0; i < 90; ++i) {
    const double before = momentum();
    world.step(kDt);
    double impulse = 0;
    for (const ContactReading& c : world.contacts(light)) impulse += c.step_impulse * c.normal.y;
    // Rounding of impulses up to 100 N s.
    ASSERT_NEAR(momentum() - before + 51 * kG * kDt, impulse, 1e-10) << "step " << i;
  }
}

TEST(StepImpulse, OfAHitIsTheBlow) {
  DoubleWorld world({.gravity = {0, 0}});
  add_ground(world);
  const BodyId ball = world.create_body(
      {.position = {0, 2}, .velocity = {0, -3}},
      {.geometry = Circle{0.5}, .material = {.friction = 0, .restitution = 0.5}, .hit_events = true});
  const double mass = world.mass(ball);
  std::vector<HitEvent> hits;
  for (int i = 0; i < 60; ++i) {
    world.step(kDt);
    hits.insert(hits.end(), world.events().hits.begin(), world.events().hits.end());
  }
  ASSERT_THAT(hits, SizeIs(1));
  EXPECT_NEAR(hits[0].speed, 3, 1e-9);
  EXPECT_NEAR(hits[0].impulse, mass * 3 * 1.5, 1e-9) << "m (1 + e) v";
}

TEST(StepImpulse, OfARestingBoxIsItsWeightInAStepAndNothingUnlessAskedFor) {
  World world({.sleeping = false});
  add_ground(world);
  const BodyId asked = world.create_body({.position = {0, 0.5}}, {.geometry = Box{1, 1}, .hit_events = true});
  const BodyId plain = world.create_body({.position = {3, 0.5}}, {.geometry = Box{1, 1}});
  for (int i = 0; i < 120; ++i) world.step(kDt);
  ASSERT_THAT(world.contacts(asked), SizeIs(1));
  EXPECT_NEAR(world.contacts(asked)[0].step_impulse, kG * kDt, 1e-4 * kG * kDt);
  ASSERT_THAT(world.contacts(plain), SizeIs(1));
  EXPECT_EQ(world.contacts(plain)[0].step_impulse, 0);
}

TEST(StepImpulse, OfManyContactsSideBySideIsThatOfEachAlone) {
  const auto run = [](int boxes) {
    World world({.sleeping = false});
    add_ground(world, {.geometry = Box{400, 2}});
    std::vector<BodyId> all;
    for (int i = 0; i < boxes; ++i)
      all.push_back(
          world.create_body({.position = {3.0 * i, 0.6}}, {.geometry = Box{1, 1}, .hit_events = true}));
    std::vector<double> impulses;
    for (int i = 0; i < 60; ++i) {
      world.step(kDt);
      for (const BodyId body : all)
        for (const ContactReading& c : world.contacts(body)) impulses.push_back(c.step_impulse);
    }
    return impulses;
  };
  const std::vector<double> many = run(40), few = run(1);
  ASSERT_EQ(many.size(), 40 * few.size());
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(many[40 * i], few[i]);
}

// ---- A filter of the game's own

TEST(GameFilter, KeepsPairsApartThatItRefuses) {
  World world;
  const BodyId ground = add_ground(world);
  const BodyId ghost = world.create_body({.position = {0, 0.5}}, {.geometry = Box{1, 1}, .user_data = 7});
  const BodyId solid = world.create_body({.position = {3, 0.5}}, {.geometry = Box{1, 1}});
  int asked = 0;
  world.on_filter([&](ShapeId a, ShapeId b) {
    ++asked;
    EXPECT_LT(a.index, b.index);
    return world.user_data(a) != 7 && world.user_data(b) != 7;
  });
  for (int i = 0; i < 60; ++i) world.step(kDt);
  EXPECT_GE(asked, 2);
  EXPECT_LT(world.position(ghost).y, -3);
  EXPECT_NEAR(world.position(solid).y, 0.5, 0.01);
  EXPECT_THAT(world.contacts(ghost), IsEmpty());
  EXPECT_THAT(world.contacts(ground), SizeIs(1));
}

TEST(GameFilter, AlsoLetsFastBodiesThrough) {
  for (const bool passes : {false, true}) {
    World world({.gravity = {0, 0}});
    world.create_body({.type = BodyType::Static}, {.geometry = Box{0.05, 4}});
    const BodyId bullet =
        world.create_body({.position = {-5, 0}, .velocity = {500, 0}}, {.geometry = Circle{0.05}});
    world.on_filter([passes](ShapeId, ShapeId) { return !passes; });
    for (int i = 0; i < 10; ++i) world.step(kDt);
    EXPECT_EQ(world.position(bullet).x > 0, passes);
  }
}

TEST(GameFilter, IsAskedAgainWhenAFilterIsSet) {
  World world;
  add_ground(world);
  const BodyId box = world.create_body({.position = {0, 0.5}}, {.geometry = Box{1, 1}});
  bool open = false;
  world.on_filter([&](ShapeId, ShapeId) { return !open; });
  for (int i = 0; i < 120; ++i) world.step(kDt);
  EXPECT_NEAR(world.position(box).y, 0.5, 0.01);
  open = true;
  const ShapeId shape = world.shapes(box)[0];
  world.set_filter(shape, world.filter(shape));
  for (int i = 0; i < 60; ++i) world.step(kDt);
  EXPECT_LT(world.position(box).y, -3) << "the trap door opened under a sleeping box";
}

TEST(GameFilter, MayReadTheWorldAndNotChangeIt) {
  World world;
  add_ground(world);
  const BodyId box = world.create_body({.position = {0, 0.5}}, {.geometry = Box{1, 1}});
  int refused = 0;
  world.on_filter([&](ShapeId a, ShapeId) {
    EXPECT_TRUE(world.valid(world.body(a)));
    try {
      world.destroy(box);
    } catch (const Error& error) {
      refused += error.kind() == Error::Kind::Unsupported;
    }
    return true;
  });
  world.step(kDt);
  EXPECT_GT(refused, 0);
  world.on_filter([](ShapeId, ShapeId) -> bool { throw std::runtime_error("mine"); });
  world.set_filter(world.shapes(box)[0], {});
  EXPECT_THROW(world.step(kDt), std::runtime_error);
  world.on_filter({});
  for (int i = 0; i < 60; ++i) world.step(kDt);
  EXPECT_NEAR(world.position(box).y, 0.5, 0.01) << "the world goes on";
}

TEST(GameFilter, GivesTheSameBitsOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    World world({.threads = threads});
    add_ground(world, {.geometry = Box{100, 2}});
    for (int i = 0; i < 400; ++i)
      world.create_body({.position = {0.9 * (i % 20), 1 + 0.9 * static_cast<double>(i / 20)}},
                        {.geometry = Circle{0.4}, .user_data = std::uint64_t(i % 3)});
    world.on_filter([&](ShapeId a, ShapeId b) { return world.user_data(a) + world.user_data(b) != 3; });
    for (int i = 0; i < 120; ++i) world.step(kDt);
    return full_hash(world);
  };
  EXPECT_EQ(run(1), run(2));
}

// ---- 64 categories

TEST(Categories, OfAll64BitsDecide) {
  // The bits 0 and 32, 1 and 33 share places in the trees: only the exact bits may count.
  for (const auto& [category, mask, touches] : {std::tuple{1ull << 40, 1ull << 40, true},
                                                {1ull << 40, 1ull << 41, false},
                                                {1ull << 32, 1ull, false},
                                                {1ull, 1ull << 32, false},
                                                {1ull << 63, 1ull << 63, true},
                                                {1ull << 33 | 1, 1ull << 33, true}}) {
    World world;
    const BodyId ground = add_ground(world, {.geometry = Box{40, 2}, .filter = {.category = category}});
    const BodyId box = world.create_body(
        {.position = {0, 0.5}}, {.geometry = Box{1, 1}, .filter = {.category = ~0ull, .mask = mask}});
    for (int i = 0; i < 60; ++i) world.step(kDt);
    EXPECT_EQ(world.position(box).y > 0, touches) << category << ' ' << mask;
    const QueryFilter looks{.mask = mask, .ignore = box};
    EXPECT_EQ(ray_cast_closest(world, {5, 5}, {0, -9}, looks).has_value(), touches);
    std::vector<ShapeId> found;
    overlap_box(world, {{8, -1}, {9, 0}}, looks, found);
    EXPECT_EQ(!found.empty(), touches);
    EXPECT_EQ(nearest(world, {9, 0.5}, 1, looks).has_value(), touches);
    EXPECT_EQ(world.filter(world.shapes(ground)[0]).category, category);
  }
}

TEST(Categories, GoThroughScenesSnapshotsAndRecordings) {
  const Filter filter{.category = 1ull << 63 | 5, .mask = ~(1ull << 40), .group = -2};
  Scene scene;
  scene.bodies.push_back(
      {.name = "ball", .mass = 1, .shapes = {{.geometry = Circle{0.5}, .filter = filter}}});
  EXPECT_EQ(scene_from_json(to_json(scene)).bodies[0].shapes[0].filter, filter);
  EXPECT_EQ(scene_from_json(R"({"name": "s", "bodies": [{"name": "b", "mass": 1, "shapes": [{"type": "circle",
    "radius": 1, "filter": {"category": 18446744073709551615, "mask": -1}}]}]})")
                .bodies[0]
                .shapes[0]
                .filter,
            (Filter{.category = ~0ull, .mask = ~0ull}));

  World world;
  const BodyId body = world.create_body({}, {.geometry = Circle{0.5}, .filter = filter});
  World restored;
  restore(restored, save(world));
  EXPECT_EQ(restored.filter(restored.shapes(body)[0]), filter);

  const std::filesystem::path file = testing::TempDir() + "categories.plumbrec";
  {
    RecordedWorld<float> recorded(file);
    const BodyId made = recorded.create_body({}, {.geometry = Circle{0.5}});
    recorded.set_filter(recorded->shapes(made)[0], filter);
    recorded.step();
  }
  Replay<float> replay(file);
  while (replay.step()) {
  }
  EXPECT_EQ(replay.world().filter(replay.world().shapes(replay.world().bodies()[0])[0]), filter);
  EXPECT_FALSE(replay.report().first_difference);
}

// ---- Loads of joints

struct Hanging {
  explicit Hanging(const JointDefinition& definition) {
    hook = world.create_body({.type = BodyType::Static});
    ball = world.create_body({.position = {0, -1}, .mass = MassProperties{2, {}, 0.5}},
                             {.geometry = Circle{0.2}});
    joint = world.create_joint(hook, ball, definition);
  }
  World world{WorldDefinition{.sleeping = false}};
  BodyId hook, ball;
  JointId joint;
};

TEST(JointLoads, AreReportedFromTheirLimitOn) {
  const JointKind rod = DistanceDefinition{.length = 1};
  for (const auto& [limit, reports] : {std::pair{0.9, true}, {1.1, false}, {0.0, false}}) {
    Hanging at({.kind = rod, .report_force = limit * 2 * kG});
    for (int i = 0; i < 30; ++i) at.world.step(kDt);
    ASSERT_THAT(at.world.events().loaded, SizeIs(reports ? 1 : 0));
    if (!reports) continue;
    EXPECT_EQ(at.world.events().loaded[0].joint, at.joint);
    EXPECT_NEAR(at.world.events().loaded[0].force, 2 * kG, 1e-3) << "the weight";
    EXPECT_THAT(at.world.events().broken, IsEmpty());
  }
}

TEST(JointLoads, MayBeSetLaterAndGoThroughSnapshots) {
  Hanging at({.kind = DistanceDefinition{.length = 1}});
  at.world.set_load_events(at.joint, 10, 0);
  EXPECT_EQ(at.world.definition(at.joint).report_force, 10);
  World other;
  restore(other, save(at.world));
  other.step(kDt);
  EXPECT_THAT(other.events().loaded, SizeIs(1));
  other.set_load_events(at.joint, 0, 0);
  other.step(kDt);
  EXPECT_THAT(other.events().loaded, IsEmpty());
  EXPECT_THROW(other.set_load_events(at.joint, -1, 0), Error);
}

TEST(JointLoads, ABreakingJointReportsItsLastLoad) {
  Hanging at({.kind = DistanceDefinition{.length = 1}, .break_force = 15, .report_force = 12});
  at.world.step(kDt);
  ASSERT_THAT(at.world.events().broken, SizeIs(1));
  EXPECT_THAT(at.world.events().loaded, SizeIs(1));
  EXPECT_FALSE(at.world.valid(at.joint));
}

// A motor without force holds nothing: it only keeps the bodies from colliding.
TEST(JointLoads, AMotorWithoutForceOnlySwitchesContactsOff) {
  DoubleWorld world;
  const BodyId a = world.create_body({.position = {0, 0}}, {.geometry = Box{1, 1}});
  const BodyId b = world.create_body({.position = {0.5, 0}, .velocity = {1, 2}, .angular_velocity = 1},
                                     {.geometry = Box{1, 1}});
  world.create_joint(a, b, {.kind = MotorDefinition{}});
  for (int i = 0; i < 60; ++i) world.step(kDt);
  EXPECT_EQ(world.counts().contacts, 0);
  const double fall = kG / 2;
  EXPECT_NEAR(world.position(a).y, -fall, 1e-9);
  EXPECT_NEAR(world.position(b).x, 1.5, 1e-9);
  EXPECT_NEAR(world.position(b).y, 2 - fall, 1e-9);
  EXPECT_NEAR(world.angle(b), 1, 1e-9);
}

// ---- Continuous collision a body, thresholds

TEST(ContinuousBodies, TunnelOnlyWhereItIsSwitchedOff) {
  World world({.gravity = {0, 0}});
  world.create_body({.type = BodyType::Static}, {.geometry = Box{0.05, 40}});
  std::vector<BodyId> bullets;
  for (int i = 0; i < 3; ++i)
    bullets.push_back(world.create_body(
        {.position = {-5, 2.0 * i}, .velocity = {500, 0}, .continuous = i != 1}, {.geometry = Circle{0.05}}));
  world.set_continuous(bullets[2], false);
  EXPECT_TRUE(world.continuous(bullets[0]));
  EXPECT_FALSE(world.continuous(bullets[1]));
  World restored;
  restore(restored, save(world));
  for (int i = 0; i < 10; ++i) restored.step(kDt);
  EXPECT_LT(restored.position(bullets[0]).x, 0);
  EXPECT_GT(restored.position(bullets[1]).x, 0);
  EXPECT_GT(restored.position(bullets[2]).x, 0);
}

TEST(Thresholds, OfHitsBouncesAndSleepAreWhatWasSet) {
  const auto drop = [](const Thresholds& thresholds, double speed) {
    World world({.gravity = {0, 0}, .thresholds = thresholds});
    add_ground(world);
    const BodyId ball =
        world.create_body({.position = {0, 0.6}, .velocity = {0, -speed}},
                          {.geometry = Circle{0.5}, .material = {.restitution = 1}, .hit_events = true});
    std::size_t hits = 0;
    for (int i = 0; i < 60; ++i) world.step(kDt), hits += world.events().hits.size();
    return std::pair{hits, world.velocity(ball).y};
  };
  EXPECT_EQ(drop({}, 0.4).first, 0u) << "less than an extent of 0.5 m a second";
  EXPECT_EQ(drop({.hit = 0.3}, 0.4).first, 1u);
  EXPECT_EQ(drop({.hit = 2}, 1.5).first, 0u);
  EXPECT_NEAR(drop({.bounce = 0.3}, 0.4).second, 0.4, 1e-5);
  EXPECT_NEAR(drop({.bounce = 0.5}, 0.4).second, 0, 1e-5);

  for (const auto& [sleep, asleep] : {std::pair{-1.0, false}, {0.5, true}}) {
    World world({.gravity = {0, 0}, .thresholds = {.sleep = sleep}});
    const BodyId slow = world.create_body({.velocity = {0.3, 0}}, {.geometry = Circle{0.5}});
    for (int i = 0; i < 60; ++i) world.step(kDt);
    EXPECT_EQ(!world.awake(slow), asleep);
  }
  World world;
  world.set_thresholds({.hit = 3});
  EXPECT_EQ(world.thresholds(), (Thresholds{.hit = 3}));
  EXPECT_THROW(world.set_thresholds({.bounce = std::nan("")}), Error);
}

}  // namespace
}  // namespace plumb
