#include "scenarios/truth/parts.h"
#include "scenarios/truth/phases.h"

// A bead slides on a rotating arm: r'' = w^2 r, and w (I + m r^2) is conserved. Source: Lagrange.
namespace plumb::scenarios::bead_on_arm {
namespace {
using namespace truth;

constexpr double kBead = 0.5, kArm = 2, kStart = 0.4, kSpin = 3;  // kg, kg, m, rad/s

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("bead_on_arm", "", 0), .duration = 1};
  problem.scene.bodies = {
      thrown(piece("arm", {}, untouchable(Box{2, 0.1}), kArm), {}, kSpin),
      thrown(piece("bead", {kStart, 0}, untouchable(Circle{0.1}), kBead), {0, kStart * kSpin}, kSpin)};
  problem.scene.joints = {hinge(kWorld, {}, "arm", {}),
                          PrismaticJoint{.name = "slide", .body_a = "arm", .body_b = "bead"}};
  const Real inertia = kArm * 4.01L / 12 + kBead * 0.01L / 2;
  const Real momentum = kSpin * (inertia + kBead * Real(kStart) * kStart);
  const auto spin = [=](Real r) { return momentum / (inertia + kBead * r * r); };
  const auto law = [=](const Trajectory::State& y, Trajectory::State& rate) {
    rate = {y[1], spin(y[0]) * spin(y[0]) * y[0], spin(y[0])};
  };
  const Phases path({kStart, 0, 0}, {{law}}, 1);
  const auto motion = [=](Real t, Moving moving) {
    const auto y = path.at(t);
    const Vec2<Real> way = y[0] * direction(y[2]);
    moving[0] = {{}, y[2], {}, spin(y[0])};
    moving[1] = {way, y[2], y[1] * direction(y[2]) + cross(spin(y[0]), way), spin(y[0])};
  };
  problem.truth = integrated(follow(problem.scene, "r'' = w^2 r, w (I + m r^2) constant", motion));
  problem.conserved = {.energy = true, .angular_momentum = true};
  problem.precise = within(1e-9);
  return problem;
}

const Register r{{.name = "bead_on_arm", .summary = "a bead slides out on a rotating arm", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::bead_on_arm
