// AABBs of motions on arcs: continuous collision searches in them for what a body may meet.
#include <gtest/gtest.h>

#include "engine/world/continuous/toi_events.h"

namespace plumb {
namespace {

/// A body of extent 0.1 m, 16 m from the centre of what pushes it along and turns by `turn` in the step.
SweptBody carried(double turn, double bearing) {
  SweptBody flight;
  flight.body = 0;
  const Rotation<double> facing = rotation_of(bearing), r = rotation_of(turn);
  const Vec2d arm = facing * Vec2d{16, 0};
  flight.from = 0, flight.start = -arm, flight.turn = turn, flight.arm = arm;
  flight.way = r * flight.start - flight.start;
  return flight;
}

Aabb<double> way_of_carried(const SweptBody& flight) {
  WorldData<double> w;
  w.extents = {0.1};
  return way_of(w, flight);
}

TEST(WaysOnArcs, HoldTheBodyAtAllTimes) {
  for (const double turn : {0.01, -0.3, 1.0, -2.0, 3.0, 6.0}) {
    for (int i = 0; i < 24; ++i) {
      const SweptBody flight = carried(turn, 0.27 * i);
      const Aabb<double> box = way_of_carried(flight).grown(-0.1 + 1e-12);
      for (int k = 0; k <= 64; ++k) {
        // In closed form: the centre of the arc is the origin.
        const Vec2d at = rotation_of(turn * k / 64) * flight.start;
        EXPECT_TRUE(box.contains(Aabb<double>{at, at})) << turn << " rad, bearing " << 0.27 * i;
      }
    }
  }
}

TEST(WaysOnArcs, AreAsShortAsTheWayAndNotAsWideAsTheCircle) {
  // In a drum of 16 m at 25 degrees a second: 0.12 m in a step, from a body of 0.2 m.
  for (int i = 0; i < 24; ++i) {
    const Aabb<double> box = way_of_carried(carried(0.0073, 0.27 * i));
    EXPECT_LT(box.upper.x - box.lower.x, 0.2 + 16 * 0.0073 + 1e-3);
    EXPECT_LT(box.upper.y - box.lower.y, 0.2 + 16 * 0.0073 + 1e-3);
  }
}

}  // namespace
}  // namespace plumb
