#include "engine/precise/invariants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "engine/precise/dynamics/scene_partition.h"
#include "engine/scene/error.h"
#include "tests/precise/support.h"

// The account of energy that Precise keeps of its own steps.
namespace plumb::precise {
namespace {

/// A scene's motion without contacts, and its account.
struct Followed {
  explicit Followed(const Scene& scene, double tolerance = 1e-9)
      : precise{.tolerance = tolerance},
        partition(partition_scene(scene)),
        ballistic(scene, partition),
        equations(scene, partition, ballistic, false, tolerance),
        motion(scene, partition, precise, equations),
        invariants(scene, partition, precise, equations) {
    motion.reset();
  }

  void until(double time) {
    while (motion.time() < time) {
      motion.step(std::numeric_limits<double>::infinity());
      invariants.account(motion);
    }
  }

  Precise precise;
  ScenePartition partition;
  BallisticMotion ballistic;
  EquationsOfMotion equations;
  EventFreeIntegrator motion;
  Invariants invariants;
};

/// Three rods under everything that takes or gives: drag, a damped spring, a force that swings, a thruster.
Scene busy() {
  Scene scene = rods(3);
  scene.forces = {LinearDrag{"rod0", 0.3},
                  QuadraticDrag{"rod2", 0.2},
                  SpringForce{.body_a = std::string(kWorld),
                              .body_b = "rod1",
                              .anchor_a = {1, 1},
                              .rest_length = 0.5,
                              .stiffness = 40,
                              .damping = 0.5},
                  SinusoidalForce{.body = "rod2", .amplitude = {3, 1}, .angular_frequency = 7},
                  PointForce{"rod1", {2, 0}, {0.1, 0.2}, Frame::Body},
                  Torque{"rod0", 0.4}};
  return scene;
}

TEST(PreciseInvariants, WorkOfForcesIsAllThatEnergyChangesBy) {
  for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
    for (const Scene& scene : {rods(1), rods(4), busy()}) {
      Followed run(scene, tolerance);
      run.until(10);
      EXPECT_LT(std::abs(run.invariants.drift()), 0.2 * run.invariants.bound()) << scene.forces.size();
      EXPECT_GT(run.invariants.bound(), 0);
    }
  }
}

TEST(PreciseInvariants, ForcesThatAreMissingFromTheAccountAreFound) {
  // The account of the same motion with gravity off by a thousandth: as if the motion were.
  const Scene scene = busy();
  Followed run(scene);
  Scene other = scene;
  other.gravity.y *= 1.001;
  Invariants wrong(other, run.partition, run.precise, run.equations);
  try {
    while (run.motion.time() < 10) {
      run.motion.step(std::numeric_limits<double>::infinity());
      wrong.account(run.motion);
    }
    ADD_FAILURE() << "not found";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Run);
    EXPECT_EQ(error.field(), "energy");
    EXPECT_NE(error.problem().find("tolerance"), std::string::npos) << error.problem();
    EXPECT_LT(run.motion.time(), 1);
  }
}

}  // namespace
}  // namespace plumb::precise
