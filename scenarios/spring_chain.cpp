#include <cmath>

#include "scenarios/truth/oscillator.h"
#include "scenarios/truth/parts.h"

// N equal masses between walls, joined by springs: modes sin(j k pi/(N + 1)) of w_k = 2 sqrt(k/m) sin(k
// pi/(2 (N + 1))). Source: e.g. Goldstein, Classical Mechanics, ch. 6.
namespace plumb::scenarios::spring_chain {
namespace {
using namespace truth;

constexpr double kMass = 0.5, kStiffness = 20, kPulled = 0.2;  // kg, N/m, m

Problem build(std::string_view, int count) {
  Problem problem{.scene = scene_of("spring_chain", count, 0), .duration = 2};
  const auto name = [=](int i) { return i % (count + 1) == 0 ? "world" : "mass" + std::to_string(i); };
  for (int i = 1; i <= count; ++i)
    problem.scene.bodies.push_back(piece(name(i), {1.0 * i, 0}, untouchable(Circle{0.1}), kMass));
  problem.scene.bodies[0].position.x += kPulled;
  for (int i = 0; i <= count; ++i) {
    const Vec2d anchor{i == count ? count + 1.0 : 0, 0};
    problem.scene.forces.push_back(SpringForce{name(i), name(i + 1), {}, anchor, 1, kStiffness});
  }
  const auto path = [count](Real t, Moving moving) {
    for (int j = 1; j <= count; ++j) {
      const Swing now = chain_swing(count, j, std::sqrt(Real(kStiffness) / kMass), kPulled, t);
      moving[j - 1] = {{j + now.place, 0}, 0, {now.rate, 0}, 0};
    }
  };
  problem.truth = follow(problem.scene, "normal modes, w_k = 2 sqrt(k/m) sin(k pi/(2 (N + 1)))", path);
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{"spring_chain", "N masses and springs between walls", {""}, {2, 12}, true, build}};

}  // namespace
}  // namespace plumb::scenarios::spring_chain
