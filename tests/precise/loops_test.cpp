#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "engine/scene/error.h"
#include "tests/precise/support.h"
#include "tests/precise/truth.h"

// Closed linkages that pass the places where they are singular, against one equation in one angle.
namespace plumb {
namespace {

using truth::Real;

int property_cases() {
  const char* text = std::getenv("PLUMB_PROPERTY_CASES");
  return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

/// A row of parallelograms beside each other: cranks of length `crank` on the ground at the given places,
/// turned by `angle` and turning at `speed`, and bars between neighbours, which stay level to the line of the
/// pivots, itself turned by `tilt`.
struct Parallelograms {
  std::vector<double> pivots{0, 1};  // m, along the line
  double crank = 1, angle = kPi / 2, speed = -1, tilt = 0;
  std::vector<double> crank_masses{1, 1}, bar_masses{1};

  Scene scene() const {
    Scene scene{.name = "parallelograms"};
    const auto turned = [](double length, double by) {
      return Vec2d{length * std::cos(by), length * std::sin(by)};
    };
    const Vec2d tip = turned(crank, angle), across = perpendicular(tip);
    for (std::size_t i = 0; i < pivots.size(); ++i) {
      const std::string name = "crank" + std::to_string(i);
      const Vec2d pivot = turned(pivots[i], tilt);
      scene.bodies.push_back({.name = name,
                              .position = pivot + 0.5 * tip,
                              .angle = angle,
                              .velocity = (0.5 * speed) * across,
                              .angular_velocity = speed,
                              .mass = crank_masses[i],
                              .inertia = crank_masses[i] * crank * crank / 12});
      scene.joints.push_back(RevoluteJoint{
          "ground" + std::to_string(i), std::string(kWorld), name, pivot, {-0.5 * crank, 0}, false});
    }
    for (std::size_t i = 0; i + 1 < pivots.size(); ++i) {
      const std::string name = "bar" + std::to_string(i);
      const double length = pivots[i + 1] - pivots[i];
      scene.bodies.push_back({.name = name,
                              .position = turned(0.5 * (pivots[i] + pivots[i + 1]), tilt) + tip,
                              .angle = tilt,
                              .velocity = speed * across,
                              .mass = bar_masses[i],
                              .inertia = bar_masses[i] * length * length / 12});
      scene.joints.push_back(RevoluteJoint{"left" + std::to_string(i),
                                           "crank" + std::to_string(i),
                                           name,
                                           {0.5 * crank, 0},
                                           {-0.5 * length, 0},
                                           false});
      scene.joints.push_back(RevoluteJoint{"right" + std::to_string(i),
                                           name,
                                           "crank" + std::to_string(i + 1),
                                           {0.5 * length, 0},
                                           {0.5 * crank, 0},
                                           false});
    }
    return scene;
  }

  /// (sum m_c l^2 / 3 + sum m_b l^2) q'' = -g l (sum m_c / 2 + sum m_b) cos q: the cranks' angle after
  /// `seconds`.
  Real angle_after(double seconds) const {
    Real inertia = 0, moment = 0;
    for (const double m : crank_masses) inertia += Real{m} * crank / 3, moment += Real{m} / 2;
    for (const double m : bar_masses) inertia += Real{m} * crank, moment += m;
    const auto f = [k = 9.81L * moment / inertia](Real, const std::vector<Real>& y, std::vector<Real>& out) {
      out = {y[1], -k * std::cos(y[0])};
    };
    return truth::integrate_twice(f, {angle, speed}, 0, seconds, static_cast<int>(1500 * seconds))[0];
  }
};

/// Runs for so long; the cranks' angle. Empty where the run is refused, by an error that says so.
std::optional<double> crank_after(const Scene& scene, double tolerance, double seconds,
                                  std::int64_t* evaluations = nullptr) {
  const auto driver = make_precise_driver(scene, {.tolerance = tolerance}, {});
  try {
    const auto states = advance(*driver, scene.bodies.size(), static_cast<int>(std::lround(seconds * 60)));
    if (evaluations != nullptr) *evaluations = driver->statistics().evaluations;
    return states[0].angle;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Run) << error.what();
    return {};
  }
}

TEST(PreciseLoops, ParallelogramStaysOnItsBranchDownToTheLeastTolerance) {
  const Parallelograms one;
  std::int64_t at_loose = 0, at_tight = 0;
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-11}) {
    const auto angle = crank_after(one.scene(), tolerance, 20, tolerance == 1e-6 ? &at_loose : &at_tight);
    ASSERT_TRUE(angle.has_value()) << tolerance;
    EXPECT_NEAR(*angle, -63.118844095906, std::max(tolerance, 2e-11)) << tolerance;
  }
  EXPECT_LT(at_tight, 10 * at_loose);
}

TEST(PreciseLoops, ParallelogramsBesideEachOtherPassTheirFlatPlaceTogether) {
  for (const int n : {2, 5, 12}) {
    Parallelograms row{.pivots = {0}, .crank_masses = {1}, .bar_masses = {}};
    for (int i = 1; i <= n; ++i)
      row.pivots.push_back(i), row.crank_masses.push_back(1), row.bar_masses.push_back(1);
    for (const double tolerance : {1e-6, 1e-10}) {
      const auto angle = crank_after(row.scene(), tolerance, 5);
      ASSERT_TRUE(angle.has_value()) << n << " at " << tolerance;
      EXPECT_NEAR(*angle, static_cast<double>(row.angle_after(5)), std::max(tolerance, 2e-11)) << n;
    }
  }
}

TEST(PreciseLoops, RandomParallelogramsKeepTheirToleranceOrAreRefused) {
  std::mt19937 random(20260117);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  int refused = 0;
  const int cases = 24 * property_cases();
  for (int k = 0; k < cases; ++k) {
    Parallelograms row{.pivots = {uniform(-1, 1)},
                       .crank = uniform(0.3, 2),
                       .angle = uniform(-3, 3),
                       .speed = uniform(-12, 12),
                       .tilt = uniform(-3, 3),
                       .crank_masses = {uniform(0.1, 5)},
                       .bar_masses = {}};
    const int n = 1 + static_cast<int>(random() % 3);
    for (int i = 0; i < n; ++i) {
      row.pivots.push_back(row.pivots.back() + uniform(0.3, 2.5));
      row.crank_masses.push_back(uniform(0.1, 5));
      row.bar_masses.push_back(uniform(0.1, 5));
    }
    const double tolerance = std::pow(10.0, -uniform(5, 11));
    const auto angle = crank_after(row.scene(), tolerance, 3);
    if (!angle) {
      ++refused;
      continue;
    }
    EXPECT_NEAR(*angle, static_cast<double>(row.angle_after(3)), 10 * std::max(tolerance, 1e-11))
        << "case " << k << " at " << tolerance;
  }
  EXPECT_LE(refused, cases / 12);
}

/// A crank and a rod of one length, whose end slides along a line through the crank's pivot, turned by
/// `tilt`: folded, the rod may turn about the pivot instead.
struct SliderCrank {
  double length = 1, angle = kPi / 4, speed = 4, tilt = 0, crank_mass = 1, rod_mass = 1, slider_mass = 1;

  Scene scene() const {
    Scene scene{.name = "slider-crank"};
    const Vec2d axis{std::cos(tilt), std::sin(tilt)}, up = perpendicular(axis);
    const auto at = [&](double along, double above) { return along * axis + above * up; };
    const double c = std::cos(angle), s = std::sin(angle), l = length;
    scene.bodies = {{.name = "crank",
                     .position = at(0.5 * l * c, 0.5 * l * s),
                     .angle = tilt + angle,
                     .velocity = at(-0.5 * l * s * speed, 0.5 * l * c * speed),
                     .angular_velocity = speed,
                     .mass = crank_mass,
                     .inertia = crank_mass * l * l / 12},
                    {.name = "rod",
                     .position = at(1.5 * l * c, 0.5 * l * s),
                     .angle = tilt - angle,
                     .velocity = at(-1.5 * l * s * speed, 0.5 * l * c * speed),
                     .angular_velocity = -speed,
                     .mass = rod_mass,
                     .inertia = rod_mass * l * l / 12},
                    {.name = "slider",
                     .position = at(2 * l * c, 0),
                     .velocity = at(-2 * l * s * speed, 0),
                     .mass = slider_mass,
                     .inertia = 1}};
    scene.joints = {
        RevoluteJoint{"pivot", std::string(kWorld), "crank", {0, 0}, {-0.5 * l, 0}, false},
        RevoluteJoint{"knee", "crank", "rod", {0.5 * l, 0}, {-0.5 * l, 0}, false},
        RevoluteJoint{"pin", "rod", "slider", {0.5 * l, 0}, {0, 0}, false},
        PrismaticJoint{.name = "rail", .body_a = std::string(kWorld), .body_b = "slider", .axis = axis}};
    return scene;
  }

  /// With x = 1.5 l cos q and y = 0.5 l sin q of the rod and 2 l cos q of the slider:
  /// M(q) = m_c l^2/3 + m_r l^2 (9 s^2 + c^2)/4 + m_r l^2/12 + 4 m_s l^2 s^2,
  /// V(q) = g . (what is raised), M q'' + M'/2 q'^2 + V' = 0.
  Real angle_after(double seconds) const {
    const Real l = length, c0 = std::cos(Real{tilt}), s0 = std::sin(Real{tilt});
    const auto f = [&](Real, const std::vector<Real>& y, std::vector<Real>& out) {
      const Real c = std::cos(y[0]), s = std::sin(y[0]);
      const Real m = crank_mass * l * l / 3 + rod_mass * l * l * (9 * s * s + c * c) / 4 +
                     rod_mass * l * l / 12 + 4 * slider_mass * l * l * s * s;
      const Real half_change = (2 * rod_mass + 4 * slider_mass) * l * l * s * c;
      const Real along = -(0.5L * crank_mass + 1.5L * rod_mass + 2 * slider_mass) * l * s;
      const Real above = (0.5L * crank_mass + 0.5L * rod_mass) * l * c;
      out = {y[1], -(half_change * y[1] * y[1] + 9.81L * (along * s0 + above * c0)) / m};
    };
    return truth::integrate_twice(f, {angle, speed}, 0, seconds, static_cast<int>(6000 * seconds))[0];
  }
};

TEST(PreciseLoops, SliderCrankOfEqualLinksPassesItsFoldedPlace) {
  const SliderCrank one;
  for (const double tolerance : {1e-6, 1e-9, 1e-11}) {
    const auto angle = crank_after(one.scene(), tolerance, 10);
    ASSERT_TRUE(angle.has_value()) << tolerance;
    EXPECT_NEAR(*angle, static_cast<double>(one.angle_after(10)), std::max(tolerance, 2e-11)) << tolerance;
  }
}

TEST(PreciseLoops, RandomSliderCranksKeepTheirToleranceOrAreRefused) {
  std::mt19937 random(20260118);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  int refused = 0;
  const int cases = 16 * property_cases();
  for (int k = 0; k < cases; ++k) {
    const SliderCrank one{.length = uniform(0.2, 2),
                          .angle = uniform(0.2, 1.3),
                          .speed = uniform(-9, 9),
                          .tilt = uniform(-3, 3),
                          .crank_mass = uniform(0.2, 4),
                          .rod_mass = uniform(0.2, 4),
                          .slider_mass = uniform(0.2, 4)};
    const double tolerance = std::pow(10.0, -uniform(5, 11));
    const auto angle = crank_after(one.scene(), tolerance, 2);
    if (!angle) {
      ++refused;
      continue;
    }
    EXPECT_NEAR(*angle - one.tilt, static_cast<double>(one.angle_after(2)), 10 * std::max(tolerance, 1e-11))
        << "case " << k << " at " << tolerance;
  }
  EXPECT_LE(refused, cases / 8);
}

TEST(PreciseLoops, WhatIsReadOnTheFlatPlaceItselfIsAsExact) {
  const Parallelograms one;
  const Scene scene = one.scene();
  const auto driver = make_precise_driver(scene, {.tolerance = 1e-9, .max_dt = 1e-3}, {});
  std::vector<BodyState> states(scene.bodies.size());
  for (int i = 0; i < 3000; ++i) {
    driver->step();
    driver->read(states);
    ASSERT_NEAR(states[2].angle, 0, 1e-9) << driver->time();
    ASSERT_NEAR(states[2].angular_velocity, 0, 1e-7) << driver->time();
    ASSERT_NEAR(states[0].angle, states[1].angle, 1e-9) << driver->time();
  }
}

TEST(PreciseLoops, StartsOnTheFlatPlaceGoTheWayOfTheirSpeed) {
  Parallelograms one{.angle = 0, .speed = -3};
  for (const double tolerance : {1e-6, 1e-11}) {
    const auto angle = crank_after(one.scene(), tolerance, 3);
    ASSERT_TRUE(angle.has_value());
    EXPECT_NEAR(*angle, static_cast<double>(one.angle_after(3)), std::max(tolerance, 1e-10)) << tolerance;
  }
}

TEST(PreciseLoops, BranchesThatAllButMeetAreFollowedOrRefusedNotSteppedOver) {
  // One pivot is off by so much: in the line the bar turns over, at any distance from the other branch. What
  // goes on level has gone through where there is no way.
  for (const double off : {1e-3, 1e-6, 1e-9, 1e-12}) {
    Scene scene = Parallelograms{}.scene();
    std::get<RevoluteJoint>(scene.joints[1]).anchor_a.x += off;
    for (const double tolerance : {1e-4, 1e-6, 1e-9}) {
      const auto driver = make_precise_driver(scene, {.tolerance = tolerance}, {});
      std::vector<BodyState> states;
      try {
        states = advance(*driver, 3, 75);  // past the first line, not to the second
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("tolerance"), std::string::npos) << error.what();
        continue;
      }
      EXPECT_GT(std::abs(states[2].angle), 0.5) << off << " at " << tolerance;
    }
  }
}

TEST(PreciseLoops, RunsThatAreSavedNearTheFlatPlaceGoOnTheSame) {
  const Scene scene = Parallelograms{}.scene();
  const auto driver = make_precise_driver(scene, {.max_dt = 0.01}, {});
  for (int i = 0; i < 140; ++i) {  // the first line is passed at 0.708 s
    const std::vector<std::byte> saved = driver->save();
    const auto other = make_precise_driver(scene, {.max_dt = 0.01}, {});
    other->restore(saved);
    const auto there = advance(*other, 3, 5);
    advance(*driver, 3, 1);
    const auto beside = make_precise_driver(scene, {.max_dt = 0.01}, {});
    beside->restore(driver->save());
    EXPECT_EQ(advance(*beside, 3, 4)[0].angle, there[0].angle) << i;
  }
}

}  // namespace
}  // namespace plumb
