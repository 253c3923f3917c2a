#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/world/support.h"

// Piles of thin sheets stand as towers of boxes do. The margin of contacts is a fraction of the extent, so
// each sheet has contacts with many above and below it, but it lies on one, and carries one.
namespace plumb {
namespace {

struct Pile {
  int sheets = 40;
  double width = 1, thickness = 0.01;  // m
};

template <class Real>
void expect_to_stand(const Pile& pile, const WorldDefinition& definition = {}) {
  // m, by which a rigid tower may sink: that of boxes of 1 m in docs/limits.md, and as much again while its
  // impulses are being found.
  constexpr double kSink = 4e-6;
  BasicWorld<Real> world(definition);
  add_ground(world);
  std::vector<BodyId> sheets;
  for (int i = 0; i < pile.sheets; ++i)
    sheets.push_back(add_box(world, {0, (i + 0.5) * pile.thickness}, 1, pile.width, pile.thickness));
  const double top = (pile.sheets - 0.5) * pile.thickness;
  double sunk = 0;
  for (int step = 0; step < 300; ++step) {
    world.step(1.0 / 60, 4);
    sunk = std::max(sunk, top - world.position(sheets.back()).y);
  }
  const std::string scene = std::to_string(pile.sheets) + " sheets of " + std::to_string(pile.width) +
                            " m x " + std::to_string(1e3 * pile.thickness) + " mm";
  EXPECT_LT(sunk, kSink) << scene;
  for (int i = 0; i < pile.sheets; ++i)
    EXPECT_NEAR(world.position(sheets[i]).y, (i + 0.5) * pile.thickness, kSink) << scene << ", sheet " << i;
}

constexpr Pile kPiles[] = {{32, 1, 0.01},      {36, 1, 0.01},   {60, 1, 0.01},
                           {60, 1, 0.005},     {12, 1, 0.0015}, {40, 1, 0.0015},
                           {52, 0.09, 0.0003}, {32, 1, 0.0003}, {100, 1, 0.01}};

TEST(ThinSheets, StandInPiles) {
  for (const Pile& pile : kPiles) {
    expect_to_stand<double>(pile);
    expect_to_stand<double>(pile, without_sleep());
    expect_to_stand<float>(pile);
  }
}

}  // namespace
}  // namespace plumb
