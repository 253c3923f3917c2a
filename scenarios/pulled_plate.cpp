#include <cmath>

#include "scenarios/truth/parts.h"

// Discs on a plate that is pulled from under them: they roll on it at a third of its acceleration A if mu >=
// A/(3 g), with A = F/(M + n m/3); otherwise they slip at mu g. Source: Newton and Euler, I = m r^2/2.
namespace plumb::scenarios::pulled_plate {
namespace {
using namespace truth;

constexpr double kPull = 6, kPlate = 2, kDiscs = 3, kRadius = 0.2;  // N, kg, kg in all, m

Problem build(std::string_view variant, int) {
  const double friction = variant == "rolls" ? 0.2 : 0.03;
  Problem problem{.scene = scene_of("pulled_plate", variant), .duration = 0.8};
  Scene& scene = problem.scene;
  scene.bodies = {ground(0), piece("plate", {0, 0.1}, solid(Box{4, 0.2}, friction), kPlate)};
  for (const double x : {-1, 0, 1})
    scene.bodies.push_back(piece("disc", {x, 0.2 + kRadius}, solid(Circle{kRadius}, friction)));
  name_apart(scene);
  scene.forces = {PointForce{.body = "plate", .force = {kPull, 0}}};
  const Real rolling = Real(kPull) / (kPlate + kDiscs / 3) / 3;
  const Real gain = std::fmin(rolling, Real(friction) * kGravity);  // of each disc
  const auto path = [=](Real t, Moving moving) {
    moving[0] = coast(moving[0], t, {{(kPull - kDiscs * gain) / kPlate, 0}});
    for (Motion& disc : moving.subspan(1)) disc = coast(disc, t, {{gain, 0}, 2 * gain / kRadius});
  };
  problem.truth = follow_in_contact(scene, "a third of the plate's F/(M + n m/3), or mu g", path);
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "pulled_plate",
                  .summary = "discs on a plate that is pulled from under them",
                  .variants = {"rolls", "slips"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::pulled_plate
