// Random calls in scenes, what a world says of itself, discs that collide, formulas, wind.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/geometry.h"
#include "engine/world/world.h"
#include "engine/world/world_data.h"
#include "harness/hunt/calls.h"
#include "harness/hunt/examine.h"
#include "harness/hunt/idiom.h"
#include "harness/hunt/outline.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/relations.h"
#include "harness/hunt/state_watch.h"

namespace plumb::harness::hunt {
namespace {

Engine engine(const char* name) { return Engine(reference::find_backend(name)); }

TEST(Life, ScenesOfAllKindsKeepItsPromises) {
  for (std::uint64_t index = 0; index < 24; ++index) {
    const Case one = compose(47, index);
    for (const char* name : {"plumb-float", "plumb"})
      for (const char* law : {"life", "formulas", "wind"})
        for (const Objection& objection : examine(engine(name), one, law).objections)
          ADD_FAILURE() << name << ", " << index << ", " << law << ": " << objection.what;
  }
}

/// A box that hangs on a hinge above a floor, and a sensor with a ball in it.
struct Scenery {
  World world;
  BodyId floor = world.create_body({.type = BodyType::Static}, {.geometry = Box{20, 1}});
  BodyId post = world.create_body({.type = BodyType::Static, .position = {0, 5}});
  BodyId box = world.create_body({.position = {0, 4}}, {.geometry = Box{1, 1}});
  BodyId gate = world.create_body({.type = BodyType::Static, .position = {5, 1}},
                                  {.geometry = Box{2, 2}, .sensor = true});
  BodyId ball = world.create_body({.position = {5, 1}}, {.geometry = Circle{0.5}, .hit_events = true});
  JointId hinge = world.create_joint(post, box, {.kind = RevoluteDefinition{.anchor_b = {0, 1}}});
  StateWatch<float> watch{world};

  void step() {
    watch.before_step();
    world.step(1.0 / 60, 4);
  }
  std::string run(int steps) {
    for (int i = 0; i < steps; ++i) {
      step();
      if (std::string wrong = watch.after_step(1.0 / 60); !wrong.empty()) return wrong;
    }
    return {};
  }
};

TEST(StateWatch, IsQuietWhereAllAgrees) { EXPECT_EQ(Scenery().run(120), ""); }

TEST(StateWatch, SeesASensorThatSaysWhatIsNotSo) {
  Scenery all;
  ASSERT_EQ(all.run(10), "");
  all.step();
  all.world.set_position(all.ball, {6.6, 1.2}, 0);  // a tenth of a metre outside, and no step has told
  EXPECT_NE(all.watch.after_step(1.0 / 60).find("sees"), std::string::npos);
}

TEST(StateWatch, SeesAVelocityThatNothingGave) {
  Scenery all;
  const BodyId stone =
      all.world.create_body({.position = {-5, 30}, .velocity = {1, 2}}, {.geometry = Circle{0.5}});
  ASSERT_EQ(all.run(10), "");
  all.step();
  all.world.set_velocity(stone, all.world.velocity(stone) + Vec2d{0, 1e-3});
  EXPECT_NE(all.watch.after_step(1.0 / 60).find("touches nothing"), std::string::npos);
}

TEST(StateWatch, SeesAWayThatNoFlightTakes) {
  Scenery all;
  const BodyId stone =
      all.world.create_body({.position = {-5, 30}, .velocity = {1, 2}}, {.geometry = Circle{0.5}});
  ASSERT_EQ(all.run(10), "");
  all.step();
  all.world.set_position(stone, all.world.position(stone) + Vec2d{1e-3, 0}, all.world.angle(stone));
  EXPECT_NE(all.watch.after_step(1.0 / 60).find("touches nothing"), std::string::npos);
}

TEST(StateWatch, SeesABodyThatWakesByItself) {
  Scenery all;
  const BodyId sleeper = all.world.create_body({.position = {-5, 1}}, {.geometry = Box{1, 1}});
  ASSERT_EQ(all.run(120), "");
  ASSERT_FALSE(all.world.awake(sleeper));
  all.step();
  all.world.set_awake(sleeper, true);
  EXPECT_NE(all.watch.after_step(1.0 / 60).find("wakes"), std::string::npos);
}

TEST(StateWatch, SeesALockThatGivesWay) {
  Scenery all;
  const BodyId locked =
      all.world.create_body({.position = {-5, 30}, .lock_rotation = true}, {.geometry = Box{1, 1}});
  ASSERT_EQ(all.run(10), "");
  all.step();
  all.world.set_position(locked, all.world.position(locked), 0.1);
  EXPECT_NE(all.watch.after_step(1.0 / 60).find("locked"), std::string::npos);
}

TEST(StateWatch, SeesALoadThatIsNotTold) {
  Scenery all;
  ASSERT_EQ(all.run(10), "");
  all.step();
  all.world.set_load_events(all.hinge, 0.9 * all.world.read(all.hinge).force, 0);
  EXPECT_NE(all.watch.after_step(1.0 / 60).find("not reported"), std::string::npos);
}

// A needle is let go on its tip: continuous collision stops it within the step, with the rest of its weight.
TEST(StateWatch, JudgesNoBodyThatIsStoppedWhereItIsLetGo) {
  // It falls by a sixth of its length in a step: too far to be lifted off the floor.
  DoubleWorld world({.gravity = {0, -600}, .sleeping = false});
  world.create_body({.type = BodyType::Static, .position = {0, -1}},
                    {.geometry = Box{20, 2}, .material = {.friction = 0}, .hit_events = true});
  const double tip = 0.512, tilt = 0.0795;
  const BodyId needle =
      world.create_body({.position = {0, tip * std::sin(tilt) + 4e-4}, .angle = tilt},
                        {.geometry = Polygon{{{-tip, -0.00016384}, {tip, -0.00016384}, {0, 0.00016384}}},
                         .density = 1,
                         .material = {.friction = 0}});
  StateWatch<double> watch(world);
  bool stopped = false;
  for (int i = 0; i < 3; ++i) {
    world.set_velocity(needle, {}), world.set_angular_velocity(needle, 0);
    watch.before_step();
    world.step(1.0 / 60, 4);
    for (const SweptBody& swept : world.data().scratch.continuous.swept_bodies)
      stopped = stopped || swept.stopped;
    EXPECT_EQ(watch.after_step(1.0 / 60), "") << i;
  }
  EXPECT_TRUE(stopped);
}

TEST(StateWatch, SeesATouchThatDoesNotEnd) {
  Scenery all;
  ASSERT_EQ(all.run(40), "");
  std::string wrong;
  for (int i = 0; i < 4 && wrong.empty(); ++i) {
    all.step();
    // As if the step had lost the ball's contact, and its end.
    all.world.data().position[static_cast<int>(all.ball.index)] += Vec2d{0, 3};
    wrong = all.watch.after_step(1.0 / 60);
    all.world.data().position[static_cast<int>(all.ball.index)] -= Vec2d{0, 3};
  }
  EXPECT_NE(wrong, "");
}

// Points in two shapes at once may be taken for the other's, whosever they are.
TEST(StateWatch, JudgesTouchesOfShapesThatLieAlone) {
  for (const bool alone : {true, false}) {
    Scenery all;
    std::vector<ShapeDefinition> shapes{{.geometry = Box{1, 1}}};
    if (!alone) shapes.push_back({.geometry = Box{1, 1}, .position = {0.3, 0}});
    all.world.create_body({.type = BodyType::Static, .position = {-5, 8}}, {.geometry = Box{4, 1}});
    const BodyId body =
        all.world.create_body({.position = {-5, 12}, .gravity_scale = 0, .may_sleep = false}, shapes);
    std::string wrong;
    for (int i = 0; i < 4 && wrong.empty(); ++i) {
      all.world.step(1.0 / 60, 4);
      all.world.set_position(body, {-5, 8.8}, 0);  // into the shelf, and no step has told
      all.watch.before_step();
      wrong = all.watch.after_step(1.0 / 60);
      all.world.set_position(body, {-5, 12}, 0);
    }
    EXPECT_EQ(wrong.find("no touch has begun") != std::string::npos, alone) << wrong;
  }
}

// A body on a hinge may turn many times and back in a step that its speed takes it far in.
TEST(StateWatch, JudgesTheAnglesOfHingesThatDoNotWhirl) {
  for (const bool whirls : {false, true}) {
    Scenery all;
    ASSERT_EQ(all.run(10), "");
    if (whirls) all.world.set_velocity(all.box, {1e5, 0});
    const double before = all.world.angle(all.box);
    all.step();
    all.world.data().bodies[static_cast<int>(all.box.index)].angle = before + 0.1;  // as if turned back
    const std::string wrong = all.watch.after_step(1.0 / 60);
    EXPECT_EQ(wrong.find("revolutions") != std::string::npos, !whirls) << wrong;
  }
}

TEST(Calls, AWorldThatDoesNotHearThemIsSeen) {
  Scenery deaf, other;
  int wrong = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    Random random(3, i);
    if (!make_call(random, deaf.world, other.world).empty()) ++wrong;
  }
  EXPECT_GT(wrong, 50);
}

TEST(Outlines, HaveTheMomentsOfClosedForms) {
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-3 * std::abs(b); };
  for (const Geometry& geometry :
       {Geometry(Circle{0.7}), Geometry(Box{2, 0.5}), Geometry(Capsule{{-1, 0}, {1, 0}, 0.3})}) {
    const AreaMoments moments = moments_of(outlines_of({.geometry = geometry, .position = {3, 1}}).front());
    const Extent extent = extent_of(geometry);
    EXPECT_TRUE(near(moments.area, extent.area));
    EXPECT_NEAR(moments.centroid.x, 3, 1e-4);
  }
  const AreaMoments box = moments_of(outlines_of({.geometry = Box{2, 0.5}, .position = {3, 1}}).front());
  EXPECT_TRUE(near(box.second, 2 * 0.5 * (4 + 0.25) / 12));
}

/// One ball strikes another of its mass, which rests.
Case blow() {
  Case one;
  one.scene.gravity = {0, 0};
  for (int i = 0; i < 2; ++i)
    one.scene.bodies.push_back({.name = i == 0 ? "striker" : "struck",
                                .position = {3.0 * i, 0},
                                .velocity = {i == 0 ? 4.0 : 0, 0},
                                .shapes = {{.geometry = Circle{0.5}, .friction = 0, .restitution = 1}}});
  one.steps = 60;
  return one;
}

/// The motion in which the struck ball leaves with this share of the striker's speed, which keeps the rest.
Motion handed_on(const Case& one, double share) {
  Motion out{.dt = one.dt};
  for (int k = 0; k <= one.steps; ++k) {
    const double t = k * one.dt, after = std::max(0.0, t - 0.5), before = t - after;
    const Vec2d first{4 * before + 4 * (1 - share) * after, 0}, second{3 + 4 * share * after, 0};
    out.samples.push_back({.states = {{.position = first, .velocity = {after > 0 ? 4 * (1 - share) : 4, 0}},
                                      {.position = second, .velocity = {after > 0 ? 4 * share : 0, 0}}},
                           .present = {true, true},
                           .asleep = {false, false}});
  }
  return out;
}

TEST(Collisions, ABlowIsHandedOnAndOneThatIsNotIsSeen) {
  const Case one = blow();
  for (const char* name : {"plumb-float", "plumb", "plumb-precise"}) {
    const Motion motion = run(engine(name), one);
    const Verdict verdict = collisions_relation(one, engine(name), motion);
    EXPECT_FALSE(verdict) << name << ": " << verdict->what;
  }
  EXPECT_FALSE(collisions_relation(one, engine("plumb-precise"), handed_on(one, 1)));
  EXPECT_TRUE(collisions_relation(one, engine("plumb-precise"), handed_on(one, 0.99)));
}

TEST(Collisions, ScenesOfCrowdsAreDiscsAlone) {
  int judged = 0;
  for (std::uint64_t index = 0; index < 20; ++index)
    if (are_smooth_discs(compose(5, index, {&find_idiom("crowd")}))) ++judged;
  EXPECT_GT(judged, 10);
}

TEST(Costs, AStepThatWasHeldUpOnceIsNoFinding) {
  const Case one = blow();
  Motion motion = run(engine("plumb-float"), one);
  ASSERT_EQ(motion.costs.size(), 60u);
  motion.costs[10] = 5;
  EXPECT_FALSE(cost_law(one, engine("plumb-float"), motion));
}

/// A disc that a formula, or a law, pushes beside its centre.
TEST(AsFormulas, LawsAndFormulasAgreeAndAnotherMotionIsSeen) {
  Case one = blow();
  one.scene.bodies.pop_back();
  one.scene.forces = {PointForce{.body = "striker", .force = {1, 0}, .point = {0, 0.3}, .frame = Frame::Body},
                      LinearDrag{.body = "striker", .coefficient = 0.2}};
  for (const char* name : {"plumb-float", "plumb-precise"}) {
    ASSERT_TRUE(has_laws_as_formulas(one, engine(name)));
    EXPECT_FALSE(as_formulas_relation(one, engine(name), run(engine(name), one))) << name;
  }
  Case other = one;
  other.scene.forces.pop_back();
  EXPECT_TRUE(as_formulas_relation(one, engine("plumb-precise"), run(engine("plumb-precise"), other)));
}

}  // namespace
}  // namespace plumb::harness::hunt
