#include <gtest/gtest.h>

#include "engine/simulation/simulation.h"

namespace plumb {
namespace {

// A flight to an impact that lies far ahead is one step, and a last one of some 1e-14 s where the impact was
// a little later than it had seemed: what is read long before that little step is the same after a restore.
TEST(PreciseSnapshots, WithinAFlightWhoseEndWasMovedOn) {
  Shape box{.geometry = Box{0.513, 0.297}};
  box.friction = box.restitution = 0;
  Body falling{.name = "box", .angle = 0.0171, .angular_velocity = 0.86, .mass = 0.31, .shapes = {box}};
  Body floor{.name = "floor", .type = BodyType::Static, .position = {2.4, -2.2}};
  floor.shapes = {Shape{.geometry = Box{40, 2}}};
  const Scene scene{.name = "a box falls", .gravity = {0, -9.81}, .bodies = {falling, floor}};
  for (const int steps : {1, 10, 20, 26, 27, 40}) {
    Simulation run = compile(scene, Precise{.tolerance = 1e-8});
    Simulation other = compile(scene, Precise{.tolerance = 1e-8});
    run.step(steps), other.step(1);
    other.restore(run.save());
    EXPECT_EQ(other.state(0), run.state(0)) << steps;
    EXPECT_EQ(other.hash(), run.hash()) << steps;
    run.step(5), other.step(5);
    EXPECT_EQ(other.hash(), run.hash()) << steps;
  }
}

}  // namespace
}  // namespace plumb
