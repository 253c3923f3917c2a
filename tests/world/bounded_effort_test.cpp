#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/world/state/constants.h"
#include "engine/world/world_data.h"
#include "tests/world/support.h"

// Mechanisms that strike many bodies at once are the hardest to solve as one: no impulse is known from the
// last step, and links jerk so far that substeps are divided. The effort of a step is bounded all the same.
namespace plumb {
namespace {

constexpr double kPi = 3.14159265358979;

// A ball on a chain of hinged links, 4 m long, that swings into a stack of 20 loose bricks.
struct WreckingBall {
  WreckingBall(int links, double kg) : length(4.0 / links) {
    BodyDefinition mast;
    mast.type = BodyType::Static;
    BodyId last = world.create_body(mast, ShapeDefinition{.geometry = Box{60, 2}, .position = {0, -1}});
    Vec2d anchor{0, kHeight};
    constexpr double kAngle = 1.2;  // rad, from the vertical
    const Vec2d along{-std::sin(kAngle), -std::cos(kAngle)};
    const auto join = [&](BodyId next, Vec2d at) {
      world.create_joint(last, next, {.kind = RevoluteDefinition{.anchor_a = anchor, .anchor_b = at}});
    };
    for (int i = 0; i < links; ++i) {
      BodyDefinition body;
      body.position = Vec2d{0, kHeight} + (length * (i + 0.5)) * along;
      body.angle = std::atan2(along.y, along.x);
      const BodyId link = world.create_body(
          body, ShapeDefinition{.geometry = Box{length, 0.08}, .density = 5, .filter = {.mask = 0}});
      join(link, {-length / 2, 0});
      chain.push_back(link), last = link, anchor = {length / 2, 0};
    }
    const BodyId ball = add_body(world, Vec2d{0, kHeight} + 4 * along,
                                 {.geometry = Circle{0.4}, .density = kg / (kPi * 0.4 * 0.4)});
    join(ball, {});
    chain.push_back(ball);
    for (int i = 0; i < 20; ++i) add_box(world, {0.7 + 0.5 * (i % 2), 0.125 + 0.25 * (i / 2)}, 2, 0.5, 0.25);
  }

  // Widest gap of a hinge, in links.
  double gap() const {
    double widest = 0;
    Vec2d end{0, kHeight};
    for (const BodyId body : chain) {
      const bool ball = body == chain.back();
      const double angle = world.angle(body);
      const Vec2d half = ball ? Vec2d{} : (0.5 * length) * Vec2d{std::cos(angle), std::sin(angle)};
      widest = std::max(widest, std::sqrt(length_squared(world.position(body) - half - end)) / length);
      end = world.position(body) + half;
    }
    return widest;
  }

  // Multiplications of all islands so far.
  double effort() const {
    double sum = 0;
    for (const auto& island : world.data().scratch.islands.jointed_islands) sum += island.system.effort;
    return sum;
  }

  static constexpr double kHeight = 6;  // m
  double length;                        // m, of a link
  World world{without_sleep()};
  std::vector<BodyId> chain;
};

TEST(BoundedEffort, OfAChainThatStrikesAStack) {
  constexpr int kSubsteps = 4;
  // Each substep has its limit, and beyond it up to four solutions (of the middle, of its end, and each again
  // for the friction that it found), which take less than the limit with the 200 rows of this scene.
  constexpr double kMost = kSubsteps * (1 + 4) * tuning::kJointedEffort;
  for (const auto& [links, kg] : {std::pair{8, 50.0}, {12, 200.0}, {12, 1000.0}}) {
    WreckingBall scene(links, kg);
    double most = 0, gap = 0;
    for (int step = 0; step < 240; ++step) {
      const double before = scene.effort();
      scene.world.step(1.0 / 60, kSubsteps);
      most = std::max(most, scene.effort() - before);
      gap = std::max(gap, scene.gap());
    }
    EXPECT_LT(most, kMost) << links << " links, " << kg << " kg";
    EXPECT_LT(gap, 0.01) << links << " links, " << kg << " kg";
  }
}

}  // namespace
}  // namespace plumb
