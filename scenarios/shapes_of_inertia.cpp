#include <cmath>

#include "scenarios/truth/parts.h"

// A torque on bodies of several shapes. Inertia: box m (w^2 + h^2)/12, disc m r^2/2, equilateral triangle
// m a^2/12, two discs by the parallel axis theorem (Huygens; Steiner).
namespace plumb::scenarios::shapes_of_inertia {
namespace {
using namespace truth;

constexpr double kTorque = 0.5, kMass = 3;  // N m, kg

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("shapes_of_inertia", "", 0), .duration = 1};
  const double third = std::sqrt(0.75) / 3;  // of the height
  Body pair = piece("pair", {2, 0}, untouchable(Circle{0.2}), kMass);
  pair.shapes.push_back(pair.shapes[0]);
  for (const int side : {0, 1}) pair.shapes[side].position = {side - 0.5, 0};
  problem.scene.bodies = {
      piece("box", {-4, 0}, untouchable(Box{0.8, 0.3}), kMass),
      piece("disc", {-2, 0}, untouchable(Circle{0.4}), kMass),
      piece("triangle", {0, 0}, untouchable(Polygon{{{-0.5, -third}, {0.5, -third}, {0, 2 * third}}}), kMass),
      pair};
  for (const Body& body : problem.scene.bodies) problem.scene.forces.push_back(Torque{body.name, kTorque});
  const std::vector<Real> gyration = {(0.64L + 0.09L) / 12, 0.16L / 2, 1 / Real(12), 0.04L / 2 + 0.25L};
  const auto path = [gyration](Real t, Moving moving) {
    for (std::size_t i = 0; i < moving.size(); ++i)
      moving[i] = coast(moving[i], t, {{}, kTorque / (kMass * gyration[i])});
  };
  problem.truth = follow(problem.scene, "T t/I by each shape's formula (Huygens, Steiner)", path);
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "shapes_of_inertia",
                  .summary = "a torque on a box, a disc, a triangle and a pair",
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::shapes_of_inertia
