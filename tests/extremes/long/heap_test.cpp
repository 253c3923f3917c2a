// A hundred rows of boxes: the largest heap that the default settings are meant for.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "engine/world/world.h"

namespace plumb::test {
namespace {

constexpr int kRows = 100;

std::vector<BodyId> add_pyramid(World& world) {
  world.create_body({.type = BodyType::Static}, {.geometry = Box{200, 2}, .position = {0, -1}});
  std::vector<BodyId> boxes;
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kRows - row; ++i)
      boxes.push_back(world.create_body({.position = {i + 0.5 * row, 0.5 + row}}, {.geometry = Box{1, 1}}));
  }
  return boxes;
}

// Deepest overlap of any two bodies, m.
double deepest(const World& world, const std::vector<BodyId>& bodies) {
  double depth = 0;
  for (const BodyId body : bodies) {
    for (const ContactReading& contact : world.contacts(body)) {
      for (int i = 0; i < contact.count; ++i) depth = std::max(depth, -contact.separations[i]);
    }
  }
  return depth;
}

// Its contacts yield to a tenth of their load, and to less the deeper they are (`kExpectedOverlap`).
TEST(Heap, OfAHundredRowsRestsWithinAMillimetre) {
  World world({.sleeping = false});
  const std::vector<BodyId> boxes = add_pyramid(world);
  for (int i = 0; i < 3600; ++i) world.step(1.0 / 60);
  for (int look = 0; look < 10; ++look) {
    for (int i = 0; i < 180; ++i) world.step(1.0 / 60);
    EXPECT_LT(deepest(world, boxes), 1e-3) << "after " << 63 + 3 * look << " s";
    EXPECT_NEAR(world.position(boxes.back()).y, kRows - 0.5, 0.05);
  }
}

}  // namespace
}  // namespace plumb::test
