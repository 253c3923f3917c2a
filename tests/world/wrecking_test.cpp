#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "tests/world/support.h"

// Bodies that a violent impact drives into each other come apart again soon.
namespace plumb {
namespace {

constexpr double kSide = 0.4;  // m, of the small squares
// m, largest gap between squares. Where squares touch, rounding would choose the axis between those that meet
// at a corner.
constexpr double kGap = 4e-4, kPitch = kSide + kGap;

// m, how deep two squares are in each other: the least overlap along their sides (separating axes).
double depth_of(const World& world, BodyId a, double half_a, BodyId b, double half_b) {
  const Vec2d between = world.position(b) - world.position(a);
  const double turn = world.angle(b) - world.angle(a);
  const double spread =
      std::abs(std::cos(turn)) + std::abs(std::sin(turn));  // half width seen from the other
  double least = half_a + half_b;
  const auto along = [&](double angle, double own, double other) {
    const Vec2d x{std::cos(angle), std::sin(angle)}, y{-x.y, x.x};
    for (const Vec2d axis : {x, y})
      least = std::min(least, own + other * spread - std::abs(dot(axis, between)));
  };
  along(world.angle(a), half_a, half_b);
  along(world.angle(b), half_b, half_a);
  return least;
}

// m, of all pairs now.
double deepest(const World& world, BodyId ram, const std::vector<BodyId>& squares) {
  double out = 0;
  const auto note = [&](double depth) { out = std::max(out, depth); };
  for (std::size_t i = 0; i < squares.size(); ++i) {
    note(depth_of(world, ram, 4, squares[i], kSide / 2));
    for (std::size_t j = 0; j < i; ++j) {
      const Vec2d between = world.position(squares[j]) - world.position(squares[i]);
      if (std::abs(between.x) + std::abs(between.y) > 2 * kSide) continue;
      note(depth_of(world, squares[i], kSide / 2, squares[j], kSide / 2));
    }
  }
  return out;
}

// m: an 8 m square of density 8 flies at 40 m/s into a block of squares of 0.4 m, nearly edge to edge, aside
// by `aside`, m. The mean of the deepest overlaps of the steps 8 to 17, while the block is thrown apart.
double depth_after_the_blow(double aside, unsigned seed) {
  World world({.gravity = {0, 0}, .sleeping = false});
  BodyDefinition definition;
  definition.position = {-5.2, aside};
  definition.velocity = {40, 0};
  const BodyId ram = world.create_body(definition, ShapeDefinition{.geometry = Box{8, 8}, .density = 8});
  std::vector<BodyId> squares;
  std::mt19937 generator(seed);
  const auto jitter = [&] { return kGap * static_cast<double>(generator()) / 4294967296.0; };
  for (int column = 0; column < 40; ++column)
    for (int row = 0; row < 30; ++row)
      squares.push_back(
          add_box(world, {kPitch * column + jitter(), kPitch * (row - 15) + jitter()}, 1, kSide, kSide));
  double sum = 0;
  for (int step = 1; step <= 17; ++step) {
    world.step(1.0 / 60, 4);
    if (step >= 8) sum += deepest(world, ram, squares);
  }
  return sum / 10;
}

// Four substeps hand the blow on by some rows each, and what the others have not been told of is driven into
// each other. Who hits whom is chance, so it is the median of 45 blows that differ by a millimetre: of eight
// medians the least was 216 mm, the largest 238. Pushed out no faster than what was put into each other: 252
// to 271 mm.
TEST(Wrecking, WhatIsDrivenIntoEachOtherPartsSoon) {
  std::vector<double> depths;
  for (int blow = 0; blow < 45; ++blow) depths.push_back(depth_after_the_blow(1e-3 * blow, blow));
  std::sort(depths.begin(), depths.end());
  std::printf("the median of %zu blows: %.1f mm\n", depths.size(), 1e3 * depths[depths.size() / 2]);
  EXPECT_LT(depths[depths.size() / 2], 0.245);
}

}  // namespace
}  // namespace plumb
