#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "tests/world/support.h"

// Impacts of bodies that nothing else holds have their time within the step, for every shape: held against
// flights that are computed corner by corner, and against what impacts keep.
namespace plumb {
namespace {

constexpr double kStep = 1.0 / 60;

int cases(int usual) {
  const char* text = std::getenv("PLUMB_PROPERTY_CASES");
  return usual * (text == nullptr ? 1 : std::max(1, std::atoi(text)));
}

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double operator()(double a, double b) {
    return a + (b - a) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937_64 random_;
};

// A body with rounded corners above a plane at y = 0, that flies and bounces without friction. The truth:
// free flight is a parabola and an even turn; the lowest corner strikes with J = (1 + e) m c / (1 + m x^2 /
// I), x its distance from the centre along the plane.
struct Flyer {
  std::vector<Vec2d> corners;  // about the centre of mass
  double radius = 0, mass = 1, inertia = 1, restitution = 1, gravity = kGravity;
  double y = 0, vy = 0, angle = 0, spin = 0;
  double slowest = std::numeric_limits<double>::infinity();  // m/s, of the impacts so far
  double closest = std::numeric_limits<double>::infinity();  // m, of a second corner at one
  int impacts = 0;

  double height(double t, int* lowest = nullptr) const {
    const double c = std::cos(angle + spin * t), s = std::sin(angle + spin * t);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const double h = s * corners[i].x + c * corners[i].y;
      if (h < least && lowest != nullptr) *lowest = static_cast<int>(i);
      least = std::min(least, h);
    }
    return y + t * (vy - 0.5 * gravity * t) + least - radius;
  }
  void go_on(double t) { y += t * (vy - 0.5 * gravity * t), vy -= gravity * t, angle += spin * t; }
  void strike() {
    int corner = 0;
    const double least = height(0, &corner);
    const double c = std::cos(angle), s = std::sin(angle);
    for (int i = 0; i < static_cast<int>(corners.size()); ++i)
      if (i != corner) closest = std::min(closest, y + s * corners[i].x + c * corners[i].y - radius - least);
    const double x = c * corners[corner].x - s * corners[corner].y;
    const double closing = -(vy + spin * x);
    const double impulse = (1 + restitution) * closing / (1 / mass + x * x / inertia);
    vy += impulse / mass, spin += impulse * x / inertia;
    slowest = std::min(slowest, closing);
    ++impacts;
  }
  void advance(double time) {
    constexpr int kSamples = 400;
    while (time > 0) {
      const double piece = time / kSamples;
      double hit = -1;
      // A body that has just struck is at 0 and parts.
      for (int i = 1; i <= kSamples && hit < 0; ++i)
        if (height(piece * i) < 0) hit = piece * i;
      if (hit < 0) return go_on(time);
      double low = std::max(hit - piece, impacts > 0 ? 1e-12 : 0), high = hit;
      for (int i = 0; i < 80; ++i) {
        const double middle = (low + high) / 2;
        (height(middle) < 0 ? high : low) = middle;
      }
      go_on(low), time -= low;
      strike();
    }
  }
  double energy() const { return mass * (0.5 * vy * vy + gravity * y) + 0.5 * inertia * spin * spin; }
};

struct Form {
  ShapeGeometry geometry;
  std::vector<Vec2d> corners;
  double radius = 0;
};

Form any_form(Draw& draw) {
  const double w = draw(0.3, 1.5), h = w * draw(0.1, 1);
  switch (draw.below(3)) {
    case 0:
      return {Box{w, h}, {{-w / 2, -h / 2}, {w / 2, -h / 2}, {w / 2, h / 2}, {-w / 2, h / 2}}};
    case 1:
      return {Capsule{{-w / 2, 0}, {w / 2, 0}, h / 2}, {{-w / 2, 0}, {w / 2, 0}}, h / 2};
    default: {
      // An even number of corners: its middle is the centre of mass.
      std::vector<Vec2d> corners;
      for (int i = 0; i < 6; ++i)
        corners.push_back(0.5 * w *
                          Vec2d{std::cos(i * 1.0471975511965976), std::sin(i * 1.0471975511965976)});
      return {Polygon{corners}, corners};
    }
  }
}

// m and rad, of the start: small beside a body, and far above the roundings that it stands for.
constexpr double kDisturbance = 1e-9;

// Returns by how much a disturbance of the start has grown, at most of positions, angles and their rates.
double growth(const Flyer& truth, const Flyer& disturbed) {
  return std::max({std::abs(disturbed.y - truth.y), std::abs(disturbed.angle - truth.angle),
                   std::abs(disturbed.vy - truth.vy) / 40, std::abs(disturbed.spin - truth.spin) / 100}) /
         kDisturbance;
}

template <class Real>
void bounce(Draw draw, int round) {
  BasicWorld<Real> world(without_sleep());
  Flyer truth;
  // Shapes keep it in float.
  const double e = draw.below(2) == 0 ? 1 : static_cast<double>(static_cast<float>(draw(0.2, 1)));
  const Form form = any_form(draw);
  world.create_body(
      {.type = BodyType::Static},
      {.geometry = Box{20, 2}, .position = {0, -1}, .material = {.friction = 0, .restitution = e}});
  truth.angle = draw(-3, 3), truth.spin = draw(-10, 10), truth.vy = -draw(2, 30);
  truth.corners = form.corners, truth.radius = form.radius, truth.restitution = e;
  // A body put into the world has no look ahead in its first step.
  truth.y = 0, truth.y = -truth.height(0) + draw(0.005, 0.5) - 2 * kStep * truth.vy;
  const BodyId body =
      world.create_body({.position = {0, truth.y},
                         .angle = truth.angle,
                         .velocity = {draw(-5, 5), truth.vy},
                         .angular_velocity = truth.spin},
                        {.geometry = form.geometry, .material = {.friction = 0, .restitution = e}});
  truth.mass = world.mass(body), truth.inertia = world.inertia(body);
  const bool exact = std::is_same_v<Real, double>;
  Flyer disturbed = truth;
  disturbed.y += kDisturbance, disturbed.angle += kDisturbance;
  for (int step = 0; step < 8; ++step) {
    const double before = truth.energy();
    truth.advance(kStep), disturbed.advance(kStep), world.step();
    // Slow ones do not bounce, corners that strike as good as at once are one impact, and from impact to
    // impact differences grow.
    if (truth.slowest < 0.7 || truth.closest < 1e-3 || truth.impacts > 3) return;
    if (disturbed.impacts != truth.impacts) return;  // one within the disturbance of the step's end
    // Roundings of positions and rates of a few steps, and what impacts make of them.
    const double allowed = (exact ? 4e-12 : 4e-5) * (1 + growth(truth, disturbed));
    ASSERT_NEAR(world.position(body).y, truth.y, allowed) << round << ", step " << step;
    ASSERT_NEAR(world.angle(body), truth.angle, 4 * allowed) << round << ", step " << step;
    ASSERT_NEAR(world.velocity(body).y, truth.vy, 40 * allowed) << round << ", step " << step;
    ASSERT_NEAR(world.angular_velocity(body), truth.spin, 100 * allowed) << round << ", step " << step;
    if (e == 1) {
      ASSERT_NEAR(truth.energy(), before, 1e-6 * before);
    }
  }
}

TEST(ImpactTimes, FollowTheFlightsOfCorners) {
  const int count = cases(1500);
  for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
    bounce<double>(Draw(static_cast<unsigned>(i + 1)), i);
    bounce<float>(Draw(static_cast<unsigned>(i + 1)), i);
  }
}

// A box that today's plane of contact would have thrown up with 1.4 times its energy.
template <class Real>
void bounce_off_a_corner(double allowed) {
  BasicWorld<Real> world;
  world.create_body({.type = BodyType::Static, .position = {0, -1}},
                    {.geometry = Box{400, 2}, .material = {.friction = 0, .restitution = 1}});
  const BodyId box = world.create_body(
      {.position = {0, 0.282923258},
       .angle = -0.0756134222,
       .velocity = {0, -7.24376583},
       .angular_velocity = -2.48019409},
      {.geometry = Box{1, 0.4}, .density = 1, .material = {.friction = 0, .restitution = 1}});
  const auto energy = [&] {
    const double spin = world.angular_velocity(box);
    return world.mass(box) * (0.5 * length_squared(world.velocity(box)) + kGravity * world.position(box).y) +
           0.5 * world.inertia(box) * spin * spin;
  };
  const double before = energy();
  run(world, 18);
  EXPECT_NEAR(world.position(box).y, 1.650, 5e-4);
  EXPECT_NEAR(energy(), before, allowed * before);
}

TEST(ImpactTimes, ABoxKeepsItsEnergyOffItsCorners) {
  bounce_off_a_corner<float>(1e-5);
  bounce_off_a_corner<double>(1e-12);
}

// Whatever meets, whatever it is made of: momentum is kept, and energy is never gained; it is all kept where
// nothing takes it.
template <class Real>
void collide(Draw draw, int round) {
  const WorldDefinition definition = draw.below(2) == 0 ? weightless() : without_sleep();
  BasicWorld<Real> world(definition);
  const double gravity = definition.gravity.y;
  const double e = draw.below(2) == 0 ? 1 : draw(0, 1);
  const double speed = std::exp(draw(std::log(2), std::log(1000)));
  const Material material{.friction = draw.below(2) == 0 ? 0 : draw(0, 2), .restitution = e};
  const auto add = [&](Vec2d at, Vec2d velocity, BodyType type) {
    const double spin = draw.below(3) == 0 ? 0 : draw(-50, 50);
    const Form form = any_form(draw);
    const double density = std::exp(draw(std::log(0.1), std::log(10)));
    const BodyId body =
        world.create_body({.type = type,
                           .position = at,
                           .angle = draw(-3, 3),
                           .velocity = velocity,
                           .angular_velocity = type == BodyType::Dynamic ? spin : 0},
                          {.geometry = form.geometry, .density = density, .material = material});
    if (draw.below(3) == 0)
      world.create_shape(body, {.geometry = Circle{draw(0.1, 0.4)},
                                .position = {draw(-0.6, 0.6), draw(-0.6, 0.6)},
                                .density = density,
                                .material = material});
    return body;
  };
  const int kind = draw.below(3);
  const BodyId a = add({-2.5, 0}, {0.5 * speed, 0}, BodyType::Dynamic);
  const BodyId b = add({2.5, draw(-0.8, 0.8)}, {kind == 0 ? -0.5 * speed : 0, 0},
                       kind == 0 ? BodyType::Dynamic : BodyType::Static);
  const auto energy = [&] {
    double sum = 0;
    for (const BodyId body : {a, b}) {
      if (world.type(body) != BodyType::Dynamic) continue;
      const double spin = world.angular_velocity(body);
      sum +=
          world.mass(body) * (0.5 * length_squared(world.velocity(body)) - gravity * world.centre(body).y) +
          0.5 * world.inertia(body) * spin * spin;
    }
    return sum;
  };
  const double rounding = std::is_same_v<Real, double> ? 1e-9 : 2e-5;
  const int steps = static_cast<int>(std::min(60.0, 6 / speed / kStep)) + 8;
  double last = energy();
  const double first = std::abs(last);
  for (int step = 0; step < steps; ++step) {
    world.step();
    const double now = energy();
    // Overlaps of what has come to rest dissolve: a thousandth of a metre of height.
    const double lifted = 1e-3 * world.mass(a) * -gravity;
    ASSERT_LE(now, last + rounding * first + lifted)
        << round << ", step " << step << ", " << speed << " m/s, e " << e;
    if (e == 1 && material.friction == 0 && gravity == 0) {
      ASSERT_NEAR(now, last, 0.01 * first) << round << ", step " << step << ", " << speed << " m/s";
    }
    last = now;
  }
}

TEST(ImpactTimes, NoImpactGainsEnergy) {
  const int count = cases(500);
  for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
    collide<double>(Draw(static_cast<unsigned>(i + 1)), i);
    collide<float>(Draw(static_cast<unsigned>(i + 1)), i);
  }
}

}  // namespace
}  // namespace plumb
