// AABBs of motions on arcs: continuous collision searches in them for what a body may meet.
#include <gtest/gtest.h>

#include "engine/world/continuous/toi_events.h"

namespace plumb {
namespace {

/// A body of extent 0.1 m, 16 m from the centre of what pushes it along and turns by `turn` in the step.
SweptBody carried(double turn, double bearing) {
  SweptBody swept;
  swept.body = 0;
  const Rotation<double> facing = rotation_of(bearing), r = rotation_of(turn);
  const Vec2d arm = facing * Vec2d{16, 0};
  swept.from = 0, swept.start = -arm, swept.delta_angle = turn, swept.arm = arm;
  swept.displacement = r * swept.start - swept.start;
  return swept;
}

Aabb<double> swept_aabb_of_carried(const SweptBody& swept) {
  WorldData<double> w;
  w.extents = {0.1};
  return swept_aabb_of(w, swept);
}

TEST(WaysOnArcs, HoldTheBodyAtAllTimes) {
  for (const double turn : {0.01, -0.3, 1.0, -2.0, 3.0, 6.0}) {
    for (int i = 0; i < 24; ++i) {
      const SweptBody swept = carried(turn, 0.27 * i);
      const Aabb<double> box = swept_aabb_of_carried(swept).grown(-0.1 + 1e-12);
      for (int k = 0; k <= 64; ++k) {
        // In closed form: the centre of the arc is the origin.
        const Vec2d at = rotation_of(turn * k / 64) * swept.start;
        EXPECT_TRUE(box.contains(Aabb<double>{at, at})) << turn << " rad, bearing " << 0.27 * i;
      }
    }
  }
}

TEST(WaysOnArcs, AreAsShortAsTheWayAndNotAsWideAsTheCircle) {
  // In a drum of 16 m at 25 degrees a second: 0.12 m in a step, from a body of 0.2 m.
  for (int i = 0; i < 24; ++i) {
    const Aabb<double> box = swept_aabb_of_carried(carried(0.0073, 0.27 * i));
    EXPECT_LT(box.upper.x - box.lower.x, 0.2 + 16 * 0.0073 + 1e-3);
    EXPECT_LT(box.upper.y - box.lower.y, 0.2 + 16 * 0.0073 + 1e-3);
  }
}

}  // namespace
}  // namespace plumb
