#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/scene/json.h"
#include "engine/simulation/simulation.h"

// Formulas that begin to act after a quiet time: a step must not pass them between its evaluations. The exact
// values follow from the impulse and the moments of a pulse.
namespace plumb {
namespace {

Simulation simulation_of(const std::string& scene, double tolerance, double max_dt = 1.0 / 60) {
  Precise precise;
  precise.tolerance = tolerance, precise.max_dt = max_dt;
  return compile(scene_from_json(scene), precise);
}

BodyState state_at(const std::string& scene, std::size_t body, double time, double tolerance,
                   double max_dt = 1.0 / 60) {
  Simulation simulation = simulation_of(scene, tolerance, max_dt);
  for (int i = 0; i < static_cast<int>(std::lround(time / max_dt)); ++i) simulation.step();
  return simulation.state(body);
}

const std::vector<double> kTolerances{1e-5, 1e-7, 1e-9, 1e-11};

// A triangle of area 0.5 about t = 1.5 turns a wheel at rest.
TEST(FormulaPieces, ATableTurnsAWheelAtRest) {
  const std::string scene = R"js({"plumb_scene": 1, "bodies": [{"name": "wheel", "mass": 1, "inertia": 1}],
      "joints": [{"type": "revolute", "name": "axle", "body_a": "world", "body_b": "wheel"}],
      "forces": [{"type": "formula_force", "body": "wheel", "torque": "table(t,1,0,1.5,1,2,0)"}]})js";
  for (const double tolerance : kTolerances)
    for (const double max_dt : {1.0 / 60, 1.0}) {
      const BodyState wheel = state_at(scene, 0, 5, tolerance, max_dt);
      EXPECT_NEAR(wheel.angle, 1.75, tolerance) << tolerance << " " << max_dt;
      EXPECT_NEAR(wheel.angular_velocity, 0.5, tolerance) << tolerance << " " << max_dt;
    }
}

// A pulse of 2 ms and 0.5 N s, and one of 1 us, on a body that nothing else moves.
TEST(FormulaPieces, PulsesAreFoundHoweverShort) {
  for (const auto& [pulse, moment] :
       {std::pair{"t > 1 && t < 1.002 ? 250 : 0", 0.5 * (20 - 1.001)},
        std::pair{"t > 1 && t < 1.000001 ? 500000 : 0", 0.5 * (20 - 1.0000005)}}) {
    const std::string scene = std::string(R"js({"plumb_scene": 1, "gravity": [0, 0],
        "bodies": [{"name": "body", "mass": 1, "inertia": 1}],
        "forces": [{"type": "formula_force", "body": "body", "force": [")js") +
                              pulse + R"js(", "0"]}]})js";
    for (const double tolerance : kTolerances)
      // Times are rounded by 2e-16 s, which 500 kN feel for 19 s.
      EXPECT_NEAR(state_at(scene, 0, 20, tolerance).position.x, moment, std::max(tolerance, 5e-9))
          << pulse << tolerance;
  }
}

// exp(-((t - 5) / w)^2) has the impulse w sqrt(pi), centred at 5.
TEST(FormulaPieces, SmoothBumpsAreFound) {
  for (const double width : {0.5, 0.02}) {
    const std::string scene = R"js({"plumb_scene": 1, "gravity": [0, 0],
        "bodies": [{"name": "body", "mass": 1, "inertia": 1}],
        "forces": [{"type": "formula_force", "body": "body",
                    "force": ["exp(-((t-5)/)js" +
                              std::to_string(width) + R"js()^2)", "0"]}]})js";
    for (const double tolerance : kTolerances)
      EXPECT_NEAR(state_at(scene, 0, 10, tolerance).position.x, 5 * width * std::sqrt(std::acos(-1.0)),
                  tolerance)
          << width << " " << tolerance;
  }
}

// A zone of length L that brakes with a: v^2 falls by 2 a L.
TEST(FormulaPieces, ZonesAreNotPassed) {
  const double speed = 2, brake = 0.3;
  for (const double begin : {3.0, 100.0}) {
    for (const double length : {0.01, 0.1, 5.0}) {
      const std::string b = std::to_string(begin), e = std::to_string(begin + length);
      const std::string scene = R"js({"plumb_scene": 1, "gravity": [0, 0],
          "bodies": [{"name": "body", "mass": 1, "inertia": 1, "velocity": [2, 0]}],
          "forces": [{"type": "formula_force", "body": "body",
                      "force": ["x > )js" +
                                b + " && x < " + e + R"js( ? -0.3 : 0", "0"]}]})js";
      const double after = std::sqrt(speed * speed - 2 * brake * length);
      const double inside = (speed - after) / brake, time = begin + 5;
      const double right = begin + length + after * (time - begin / speed - inside);
      for (const double tolerance : {1e-6, 1e-7, 1e-9})
        EXPECT_NEAR(state_at(scene, 0, time, tolerance).position.x, right, 20 * tolerance)
            << begin << " " << length << " " << tolerance;
    }
  }
}

// A ball of a piston's radius is hit at the time when the gap of 0.3 m is closed at 20 m/s, and leaves at
// twice the piston's speed, whatever the steps.
TEST(FormulaPieces, CollisionsWithPistonsAreAtTheirTime) {
  const std::string scene = R"js({"plumb_scene": 1, "gravity": [0, 0], "bodies": [
      {"name": "piston", "type": "kinematic", "motion": {"x": "table(t,1,0,1.05,1,1.1,1)"},
       "shapes": [{"type": "circle", "radius": 0.1, "restitution": 1}]},
      {"name": "ball", "position": [0.5, 0],
       "shapes": [{"type": "circle", "radius": 0.1, "restitution": 1}]}]})js";
  for (const double tolerance : kTolerances) {
    for (const double max_dt : {1.0 / 60, 0.5, 1.0}) {
      const BodyState ball = state_at(scene, 1, 3, tolerance, max_dt);
      EXPECT_NEAR(ball.position.x, 0.5 + 40 * (3 - 1.015), 10 * tolerance) << tolerance << " " << max_dt;
      EXPECT_NEAR(ball.velocity.x, 40, 10 * tolerance) << tolerance << " " << max_dt;
    }
  }
}

// A plate under a resting ball jerks up by 5 cm in 10 ms. Without restitution the ball moves with the plate
// at 5 m/s, leaves it when it stops, and flies on a parabola.
TEST(FormulaPieces, APlateThatJerksThrowsWhatRestsOnIt) {
  const std::string scene = R"js({"plumb_scene": 1, "bodies": [
      {"name": "plate", "type": "kinematic", "motion": {"y": "table(t,1,0,1.01,0.05,2,0.05)"},
       "shapes": [{"type": "box", "width": 2, "height": 0.2, "restitution": 0}]},
      {"name": "ball", "position": [0, 0.2],
       "shapes": [{"type": "circle", "radius": 0.1, "restitution": 0}]}]})js";
  const double flight = 0.3;
  const BodyState ball = state_at(scene, 1, 1.01 + flight, 1e-9, 0.01);
  EXPECT_NEAR(ball.position.y, 0.25 + 5 * flight - 0.5 * 9.81 * flight * flight, 1e-6);
}

// A motor whose speed is a pulse of 0.5 rad.
TEST(FormulaPieces, DrivesFollowPulses) {
  const std::string scene = R"js({"plumb_scene": 1, "bodies": [{"name": "wheel", "mass": 1, "inertia": 1}],
      "joints": [{"type": "revolute", "name": "axle", "body_a": "world", "body_b": "wheel",
                  "motor": {"speed": 0, "max_force": 1e9}}],
      "drives": [{"joint": "axle", "speed": "t > 1 && t < 1.002 ? 250 : 0"}]})js";
  EXPECT_NEAR(state_at(scene, 0, 3, 1e-9).angle, 0.5, 1e-8);
}

// A run that is saved and restored at any time passes the same switches with the same bits.
TEST(FormulaPieces, RestoredRunsPassTheSameSwitches) {
  const std::string scene = R"js({"plumb_scene": 1, "bodies": [{"name": "body", "mass": 1, "inertia": 1}],
      "joints": [{"type": "revolute", "name": "axle", "body_a": "world", "body_b": "body",
                  "anchor_a": [0, 1], "anchor_b": [0, 1]}],
      "forces": [{"type": "formula_force", "body": "body",
                  "force": ["table(t,0.5,0,0.6,3,0.7,0) + exp(-((t-1.5)/0.02)^2) + (x > 0.1 ? -2 : 0)", "0"]}]})js";
  Simulation straight = simulation_of(scene, 1e-9);
  Simulation restored = simulation_of(scene, 1e-9);
  for (int i = 0; i < 180; ++i) {
    straight.step();
    Simulation next = simulation_of(scene, 1e-9);
    next.restore(restored.save());
    next.step();
    restored = std::move(next);
    ASSERT_EQ(straight.hash(), restored.hash()) << i;
  }
}

}  // namespace
}  // namespace plumb
