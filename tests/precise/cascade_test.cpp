#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "engine/scene/error.h"
#include "tests/precise/contact_scenes.h"
#include "tests/precise/truth.h"

// Flat landings: corners that strike in turn, ever faster, against the same sequence followed in long double.
namespace plumb {
namespace {

using truth::Real;

int property_cases() {
  const char* text = std::getenv("PLUMB_PROPERTY_CASES");
  return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

/// A body with two corners below, above a smooth floor at y = 0 without gravity.
struct Landing {
  Real left = 0.5L, right = 0.5L, below = 0.25L;  // m, of the corners from the centre of mass
  Real mass = 1, inertia = 0.01L, restitution = 0.4L;
  Real angle = 1e-4L, height = 0.01L, speed = 1, spin = 0;  // height of the lower corner

  struct Motion {
    Real y = 0, angle = 0, vy = 0, w = 0;
  };

  Real corner_x(int i) const { return i == 0 ? -left : right; }
  Real gap(const Motion& s, int i) const {
    return s.y + corner_x(i) * std::sin(s.angle) - below * std::cos(s.angle);
  }
  Real lever(const Motion& s, int i) const {
    return corner_x(i) * std::cos(s.angle) + below * std::sin(s.angle);
  }
  Real rate(const Motion& s, int i) const { return s.vy + lever(s, i) * s.w; }

  Motion start() const {
    Motion s{0, angle, -speed, spin};
    s.y = height - std::min(gap(s, 0), gap(s, 1));
    return s;
  }

  /// When corner i strikes next, from now; never: infinite. Between impacts height and angle are linear in
  /// time: Newton's method from the line, along which the gap is all but straight.
  Real strikes_after(const Motion& s, int i) const {
    constexpr Real kNever = std::numeric_limits<Real>::infinity();
    if (!(rate(s, i) < 0)) return kNever;
    Real t = 0;
    for (int k = 0; k < 60; ++k) {
      const Motion at{s.y + t * s.vy, s.angle + t * s.w, s.vy, s.w};
      if (!(rate(at, i) < 0)) return kNever;
      const Real step = gap(at, i) / rate(at, i);
      t -= step;
      if (std::abs(step) <= 1e-20L + 1e-19L * std::abs(t)) break;
    }
    return std::max(t, Real{0});
  }

  /// Until `end`, s; impacts that shrink without end are followed until nothing is left of them.
  Motion after(Real end) const {
    Motion s = start();
    Real now = 0;
    int struck = -1;  // the one just struck opens until the other one is
    for (int impacts = 0; impacts < 200000; ++impacts) {
      constexpr Real kNever = std::numeric_limits<Real>::infinity();
      const Real first = struck == 0 ? kNever : strikes_after(s, 0);
      const Real second = struck == 1 ? kNever : strikes_after(s, 1);
      const Real until = std::min(first, second);
      if (!(now + until < end)) break;
      const int i = struck = first < second ? 0 : 1;
      s.y += until * s.vy, s.angle += until * s.w, now += until;
      const Real arm = lever(s, i), u = rate(s, i);
      if (std::abs(u) < 1e-18L * speed) {
        s.vy = s.w = 0;
        break;
      }
      const Real impulse = -(1 + restitution) * u / (1 / mass + arm * arm / inertia);
      s.vy += impulse / mass, s.w += impulse * arm / inertia;
    }
    s.y += (end - now) * s.vy, s.angle += (end - now) * s.w;
    return s;
  }

  Scene scene(bool as_polygon) const {
    Scene scene{.name = "landing", .gravity = {}};
    scene.contact_rules.restitution = Combine::Maximum;
    scene.contact_rules.restitution_threshold = 0;
    Body floor = ground(0, static_cast<double>(restitution));
    const Motion s = start();
    Body body{.name = "body",
              .position = {0, static_cast<double>(s.y)},
              .angle = static_cast<double>(s.angle),
              .velocity = {0, -static_cast<double>(speed)},
              .angular_velocity = static_cast<double>(spin),
              .mass = static_cast<double>(mass),
              .inertia = static_cast<double>(inertia)};
    const double l = static_cast<double>(left), r = static_cast<double>(right),
                 b = static_cast<double>(below);
    if (as_polygon) {
      body.shapes = {{.geometry = Polygon{.points = {{-l, -b}, {r, -b}, {0.4 * r, 1.5 * b}, {-0.6 * l, b}}},
                      .friction = 0,
                      .restitution = static_cast<double>(restitution)}};
    } else {
      body.shapes = {
          {.geometry = Box{2 * r, 2 * b}, .friction = 0, .restitution = static_cast<double>(restitution)}};
    }
    scene.bodies = {floor, body};
    return scene;
  }
};

void expect_landing(const Landing& landing, bool as_polygon, const std::string& what) {
  const auto driver = make_precise_driver(landing.scene(as_polygon), {.max_dt = 0.01}, {});
  const BodyState found = advance(*driver, 2, 5)[1];
  const Landing::Motion right = landing.after(0.05L);
  EXPECT_NEAR(found.velocity.y, static_cast<double>(right.vy), 1e-8) << what;
  EXPECT_NEAR(found.angular_velocity, static_cast<double>(right.w), 1e-7) << what;
  EXPECT_NEAR(found.position.y, static_cast<double>(right.y), 1e-9) << what;
}

TEST(PreciseCascades, AlternatingCornersEndAtRestWhereTheirLimitIsRest) {
  // Of I = 0.01 the cascade has a limit, of 0.002 too: ratios 0.78 and 0.97 a strike.
  for (const Real inertia : {0.01L, 0.002L}) {
    Landing landing{.inertia = inertia, .angle = 1e-4L, .height = 0.01L};
    const auto driver = make_precise_driver(landing.scene(false), {.max_dt = 0.01}, {});
    const BodyState found = advance(*driver, 2, 5)[1];
    EXPECT_NEAR(found.velocity.y, 0, 1e-10) << static_cast<double>(inertia);
    EXPECT_NEAR(found.angular_velocity, 0, 1e-9) << static_cast<double>(inertia);
  }
}

TEST(PreciseCascades, FlatLandingsAreThoseOfTheSequence) {
  std::mt19937 random(20260119);
  const auto uniform = [&](double low, double high) {
    return Real{low + (high - low) * (static_cast<double>(random()) / 4294967296.0)};
  };
  for (int k = 0; k < 60 * property_cases(); ++k) {
    const bool as_polygon = k % 2 == 1;
    Landing landing;
    landing.right = uniform(0.2, 1);
    landing.left = as_polygon ? uniform(0.2, 1) : landing.right;
    landing.below = uniform(0.05, 0.5);
    landing.mass = uniform(0.5, 3);
    landing.inertia = landing.mass * landing.right * landing.left * std::pow(Real{10}, uniform(-2.3, 0.3));
    landing.restitution = k % 4 < 2 ? 0 : uniform(0, 0.9);
    landing.angle = (k % 3 == 0 ? -1 : 1) * std::pow(Real{10}, uniform(-6, -2));
    expect_landing(landing, as_polygon, "case " + std::to_string(k));
  }
}

TEST(PreciseCascades, LevelLandingsStayLevel) {
  for (const Real restitution : {0.0L, 0.4L, 0.9L}) {
    Landing landing{.restitution = restitution, .angle = 0};
    const auto driver = make_precise_driver(landing.scene(false), {.max_dt = 0.01}, {});
    const BodyState found = advance(*driver, 2, 5)[1];
    EXPECT_NEAR(found.velocity.y, static_cast<double>(restitution), 1e-12);
    EXPECT_NEAR(found.angular_velocity, 0, 1e-12);
  }
}

}  // namespace
}  // namespace plumb
