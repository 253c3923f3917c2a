#include "scenarios/truth/parts.h"
#include "scenarios/truth/phases.h"

// A block over the edge of a rough table lies iff its centre is over the table; otherwise it tips about the
// edge, I q'' = -m g x with x the horizontal distance from the edge to the centre. Source: statics; Euler.
namespace plumb::scenarios::table_edge {
namespace {
using namespace truth;

constexpr double kHalf = 0.125;  // m, of its height

Problem build(std::string_view variant, int) {
  const double beyond = choose(variant, {{"lies", -0.001}, {"tips", 0.05}});
  Problem problem{.scene = scene_of("table_edge", variant), .duration = 0.5};
  problem.scene.bodies = {fixed("table", {-4, -1}, solid(Box{8, 2}, 2)),
                          piece("block", {beyond, kHalf}, solid(Box{1, 2 * kHalf}, 2))};
  problem.truth = equilibrium(problem.scene, "lies iff its centre is over the table (statics)");
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  if (beyond < 0) return problem;
  const Vec2<Real> arm{beyond, kHalf};  // from the edge
  const Real inertia = (1 + 4 * kHalf * kHalf) / 12 + length_squared(arm);
  const auto law = [=](Real angle, Real) { return -kGravity * turned(angle, arm).x / inertia; };
  const Phases fall({0, 0}, {{second_order_law(law)}}, 1);
  problem.truth = turning_truth(problem.scene, "a pendulum about the edge", fall, {}, arm);
  problem.truth.contacts_last = true;
  return problem;
}

const Register r{{.name = "table_edge",
                  .summary = "a block over the edge of a table, short of tipping and beyond",
                  .variants = {"lies", "tips"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::table_edge
