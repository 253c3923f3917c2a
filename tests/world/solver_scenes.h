#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/world/support.h"

/// Scenes that every solver is held against.
namespace plumb::test {

inline constexpr double kPi = 3.14159265358979323846;

inline WorldDefinition with(Solver solver, int iterations = 10) {
  return {.sleeping = false, .solver = solver, .iterations = iterations};
}

inline WorldDefinition weightless(Solver solver, int iterations = 10) {
  WorldDefinition definition = with(solver, iterations);
  definition.gravity = {0, 0};
  return definition;
}

/// A static body without shapes, to hang things on.
template <class Real>
BodyId add_hook(BasicWorld<Real>& world, Vec2d at = {0, 0}) {
  return world.create_body({.type = BodyType::Static, .position = at});
}

/// A body without shapes, kg and kg m^2.
template <class Real>
BodyId add_mass(BasicWorld<Real>& world, Vec2d at, double mass, double inertia, Vec2d velocity = {}) {
  return world.create_body(
      {.position = at, .velocity = velocity, .mass = MassProperties{.mass = mass, .inertia = inertia}});
}

struct Chain {
  std::vector<BodyId> links;
  std::vector<JointId> joints;
};

/// Rods of 1 m and 1 kg, laid along +x from the origin, the last one of mass `tip`.
template <class Real>
Chain add_chain(BasicWorld<Real>& world, int count, double tip = 1) {
  Chain chain;
  BodyId before = add_hook(world);
  for (int i = 0; i < count; ++i) {
    const double mass = i + 1 == count ? tip : 1;
    const BodyId link = add_mass(world, {i + 0.5, 0}, mass, mass / 12);
    const Vec2d end = i == 0 ? Vec2d{0, 0} : Vec2d{0.5, 0};
    chain.joints.push_back(world.create_joint(
        before, link, {.kind = RevoluteDefinition{.anchor_a = end, .anchor_b = {-0.5, 0}}}));
    chain.links.push_back(link);
    before = link;
  }
  return chain;
}

template <class Real>
double worst_gap(const BasicWorld<Real>& world, const std::vector<JointId>& joints) {
  double worst = 0;
  for (const JointId joint : joints) worst = std::max(worst, world.read(joint).linear_error);
  return worst;
}

/// The worst gap over `steps`.
template <class Real>
double run_gap(BasicWorld<Real>& world, const std::vector<JointId>& joints, int steps, double dt = 1.0 / 60,
               int substeps = 4) {
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    world.step(dt, substeps);
    worst = std::max(worst, worst_gap(world, joints));
  }
  return worst;
}

/// m, of the drift that a rod of length L at speed v makes in a substep h: the tangent leaves the circle.
inline double tangent_drift(double speed, double length, double h) {
  return h * h * speed * speed / (2 * length);
}

inline std::string solver_name(const testing::TestParamInfo<Solver>& info) { return name_of(info.param); }

inline auto all_solvers() {
  return testing::Values(Solver::SoftSteps, Solver::SequentialImpulses, Solver::Jakobsen, Solver::Xpbd,
                         Solver::Direct);
}

}  // namespace plumb::test
