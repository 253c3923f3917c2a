#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/error.h"
#include "tests/precise/support.h"
#include "tests/precise/truth.h"

// Equal cranks that turn against each other (an antiparallelogram) pass the line of their pivots, where they
// could as well go on level: two branches of motion cross. Truth is one equation in one angle.
namespace plumb {
namespace {

using truth::Real;

struct CrossedCranks {
  double crank = 0.5, ground = 1;         // m
  double angle = 1, speed = 4;            // of the first crank
  double first = 1, second = 1, bar = 1;  // kg

  struct Place {
    Real c, s;            // cosine and sine of the second crank's angle
    Real turn;            // its angle by the first one's
    Vec2<Real> from, to;  // ends of the bar
    Vec2<Real> from_rate, to_rate;
  };

  // tan(second / 2) = -k tan(first / 2) with k = (ground + crank) / (ground - crank), as of rolling ellipses.
  Place at(Real q) const {
    const Real l = crank, g = ground, k = (g + l) / (g - l), c = std::cos(q / 2), s = std::sin(q / 2),
               sum = c * c + k * k * s * s;
    Place p{};
    p.c = (c * c - k * k * s * s) / sum, p.s = -2 * k * s * c / sum, p.turn = -k / sum;
    p.from = {l * std::cos(q), l * std::sin(q)}, p.to = {g + l * p.c, l * p.s};
    p.from_rate = {-p.from.y, p.from.x}, p.to_rate = {-p.turn * l * p.s, p.turn * l * p.c};
    return p;
  }

  Real bar_rate(const Place& p) const {
    const Real x = p.to.x - p.from.x, y = p.to.y - p.from.y;
    return (x * (p.to_rate.y - p.from_rate.y) - y * (p.to_rate.x - p.from_rate.x)) / (Real{ground} * ground);
  }

  Real inertia(Real q) const {
    const Place p = at(q);
    const Real x = (p.from_rate.x + p.to_rate.x) / 2, y = (p.from_rate.y + p.to_rate.y) / 2, w = bar_rate(p);
    return crank * Real{crank} * (first + second * p.turn * p.turn) / 3 +
           bar * (x * x + y * y + Real{ground} * ground * w * w / 12);
  }

  Real height(Real q) const {  // times weight, J
    const Place p = at(q);
    return 9.81L * (first * p.from.y + second * p.to.y + bar * (p.from.y + p.to.y)) / 2;
  }

  /// M q'' + M'/2 q'^2 + V' = 0, with differences of order four for the derivatives by q.
  Real angle_after(double seconds) const {
    const auto slope = [](const auto& of, Real q) {
      constexpr Real h = 5e-4L;
      return (8 * (of(q + h) - of(q - h)) - (of(q + 2 * h) - of(q - 2 * h))) / (12 * h);
    };
    const auto f = [&](Real, const std::vector<Real>& y, std::vector<Real>& out) {
      const auto m = [&](Real q) { return inertia(q); };
      const auto v = [&](Real q) { return height(q); };
      out = {y[1], -(slope(m, y[0]) * y[1] * y[1] / 2 + slope(v, y[0])) / inertia(y[0])};
    };
    return truth::integrate_twice(f, {angle, speed}, 0, seconds, static_cast<int>(3000 * seconds))[0];
  }

  Scene scene() const {
    const Place p = at(angle);
    const auto rod = [&](std::string name, Vec2<Real> a, Vec2<Real> b, Vec2<Real> va, Vec2<Real> vb,
                         Real rate, double mass, double length) {
      const Real w = rate * speed, k = speed / Real{2};
      return Body{.name = std::move(name),
                  .position = Vec2<Real>{(a.x + b.x) / 2, (a.y + b.y) / 2}.as<double>(),
                  .angle = static_cast<double>(std::atan2(b.y - a.y, b.x - a.x)),
                  .velocity = Vec2<Real>{k * (va.x + vb.x), k * (va.y + vb.y)}.as<double>(),
                  .angular_velocity = static_cast<double>(w),
                  .mass = mass,
                  .inertia = mass * length * length / 12};
    };
    const Vec2<Real> rest{}, pivot{ground, 0};
    Scene scene{.name = "crossed cranks"};
    scene.bodies = {rod("first", rest, p.from, rest, p.from_rate, 1, first, crank),
                    rod("second", pivot, p.to, rest, p.to_rate, p.turn, second, crank),
                    rod("bar", p.from, p.to, p.from_rate, p.to_rate, bar_rate(p), bar, ground)};
    scene.bodies[0].angle = angle;
    const Vec2d half{0.5 * crank, 0}, end{0.5 * ground, 0};
    scene.joints = {RevoluteJoint{"pivot0", std::string(kWorld), "first", {0, 0}, -half, false},
                    RevoluteJoint{"pivot1", std::string(kWorld), "second", {ground, 0}, -half, false},
                    RevoluteJoint{"pin0", "first", "bar", half, -end, false},
                    RevoluteJoint{"pin1", "bar", "second", end, half, false}};
    return scene;
  }
};

// Returns the first crank's angle.
double angle_after(const Scene& scene, double tolerance, double seconds, std::int64_t& evaluations) {
  const auto driver = make_precise_driver(scene, {.tolerance = tolerance}, {});
  const auto states = advance(*driver, scene.bodies.size(), static_cast<int>(std::lround(seconds * 60)));
  evaluations = driver->statistics().evaluations;
  return states[0].angle;
}

// A perturbation of the start is amplified by up to 50 in this time.
TEST(PreciseCrossedCranks, PassTheLineOfTheirPivotsDownToTheFinestTolerances) {
  std::mt19937 random(20261128);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  for (int k = 0; k < 10; ++k) {
    const double ground = uniform(0.6, 3);
    const CrossedCranks cranks{.crank = ground * uniform(0.1, 0.7),
                               .ground = ground,
                               .angle = uniform(0.5, 2.6),
                               .speed = uniform(3, 8) * (k % 2 == 0 ? 1 : -1),
                               .first = uniform(0.2, 4),
                               .second = uniform(0.2, 4),
                               .bar = uniform(0.2, 4)};
    const Scene scene = cranks.scene();
    const double angle = static_cast<double>(cranks.angle_after(2));
    std::int64_t loose = 0, fine = 0;
    EXPECT_NEAR(angle_after(scene, 1e-6, 2, loose), angle, 5e-5) << k;
    for (const double tolerance : {1e-9, 1e-10, 1e-11}) {
      try {
        EXPECT_NEAR(angle_after(scene, tolerance, 2, fine), angle, 50 * tolerance)
            << k << " at " << tolerance;
      } catch (const Error& error) {
        ADD_FAILURE() << k << " at " << tolerance << ": " << error.what();
      }
    }
    EXPECT_LT(fine, 10 * loose) << k;
  }
}

}  // namespace
}  // namespace plumb
