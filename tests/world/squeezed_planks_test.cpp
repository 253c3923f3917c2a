#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/world/world.h"

// A kinematic body that turns and sinks presses free planks onto a floor. It needs any force for that, but
// planks may slip out only at a speed like its own: what it presses without a way out must be overlapped.
namespace plumb {
namespace {

// Random numbers between two limits (xorshift).
class Draws {
 public:
  explicit Draws(int seed) : state_(0x9E3779B97F4A7C15u * static_cast<std::uint64_t>(seed + 1)) {}
  double between(double least, double most) {
    state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
    return least + (most - least) * static_cast<double>(state_ >> 11) / 9007199254740992.0;
  }

 private:
  std::uint64_t state_;
};

// Returns the highest speed of a pile of planks under a capsule that turns and sinks into it, as a multiple
// of its tip's speed and that of a fall of 1.3 m, 5 m/s.
template <class Real>
double fastest_plank(int seed, int planks, const WorldDefinition& definition, int substeps) {
  Draws draws(seed);
  BasicWorld<Real> world(definition);
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{60, 2}});
  std::vector<BodyId> pile;
  for (int i = 0; i < planks; ++i) {
    const double width = draws.between(0.5, 1.8), x = draws.between(-0.8, 0.8);
    pile.push_back(world.create_body({.position = {x, 0.06 + 0.13 * i}},
                                     {.geometry = Box{width, width / 16},
                                      .density = std::pow(10, draws.between(-1, 1)),
                                      .material = {.friction = draws.between(0.2, 1)}}));
  }
  const double turn = draws.between(-1, 1), spin = (turn < 0 ? -1 : 1) * (2 + 10 * std::abs(turn)),
               half = draws.between(0.2, 0.5), radius = 0.6 * half;
  const Vec2d velocity{draws.between(-1, 1), -draws.between(0, 0.6)};
  world.create_body({.type = BodyType::Kinematic,
                     .position = {0, 0.13 * planks + draws.between(0.4, 0.9)},
                     .velocity = velocity,
                     .angular_velocity = spin},
                    {.geometry = Capsule{{-half, 0}, {half, 0}, radius}, .material = {.friction = 0.9}});
  double most = 0;
  for (int i = 0; i < 150; ++i) {
    world.step(1 / 60.0, substeps);
    for (const BodyId plank : pile) {
      const Vec2d v = world.velocity(plank);
      most = std::max(most, std::hypot(v.x, v.y));
    }
  }
  return most / (std::hypot(velocity.x, velocity.y) + std::abs(spin) * (half + radius) + 5);
}

template <class Real>
class SqueezedPlanks : public testing::Test {
 protected:
  // `most_fast`: largest share of piles of which a plank may be more than 3 times as fast.
  static void expect_slow(const WorldDefinition& definition, int substeps, double most_fast) {
    int fast = 0, runs = 0;
    for (int planks = 1; planks <= 5; ++planks) {
      for (int seed = 0; seed < 40; ++seed, ++runs) {
        const double speed = fastest_plank<Real>(seed, planks, definition, substeps);
        EXPECT_LT(speed, 10) << planks << " planks, seed " << seed << ", " << substeps << " substeps";
        fast += speed > 3;
      }
    }
    EXPECT_LE(fast, most_fast * runs);
  }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(SqueezedPlanks, Precisions);

TYPED_TEST(SqueezedPlanks, AreNotShotAwayByATurningPress) {
  for (const int substeps : {1, 4, 16}) this->expect_slow({}, substeps, 0.02);
}

TYPED_TEST(SqueezedPlanks, AreNotShotAwayWithoutDirectIslands) {
  this->expect_slow({.direct_islands = false}, 4, 0.02);
}

TYPED_TEST(SqueezedPlanks, AreNotShotAwayBySequentialImpulses) {
  this->expect_slow({.solver = Solver::SequentialImpulses}, 4, 0.04);
}

}  // namespace
}  // namespace plumb
