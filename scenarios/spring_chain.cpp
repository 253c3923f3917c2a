#include <cmath>
#include <numbers>

#include "scenarios/truth/parts.h"

// N equal masses between walls, joined by springs: modes sin(j k pi/(N + 1)) of w_k = 2 sqrt(k/m) sin(k
// pi/(2 (N + 1))). Source: e.g. Goldstein, Classical Mechanics, ch. 6.
namespace plumb::scenarios {
namespace {

using namespace truth;

constexpr double kMass = 0.5, kStiffness = 20, kPulled = 0.2;  // kg, N/m, m

Problem build(std::string_view, int count) {
  Problem problem{.scene = scene_of("spring_chain", count, 0), .duration = 2};
  Scene& scene = problem.scene;
  const auto name = [](int i) { return "mass" + std::to_string(i); };
  for (int i = 1; i <= count; ++i)
    scene.bodies.push_back(
        piece(name(i), {i + (i == 1 ? kPulled : 0.0), 0}, untouchable(Circle{0.1}), kMass));
  for (int i = 1; i < count; ++i)
    scene.forces.push_back(SpringForce{name(i), name(i + 1), {}, {}, 1, kStiffness});
  scene.forces.push_back(SpringForce{"world", name(1), {}, {}, 1, kStiffness});
  scene.forces.push_back(SpringForce{"world", name(count), {count + 1.0, 0}, {}, 1, kStiffness});
  const auto path = [count](Real t, Moving moving) {
    const Real unit = std::numbers::pi_v<Real> / (count + 1);
    for (int j = 1; j <= count; ++j) moving[j - 1].position.x = j;
    for (int k = 1; k <= count; ++k) {
      const Real w = 2 * std::sqrt(Real(kStiffness) / kMass) * std::sin(k * unit / 2);
      for (int j = 1; j <= count; ++j) {
        const Real size = 2 * kPulled / (count + 1) * std::sin(k * unit) * std::sin(j * k * unit);
        moving[j - 1].position.x += size * std::cos(w * t);
        moving[j - 1].velocity.x -= size * w * std::sin(w * t);
      }
    }
  };
  problem.truth = follow(scene, "normal modes, w_k = 2 sqrt(k/m) sin(k pi/(2 (N + 1)))", path);
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "spring_chain",
                  .summary = "N masses and springs between walls",
                  .sizes = {2, 12},
                  .scales = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios
