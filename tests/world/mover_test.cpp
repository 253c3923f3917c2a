#include "engine/world/mover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/error.h"
#include "engine/world/queries.h"
#include "tests/world/mover_scene.h"
#include "tests/world/query_truth.h"

namespace plumb {
namespace {

template <class Real>
class Mover : public MoverScene<Real> {};

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Mover, Reals);

TYPED_TEST(Mover, FallsThenWalksOnFlatGround) {
  this->add_floor();
  this->place({0, 1});
  int frames = 0;
  while (!this->frame(0).on_ground) ++frames;
  // v += g dt before each move: after n moves it has fallen g dt^2 n (n + 1) / 2.
  EXPECT_EQ(frames,
            static_cast<int>(std::floor((std::sqrt(1 + 8 * (1 - kSkin) / (kGravity * kDt * kDt)) - 1) / 2)));
  EXPECT_TRUE(this->walk(60, 5));
  EXPECT_NEAR(this->now.position.x, 5, this->kTolerance);
  EXPECT_NEAR(this->now.position.y, kSkin, this->kTolerance);
  EXPECT_EQ(this->now.velocity.x, 5);
  EXPECT_EQ(this->now.velocity.y, 0);
}

TYPED_TEST(Mover, ItsSpeedIsAlongTheSlope) {
  for (const double slope : {-0.6, -0.3, 0.3, 0.6, 0.78}) {
    SCOPED_TRACE(slope);
    this->world = BasicWorld<TypeParam>();
    this->add_static(Box{200, 2}, {std::sin(slope), -std::cos(slope)}, slope);
    // The lower round end rests a skin above the slope, along the slope's normal.
    const Vec2d normal{-std::sin(slope), std::cos(slope)};
    const Vec2d start = (kRadius + kSkin) * normal - Vec2d{0, kRadius};
    this->place(start);
    this->now.on_ground = true;
    EXPECT_TRUE(this->walk(120, 3));
    EXPECT_NEAR(this->now.position.x, start.x + 6 * std::cos(slope), 6 * this->kTolerance);
    EXPECT_NEAR(this->now.position.y, start.y + 6 * std::sin(slope), 6 * this->kTolerance);
    EXPECT_NEAR(dot(this->now.ground_normal, normal), 1, this->kTolerance);
    // It does not creep while it stands.
    const Vec2d here = this->now.position;
    EXPECT_TRUE(this->walk(120, 0));
    EXPECT_NEAR(std::sqrt(length_squared(this->now.position - here)), 0, 1e-9);
  }
}

TYPED_TEST(Mover, IsStoppedByASlopeThatIsTooSteep) {
  this->add_floor();
  this->add_static(Polygon{{{0, 0}, {5, 0}, {5, 10}}}, {3, 0});  // 63 degrees
  this->place({0, kSkin});
  this->walk(120, 4);
  EXPECT_TRUE(this->now.on_ground);
  EXPECT_NEAR(this->now.position.y, kSkin, this->kTolerance);
  // The lower centre's distance from the slope's line is radius + skin: (2 (x - 3) - y) / sqrt(5).
  const double expected = 3 + (kRadius + kSkin - (kRadius + kSkin) * std::sqrt(5.0)) / 2;
  EXPECT_NEAR(this->now.position.x, expected, 1e-4);
  // Jumping into it does not climb it: the height is that of the jump in free air, h = v^2 / 2g.
  this->now.velocity = {4, 3}, this->now.on_ground = false;
  double highest = 0;
  for (int i = 0; i < 60; ++i) highest = std::max(highest, this->frame(4).position.y);
  EXPECT_LT(highest, 3 * 3 / (2 * kGravity) + kSkin);
}

TYPED_TEST(Mover, SlidesDownWhatIsTooSteep) {
  this->add_static(Box{200, 2}, {std::sin(1.2), -std::cos(1.2)}, 1.2);
  this->place(Vec2d{0, 0.1});
  bool stood = false;
  for (int i = 0; i < 60; ++i) stood = this->frame(0).on_ground || stood;
  EXPECT_FALSE(stood);
  // Along the slope: g sin(slope), less what the discrete steps and the fall onto it took.
  const double along = this->now.velocity.x * std::cos(1.2) + this->now.velocity.y * std::sin(1.2);
  EXPECT_NEAR(along, -kGravity * std::sin(1.2), 0.05 * kGravity);
  EXPECT_NEAR(this->now.velocity.x * std::sin(1.2) - this->now.velocity.y * std::cos(1.2), 0, 0.02);
}

TYPED_TEST(Mover, ClimbsStepsUpToTheirHeight) {
  this->add_floor();
  this->add_static(Box{10, 0.3}, {7, 0.15});  // from x = 2, as high as a step may be
  this->place({0, kSkin});
  this->now.on_ground = true;
  EXPECT_TRUE(this->walk(60, 4));
  EXPECT_NEAR(this->now.position.x, 4, this->kTolerance);  // it loses no way on the step
  EXPECT_NEAR(this->now.position.y, 0.3 + kSkin, this->kTolerance);
  EXPECT_TRUE(this->walk(60, -4));
  EXPECT_NEAR(this->now.position.x, 0, this->kTolerance);
  EXPECT_NEAR(this->now.position.y, kSkin, this->kTolerance);
}

TYPED_TEST(Mover, IsStoppedByHigherSteps) {
  for (const double height : {0.22, 0.26, 0.31, 0.5, 3.0}) {
    SCOPED_TRACE(height);
    this->world = BasicWorld<TypeParam>();
    this->options.step_height = height < 0.3 ? height - 0.03 : 0.3;
    this->add_floor();
    this->add_static(Box{10, height}, {7, height / 2});
    this->place({0, kSkin});
    this->now.on_ground = true;
    EXPECT_TRUE(this->walk(120, 4));
    EXPECT_NEAR(this->now.position.y, kSkin, this->kTolerance);
    // A step lower than the round end meets it below its side: there it stands back less.
    const double below = std::max(0.0, kRadius + kSkin - height);
    const double back = std::sqrt((kRadius + kSkin) * (kRadius + kSkin) - below * below);
    EXPECT_NEAR(this->now.position.x, 2 - back, kSkin / 2);
    EXPECT_LT(this->now.position.x, 2 - kRadius * back / (kRadius + kSkin));
  }
}

TYPED_TEST(Mover, RunsUpAndDownStairs) {
  this->add_floor();
  for (int i = 0; i < 10; ++i) this->add_static(Box{20, 0.2}, {12 + 0.3 * i, 0.1 + 0.2 * i});
  this->place({0, kSkin});
  this->now.on_ground = true;
  EXPECT_TRUE(this->walk(120, 4));
  EXPECT_NEAR(this->now.position.x, 8, this->kTolerance);
  EXPECT_NEAR(this->now.position.y, 2 + kSkin, this->kTolerance);
  EXPECT_TRUE(this->walk(120, -4));
  EXPECT_NEAR(this->now.position.x, 0, this->kTolerance);
  EXPECT_NEAR(this->now.position.y, kSkin, this->kTolerance);
}

TYPED_TEST(Mover, FallsOffWhatIsHigherThanAStep) {
  this->add_floor();
  this->add_static(Box{2, 1}, {0, 0.5});
  this->place({0, 1 + kSkin});
  this->now.on_ground = true;
  EXPECT_FALSE(this->walk(60, 4));
  EXPECT_NEAR(this->now.position.y, kSkin, this->kTolerance);
}

TYPED_TEST(Mover, SlidesAlongWallsAtItsTangentialSpeed) {
  const double lean = 0.2;  // the wall leans back by this
  for (const double angle : {0.0, lean}) {
    this->world = BasicWorld<TypeParam>();
    this->add_static(Box{2, 50}, {3, 0}, angle);
    const Vec2d along{-std::sin(angle), std::cos(angle)};
    MoverResult result{.position = {0, 0}, .velocity = 20.0 * Vec2d{1, 0} - 2.0 * along};
    const double speed = dot(result.velocity, along);
    Vec2d before{};
    for (int i = 0; i < 30; ++i) {
      before = result.position;
      result = move(this->world, kPerson, before, result.velocity, kDt);
      result.velocity.x += angle == 0 ? 20.0 : 0;
    }
    result.velocity.x -= angle == 0 ? 20.0 : 0;
    EXPECT_NEAR(dot(result.velocity, along), speed, this->kTolerance * 20);
    EXPECT_NEAR(dot(result.position - before, along), speed * kDt, this->kTolerance);
    EXPECT_NEAR(cross(result.velocity, along), 0, this->kTolerance * 20);
  }
}

TYPED_TEST(Mover, DoesNotCatchOnSeams) {
  for (const bool chain : {false, true}) {
    this->world = BasicWorld<TypeParam>();
    if (chain) {
      ChainDefinition line;
      for (int i = 20; i >= -20; --i) line.points.push_back({0.5 * i, 0});  // its front is up
      this->world.create_chain(this->world.create_body({.type = BodyType::Static}), line);
    } else {
      for (int i = -10; i < 10; ++i) this->add_static(Box{1, 1}, {i + 0.5, -0.5});
    }
    this->place({-5, kSkin});
    this->now.on_ground = true;
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(this->frame(5).on_ground);
      EXPECT_NEAR(this->now.position.y, kSkin, 1e-7);
      EXPECT_NEAR(this->now.position.x, -5 + 5 * kDt * (i + 1), 1e-7);
    }
  }
}

TYPED_TEST(Mover, StaysInCornersWithoutTrembling) {
  this->add_floor();
  this->add_static(Box{1, 4}, {3, 2}, 0.3);  // leans over it
  this->place({0, kSkin});
  this->now.on_ground = true;
  this->walk(120, 5);
  const Vec2d here = this->now.position;
  for (int i = 0; i < 60; ++i) {
    this->frame(5);
    EXPECT_LT(std::sqrt(length_squared(this->now.position - here)), 1e-9);
    EXPECT_EQ(this->now.velocity.x, 0);
  }
}

TYPED_TEST(Mover, LeavesWhatItOverlapsTheShortWay) {
  this->add_floor();
  this->add_static(Box{4, 4}, {4, 2});
  const MoverResult out = move(this->world, kPerson, {1.8, -0.1}, {0, 0}, kDt);
  EXPECT_FALSE(out.squeezed);
  EXPECT_NEAR(out.position.x, 2 - kRadius - kSkin, this->kTolerance);
  EXPECT_NEAR(out.position.y, kSkin, this->kTolerance);
}

TYPED_TEST(Mover, GetsThroughNothingAtTenKilometresASecond) {
  this->add_floor();
  this->add_static(Segment{{0, -5}, {0, 5}}, {7, 0});
  for (const double speed : {1e2, 1e4, 1e6}) {
    const MoverResult hit = move(this->world, kPerson, {-40, 1}, {speed, 0}, 0.5);
    EXPECT_NEAR(hit.position.x, 7 - kRadius - kSkin, this->kTolerance);
    EXPECT_EQ(hit.velocity.x, 0);
    const MoverResult down = move(this->world, kPerson, {0, 30}, {0, -speed}, 0.5);
    EXPECT_NEAR(down.position.y, kSkin, this->kTolerance);
    EXPECT_TRUE(down.on_ground);
  }
}

TYPED_TEST(Mover, ComesNearerThanItsSkinToNothing) {
  using namespace query_truth;
  Random random(11);
  std::vector<std::pair<ShapeId, Outline>> all;
  for (int i = 0; i < 80; ++i) {
    const ShapeGeometry geometry = random_geometry(random);
    const Vec2d at = random.within(12);
    const double angle = random.uniform(-3, 3);
    this->add_static(geometry, at, angle);
    all.push_back({{}, placed(outline_of(geometry), at.as<Wide>(), angle)});
  }
  const Outline person = outline_of(kPerson);
  MoverResult mover{.position = {0, 30}};
  Wide least = 1;
  int moved = 0, stood = 0;
  for (int i = 0; i < 3000; ++i) {
    if (i % 50 == 0) mover = {.position = random.within(12)};
    if (i % 5 == 0) mover.velocity = random.within(std::pow(10.0, random.uniform(-1, 4)));
    const bool starts_free = [&] {
      Wide gap_here = 1;
      for (const auto& [id, shape] : all)
        gap_here = std::min(gap_here, gap(shape, placed(person, mover.position.as<Wide>(), 0)));
      return gap_here > 0.9L * kSkin;
    }();
    mover.velocity.y -= kGravity * kDt;
    mover = move(this->world, kPerson, mover.position, mover.velocity, kDt, this->options);
    stood += mover.on_ground;
    if (!starts_free) continue;
    ++moved;
    for (const auto& [id, shape] : all)
      least = std::min(least, gap(shape, placed(person, mover.position.as<Wide>(), 0)));
  }
  EXPECT_GT(moved, 1500);
  EXPECT_GT(stood, 100);
  EXPECT_GT(least, kSkin - this->kTolerance) << moved;
}

TYPED_TEST(Mover, JumpsThroughAChainFromBelowAndLandsOnIt) {
  this->add_floor();
  this->world.create_chain(this->world.create_body({.type = BodyType::Static, .position = {0, 1}}),
                           ChainDefinition{.points = {{3, 0}, {-3, 0}}});
  this->place({0, kSkin});
  this->now.velocity = {0, 6};
  double highest = 0;
  for (int i = 0; i < 120; ++i) highest = std::max(highest, this->frame(0).position.y);
  EXPECT_NEAR(highest, 6 * 6 / (2 * kGravity), 0.1);  // nothing held it up
  EXPECT_TRUE(this->now.on_ground);
  EXPECT_NEAR(this->now.position.y, 1 + kSkin, this->kTolerance);
}

TYPED_TEST(Mover, IsTheSameFarFromTheOrigin) {
  const Vec2d far{4194304, -8388608};
  const auto run = [&](Vec2d origin) {
    this->world = BasicWorld<TypeParam>();
    this->add_static(Box{200, 2}, origin + Vec2d{0, -1});
    this->add_static(Box{10, 0.25}, origin + Vec2d{7, 0.125});
    this->add_static(Box{1, 4}, origin + Vec2d{5, 2}, 0.25);
    this->place(origin + Vec2d{0, kSkin});
    this->now.on_ground = true;
    this->walk(90, 5);
    return this->now.position - origin;
  };
  const Vec2d near_by = run({0, 0}), far_away = run(far);
  EXPECT_NEAR(near_by.x, far_away.x, 1e-7);  // a double there is 1e-9 m fine
  EXPECT_NEAR(near_by.y, far_away.y, 1e-7);
}

TYPED_TEST(Mover, RefusesWhatMakesNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const BasicWorld<TypeParam> empty;
  EXPECT_THROW(move(empty, kPerson, {nan, 0}, {}, kDt), Error);
  EXPECT_THROW(move(empty, kPerson, {}, {0, nan}, kDt), Error);
  EXPECT_THROW(move(empty, kPerson, {}, {}, 0), Error);
  EXPECT_THROW(move(empty, Capsule{{}, {0, 1}, 0}, {}, {}, kDt), Error);
  EXPECT_THROW(move(empty, kPerson, {}, {}, kDt, {.up = {0, 0}}), Error);
  EXPECT_THROW(move(empty, kPerson, {}, {}, kDt, {.step_height = -1}), Error);
  EXPECT_THROW(move(empty, kPerson, {}, {}, kDt, {.mass = -1}), Error);
}

}  // namespace
}  // namespace plumb
