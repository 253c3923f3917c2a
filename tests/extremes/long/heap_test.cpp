// A hundred rows of boxes: the largest heap that the default settings are meant for.
#include "tests/world/heaps.h"

#include <gtest/gtest.h>

namespace plumb::test {
namespace {

constexpr int kRows = 100;

// Its contacts yield to a tenth of their load, and to less the deeper they are (`kLoadEstimateOverlap`).
TEST(Heap, OfAHundredRowsRestsWithinAMillimetre) {
  World world(without_sleep());
  add_ground(world);
  const std::vector<BodyId> boxes = add_pyramid(world, kRows);
  run(world, 3600);
  for (int look = 0; look < 10; ++look) {
    run(world, 180);
    EXPECT_LT(deepest(world, boxes), 1e-3) << "after " << 63 + 3 * look << " s";
    EXPECT_NEAR(world.position(boxes.back()).y, kRows - 0.5, 0.05);
  }
}

}  // namespace
}  // namespace plumb::test
