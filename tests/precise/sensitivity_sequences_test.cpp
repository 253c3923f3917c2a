#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/trigonometry.h"
#include "engine/scene/number.h"
#include "engine/simulation/simulation.h"
#include "tests/precise/contact_scenes.h"

// Derivatives of motions that pass through several kinds of events one after the other: impacts with friction
// whose slip stops or turns round, other features in contact, sliding that ends. The truth is Richardson's
// extrapolation of central differences of runs at tolerance 1e-12, from three steps, and its own error is
// estimated from them.
namespace plumb {
namespace {

using Numbers = std::array<double, 6>;

constexpr double kSampleTime = 1.0 / 400;  // s
constexpr Precise kFine{.tolerance = 1e-12, .max_dt = kSampleTime};

Numbers numbers_of(const BodyState& s) {
  return {s.position.x, s.position.y, s.angle, s.velocity.x, s.velocity.y, s.angular_velocity};
}

std::vector<BodyState> end_with(Scene scene, const std::string& name, double change, int steps) {
  for (double* number : numbers_at(scene, name)) *number += change;
  Simulation run = compile(scene, kFine);
  run.step(steps);
  std::vector<BodyState> states(run.body_count());
  run.read(states);
  return states;
}

/// A derivative with an estimate of its error.
struct Difference {
  double value = 0, error = 0;
};

/// Extrapolates central differences with the steps h, h/2 and h/4, whose errors are series in even powers of
/// h.
Difference richardson(const std::array<double, 3>& central) {
  const double first = (4 * central[1] - central[0]) / 3, second = (4 * central[2] - central[1]) / 3;
  return {(16 * second - first) / 15, std::abs(second - first) / 15};
}

void expect_derivatives(const Scene& scene, const std::vector<std::string>& names, int steps, double h) {
  Simulation run = compile(scene, kFine, {.parameters = names});
  run.step(steps);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const std::vector<BodyState> found = run.sensitivities(j);
    std::array<std::vector<BodyState>, 3> above, below;
    for (std::size_t k = 0; k < 3; ++k) {
      const double step = h / (1 << k);
      above[k] = end_with(scene, names[j], step, steps);
      below[k] = end_with(scene, names[j], -step, steps);
    }
    double largest = 1;
    for (const BodyState& s : found)
      for (const double x : numbers_of(s)) largest = std::max(largest, std::abs(x));
    for (std::size_t body = 0; body < found.size(); ++body) {
      for (std::size_t i = 0; i < 6; ++i) {
        std::array<double, 3> central{};
        for (std::size_t k = 0; k < 3; ++k)
          central[k] = (numbers_of(above[k][body])[i] - numbers_of(below[k][body])[i]) / (2 * h / (1 << k));
        const Difference truth = richardson(central);
        EXPECT_LT(truth.error, 1e-6 * largest) << names[j] << ": the truth itself is not known well enough";
        EXPECT_NEAR(numbers_of(found[body])[i], truth.value, 1e-6 * largest)
            << names[j] << ", body " << body << ", component " << i;
      }
    }
  }
}

/// A box is thrown at the end of a table: a corner strikes, the impact turns its slip round, it falls over
/// the edge, on which one of its sides strikes, and meets the floor below.
Scene box_over_an_edge(ImpactRule rule) {
  Scene scene{.name = "edge"};
  scene.contact_rules = {.impact = rule, .friction_after_stop = rule == ImpactRule::Newton ? 1 : 0.7};
  Body table = block("table", {-2, -0.5}, 4, 1, 0.3, 0.2), floor = block("floor", {0, -1.6}, 20, 1, 0.3, 0.2);
  table.type = floor.type = BodyType::Static;
  Body box = block("box", {-0.35, 0.75}, 0.8, 0.3, 0.3, 0.4);
  box.angle = 0.7;
  box.velocity = {0.9, -1.2};
  box.angular_velocity = -2.5;
  box.inertia = 0.06;
  scene.bodies = {table, floor, box};
  return scene;
}

/// Slip of the body's point `corner`, m/s.
double slip_of(const BodyState& s, Vec2d corner) {
  return s.velocity.x - s.angular_velocity * (rotation_of(s.angle) * corner).y;
}

TEST(SensitivitySequences, ImpactsThatTurnTheSlipRoundAndAnEdgeAreDifferencesOfRuns) {
  for (const ImpactRule rule : {ImpactRule::Newton, ImpactRule::Poisson, ImpactRule::Stronge}) {
    const Scene scene = box_over_an_edge(rule);
    Simulation run = compile(scene, kFine);
    BodyState before = run.state(2);
    while (run.statistics().impacts == 0) before = run.state(2), run.step(1);
    // The lower left corner strikes; within the two samples gravity changes its slip by less than 1 %.
    const Vec2d corner{-0.4, -0.15};
    EXPECT_GT(slip_of(before, corner), 0.4);
    EXPECT_LT(slip_of(run.state(2), corner), -0.4);
    while (run.statistics().impacts == 1) run.step(1);
    const Vec2d edge = rotation_of(-run.state(2).angle) * (Vec2d{0, 0} - run.state(2).position);
    EXPECT_LT(std::abs(edge.x), 0.35) << "the table's edge strikes a side of the box";
    EXPECT_NEAR(edge.y, -0.15, 0.02);
    run.step(260 - static_cast<int>(std::lround(run.time() / kSampleTime)));
    EXPECT_EQ(run.statistics().impacts, 3);
    std::vector<std::string> names{"bodies.box.angle",         "bodies.box.velocity.x",
                                   "bodies.box.inertia",       "bodies.box.shapes.friction",
                                   "bodies.box.shapes.height", "bodies.box.shapes.restitution",
                                   "bodies.table.position.x",  "gravity.y"};
    if (rule != ImpactRule::Newton) names.push_back("contact_rules.friction_after_stop");
    expect_derivatives(scene, names, 260, 2e-4);
  }
}

/// A disc with spin strikes a hanging rod, where friction stops the slip. The rod swings to the limit of its
/// hinge and back; the disc bounces on the ground.
Scene disc_against_a_hanging_rod() {
  Scene scene{.name = "struck"};
  Body rod = block("rod", {0, 1}, 0.1, 1, 0.5, 0.3);
  Body thrown = disc("disc", {0.6, 0.75}, {-3, 1}, 0.2, 0.5, 0.5);
  thrown.angular_velocity = 2;
  scene.bodies = {ground(0.5), rod, thrown};
  scene.joints = {RevoluteJoint{.name = "hinge",
                                .body_a = std::string(kWorld),
                                .body_b = "rod",
                                .anchor_a = {0, 1.5},
                                .anchor_b = {0, 0.5}}};
  std::get<RevoluteJoint>(scene.joints[0]).limits = Range{-0.6, 0.6};
  return scene;
}

TEST(SensitivitySequences, ASlipThatStopsAHingesLimitAndTwoBouncesAreDifferencesOfRuns) {
  const Scene scene = disc_against_a_hanging_rod();
  Simulation run = compile(scene, kFine);
  BodyState before = run.state(2);
  while (run.statistics().impacts == 0) before = run.state(2), run.step(1);
  // Slip along the rod's side, where the disc touches it at height 0.8, half the rod's width in front of the
  // hinge.
  const auto slip = [](const BodyState& disc, double rods_rate) {
    return disc.velocity.y - 0.2 * disc.angular_velocity - 0.05 * rods_rate;
  };
  EXPECT_LT(slip(before, 0), -0.5);
  EXPECT_NEAR(slip(run.state(2), run.state(1).angular_velocity), 0, 0.05) << "within a sample of the impact";
  run.step(300 - static_cast<int>(std::lround(run.time() / kSampleTime)));
  // Disc on rod, limit, ground, rod, ground.
  EXPECT_EQ(run.statistics().impacts, 5);
  expect_derivatives(scene,
                     {"gravity.y", "bodies.disc.velocity.x", "bodies.disc.angular_velocity",
                      "bodies.disc.mass", "bodies.rod.mass", "bodies.disc.shapes.friction",
                      "bodies.disc.shapes.restitution", "joints.hinge.limits.lower"},
                     300, 1e-4);
}

}  // namespace
}  // namespace plumb
