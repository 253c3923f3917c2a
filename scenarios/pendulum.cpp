#include <cmath>
#include <numbers>

#include "scenarios/truth/parts.h"
#include "scenarios/truth/phases.h"
#include "scenarios/truth/set_up.h"

// A bob on a massless rod, released at an angle: phi'' = -(g/L) sin(phi), with periods 1.07318, 1.18034,
// 1.37288 and 2.43936 times that of a small swing from 60, 90, 120 and 170 degrees. Source: complete elliptic
// integral; e.g. Landau and Lifshitz, Mechanics, 11.
namespace plumb::scenarios::pendulum {
namespace {
using namespace truth;

constexpr double kLength = 1;  // m

Problem build(std::string_view variant, int) {
  const double degrees = choose(variant, {{"60", 60}, {"90", 90}, {"120", 120}, {"170", 170}});
  Problem problem{.scene = scene_of("pendulum", variant), .duration = 3};
  const double from = degrees / 180 * std::numbers::pi;
  problem.scene.bodies = {piece("bob", set_up::turned(from, {0, -kLength}), untouchable(Circle{0.1}), 2)};
  problem.scene.joints = {
      DistanceJoint{.name = "rod", .body_a = "world", .body_b = "bob", .length = kLength}};
  const auto law = [](Real angle, Real) { return -kGravity / Real(kLength) * std::sin(angle); };
  const Phases swing({from, 0}, {{second_order_law(law)}}, problem.duration);
  problem.truth =
      turning_truth(problem.scene, "phi'' = -(g/L) sin(phi), long double Runge-Kutta-Fehlberg 7(8)", swing,
                    {}, {0, -kLength}, false);
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "pendulum",
                  .summary = "a bob on a rod, released at 60 to 170 degrees",
                  .variants = {"60", "90", "120", "170"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::pendulum
