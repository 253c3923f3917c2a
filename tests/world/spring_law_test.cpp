#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "engine/world/force_laws.h"
#include "engine/world/world.h"

namespace plumb {
namespace {

// Springs as force laws, for motion across their line: of a pull along the line at the start of each step,
// orbits grow by exp(omega^2 dt t / 4).
template <class Real>
class SpringLaw : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(SpringLaw, Precisions);

WorldDefinition weightless() {
  WorldDefinition out;
  out.gravity = {0, 0};
  out.sleeping = false;
  return out;
}

// A mass on a spring of rest length 0 moves on an ellipse, whose energy and angular momentum are constant.
TYPED_TEST(SpringLaw, OrbitsKeepEnergyAndAngularMomentum) {
  constexpr double kStiffness = 40, kDt = 1.0 / 60;
  BasicWorld<TypeParam> w(weightless());
  const BodyId post = w.create_body({.type = BodyType::Static});
  BodyDefinition definition{.position = {1, 0}, .velocity = {0, 4}};
  definition.mass = MassProperties{.mass = 1, .inertia = 0.1};
  const BodyId ball = w.create_body(definition);
  const auto momentum = [&] { return cross(w.centre(ball), w.velocity(ball)); };
  const double before = 0.5 * 16 + 0.5 * kStiffness, turn = momentum();
  double least = before, most = before;
  for (int i = 0; i < 6000; ++i) {
    apply_spring(w, post, {}, ball, {}, {.stiffness = kStiffness, .damping = 0, .rest_length = 0}, kDt);
    w.step(kDt);
    const double energy =
        0.5 * length_squared(w.velocity(ball)) + 0.5 * kStiffness * length_squared(w.centre(ball));
    least = std::min(least, energy), most = std::max(most, energy);
  }
  // The pull does work equal to the loss of elastic energy exactly; what remains is rounding, of 6000 steps.
  const double rounding = std::is_same_v<TypeParam, float> ? 1e-4 : 1e-9;
  EXPECT_GT(least, (1 - rounding) * before);
  EXPECT_LT(most, (1 + rounding) * before);
  EXPECT_NEAR(momentum(), turn, rounding * turn);
}

// A bar that hangs by its end swings and turns below the spring.
TYPED_TEST(SpringLaw, HungBarsNeitherGainNorLoseEnergy) {
  constexpr double kDt = 1.0 / 60;
  WorldDefinition definition = weightless();
  definition.gravity = {0, -10};
  BasicWorld<TypeParam> w(definition);
  const BodyId post = w.create_body({.type = BodyType::Static});
  const BodyId bar = w.create_body({.position = {1, -0.2}, .angle = 0.4},
                                   ShapeDefinition{.geometry = Box{1, 0.2}, .density = 5});
  const ElasticSpring spring{.stiffness = 40, .damping = 0, .rest_length = 0.3};
  const auto energy = [&] {
    const double stretch = length(w.world_point(bar, {-0.5, 0})) - spring.rest_length;
    return 0.5 * w.mass(bar) * length_squared(w.velocity(bar)) +
           0.5 * w.inertia(bar) * w.angular_velocity(bar) * w.angular_velocity(bar) +
           10 * w.mass(bar) * w.centre(bar).y + 0.5 * spring.stiffness * stretch * stretch;
  };
  const double before = energy();
  double least = before, most = before;
  for (int i = 0; i < 6000; ++i) {
    apply_spring(w, post, {}, bar, {-0.5, 0}, spring, kDt);
    w.step(kDt);
    least = std::min(least, energy()), most = std::max(most, energy());
  }
  // The bar's end is evaluated with the force's lever arm half a step ahead, which is of second order: 5 J
  // are moved between height, motion and stretch.
  EXPECT_GT(least, before - 0.5);
  EXPECT_LT(most, before + 0.5);
}

// Masses that several springs hold: each spring knows its own effect alone, so that energies vary by the
// square of omega dt (up to 0.5 here, with eight springs on a mass), but do not grow.
TYPED_TEST(SpringLaw, GridsOfManySpringsKeepTheirEnergy) {
  constexpr double kDt = 1.0 / 60, kStiffness = 100;
  constexpr int kSide = 5;
  BasicWorld<TypeParam> w(weightless());
  std::vector<BodyId> masses;
  for (int i = 0; i < kSide * kSide; ++i) {
    BodyDefinition definition{.position = {double(i / kSide), double(i % kSide)},
                              .velocity = {0.3 * (i % 3 - 1), 0.4 * (i % 4 - 1.5)}};
    definition.mass = MassProperties{.mass = 1, .inertia = 0.1};
    masses.push_back(w.create_body(definition));
  }
  struct Edge {
    int a, b;
    double length;
  };
  std::vector<Edge> edges;
  for (int a = 0; a < kSide * kSide; ++a)
    for (int b = a + 1; b < kSide * kSide; ++b)
      if (const double apart = length(w.centre(masses[a]) - w.centre(masses[b])); apart < 1.5)
        edges.push_back({a, b, apart});
  const auto energy = [&] {
    double sum = 0;
    for (const BodyId mass : masses) sum += 0.5 * length_squared(w.velocity(mass));
    for (const Edge& edge : edges) {
      const double stretch = length(w.centre(masses[edge.a]) - w.centre(masses[edge.b])) - edge.length;
      sum += 0.5 * kStiffness * stretch * stretch;
    }
    return sum;
  };
  const double before = energy();
  for (int i = 0; i < 6000; ++i) {
    for (const Edge& edge : edges)
      apply_spring(w, masses[edge.a], {}, masses[edge.b], {},
                   {.stiffness = kStiffness, .damping = 0, .rest_length = edge.length}, kDt);
    w.step(kDt);
  }
  EXPECT_NEAR(energy(), before, 0.03 * before);
}

// A rubber band does no work while it is slack, and returns what it took.
TYPED_TEST(SpringLaw, RubberBandsReturnTheirEnergy) {
  constexpr double kDt = 1.0 / 60;
  BasicWorld<TypeParam> w(weightless());
  const BodyId post = w.create_body({.type = BodyType::Static});
  BodyDefinition definition{.position = {0.5, 0}, .velocity = {3, 2}};
  definition.mass = MassProperties{.mass = 1, .inertia = 0.1};
  const BodyId ball = w.create_body(definition);
  const ElasticSpring band{.stiffness = 40, .damping = 0, .rest_length = 1, .pulls_only = true};
  const auto energy = [&] {
    const double stretch = std::max(length(w.centre(ball)) - band.rest_length, 0.0);
    return 0.5 * length_squared(w.velocity(ball)) + 0.5 * band.stiffness * stretch * stretch;
  };
  const double before = energy();
  for (int i = 0; i < 6000; ++i) {
    apply_spring(w, post, {}, ball, {}, band, kDt);
    w.step(kDt);
  }
  const double rounding = std::is_same_v<TypeParam, float> ? 1e-3 : 1e-8;  // J, of 6.5 J
  EXPECT_NEAR(energy(), before, rounding);
}

}  // namespace
}  // namespace plumb
