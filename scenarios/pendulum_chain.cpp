#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "scenarios/scenario.h"
#include "scenarios/truth/rod_chain.h"

// N uniform rods of 1 m and 1 kg, hinged end to end, laid along +x from a fixed pivot and released. Joint
// forces are large and the motion is soon like a whip, which shows the errors of iterative joint solvers.
namespace plumb::scenarios {
namespace {
using namespace truth;

constexpr double kLength = 1, kMass = 1, kGravity = 9.81;

/// Solves an independent formulation (minimal coordinates, Lagrange) in extended precision. The solution is
/// kept while the program runs, because all engines are compared with it.
class ChainTruth {
 public:
  explicit ChainTruth(int count)
      : chain_(count, kLength, kGravity),
        path_(
            Trajectory::State(2 * chain_.count(), 0),
            [this](const Trajectory::State& y, Trajectory::State& rate) { chain_.rates(y, rate); },
            1.0L / 480) {}
  ChainTruth(const ChainTruth&) = delete;
  ChainTruth& operator=(const ChainTruth&) = delete;

  void at(double time, std::span<BodyState> out) const {
    std::ranges::transform(chain_.motions(path_.at(time)), out.begin(), rounded);
  }

  static std::shared_ptr<const ChainTruth> of(int count) {
    static std::map<int, std::shared_ptr<const ChainTruth>> known;
    auto& truth = known[count];
    if (!truth) truth = std::make_shared<const ChainTruth>(count);
    return truth;
  }

 private:
  RodChain chain_;
  Trajectory path_;
};

/// Returns the digits promised at t = 1 s with the tolerance 1e-9: 1e-9 for one rod, 1e-8 for 2 to 5, 1e-6
/// for 20 and 1e-5 for 100. In between (and beyond) it follows the straight line through these in log-log.
double promised(int count) {
  if (count == 1) return 1e-9;
  if (count <= 5) return 1e-8;
  const double slope = count <= 20 ? std::log(100) / std::log(4) : std::log(10) / std::log(5);
  return 1e-6 * std::pow(count / 20.0, slope);
}

Problem build(std::string_view, int count) {
  Problem problem{.scene = {.name = "pendulum_chain[" + std::to_string(count) + "]"}, .duration = 1};
  Scene& scene = problem.scene;
  const Shape shape = untouchable(Box{kLength, 0.05});
  for (int i = 0; i < count; ++i) {
    const std::string name = "rod" + std::to_string(i);
    scene.bodies.push_back({.name = name,
                            .position = {kLength * (i + 0.5), 0},
                            .mass = kMass,
                            .inertia = kMass * kLength * kLength / 12,
                            .shapes = {shape}});
    scene.joints.push_back(RevoluteJoint{.name = "hinge" + std::to_string(i),
                                         .body_a = i == 0 ? std::string(kWorld) : scene.bodies[i - 1].name,
                                         .body_b = name,
                                         .anchor_a = i == 0 ? Vec2d{} : Vec2d{kLength / 2, 0},
                                         .anchor_b = {-kLength / 2, 0}});
  }
  problem.truth = {.source = "Lagrange's equations in absolute angles, long double Runge-Kutta-Fehlberg 7(8)",
                   .exact = [truth = ChainTruth::of(count)](double time, std::span<BodyState> out) {
                     truth->at(time, out);
                   }};
  problem.conserved = {.energy = true};

  // A mode of frequency w multiplies a position error by w in the velocity. The fastest mode of a hanging
  // chain has w^2 < 4 N g/L (the largest zero of a Laguerre polynomial).
  const double digits = promised(count), fastest = std::sqrt(4 * count * kGravity / kLength);
  problem.precise = {.position = digits,
                     .angle = 2 / kLength * digits,
                     .velocity = fastest * digits,
                     .angular_velocity = 2 / kLength * fastest * digits,
                     .energy = digits,
                     .joint_gap = 1e-10};
  return problem;
}

const Register r{{.name = "pendulum_chain",
                  .summary = "N hinged rods released from the horizontal",
                  .sizes = {1, 2, 5, 20, 100},
                  .scales = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios
