#include "scenarios/truth/parts.h"

// A pulley rope runs twice to one of its masses: with s the displacement of the other, (m1 + m2/4) s'' = (m1
// - m2/2) g. Source: d'Alembert; virtual work.
namespace plumb::scenarios::block_and_tackle {
namespace {
using namespace truth;

constexpr double kSingle = 3, kDouble = 2, kRatio = 2;  // kg, kg, 1

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("block_and_tackle"), .duration = 0.8};
  problem.scene.bodies = {piece("single", {-1, 0}, untouchable(Box{0.5, 0.5}), kSingle),
                          piece("double", {1, 0}, untouchable(Box{0.5, 0.5}), kDouble)};
  problem.scene.joints = {PulleyJoint{.name = "rope",
                                      .body_a = "single",
                                      .body_b = "double",
                                      .ground_a = {-1, 4},
                                      .ground_b = {1, 4},
                                      .ratio = kRatio}};
  const Real a = (kSingle - kDouble / kRatio) * Real(kGravity) / (kSingle + kDouble / (kRatio * kRatio));
  problem.truth = follow(problem.scene, "(m1 + m2/r^2) s'' = (m1 - m2/r) g", [a](Real t, Moving moving) {
    moving[0] = coast(moving[0], t, {{0, -a}});
    moving[1] = coast(moving[1], t, {{0, a / kRatio}});
  });
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{
    {.name = "block_and_tackle", .summary = "a rope that runs twice to one of two masses", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::block_and_tackle
