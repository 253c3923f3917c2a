#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "tests/world/support.h"

// A body that flies past something without touching it keeps its velocity to the last bit, however closely it
// passes.
namespace plumb {
namespace {

constexpr double kStep = 1.0 / 60;

int cases(int usual) {
  const char* text = std::getenv("PLUMB_PROPERTY_CASES");
  return usual * (text == nullptr ? 1 : std::max(1, std::atoi(text)));
}

// A rounded convex shape about its centre of mass, as the test measures it.
struct Outline {
  std::vector<Vec2d> corners;
  double radius = 0;
  ShapeGeometry geometry;
  double size = 0;  // m, about its width

  double extent() const {
    double most = 0;
    for (const Vec2d c : corners) most = std::max(most, std::sqrt(length_squared(c)));
    return most + radius;
  }
};

struct Mover {
  Outline outline;
  Vec2d position, velocity;
  double angle = 0, spin = 0;

  std::vector<Vec2d> corners_at(double t) const {
    const double c = std::cos(angle + spin * t), s = std::sin(angle + spin * t);
    std::vector<Vec2d> corners;
    for (const Vec2d p : outline.corners)
      corners.push_back(position + t * velocity + Vec2d{c * p.x - s * p.y, s * p.x + c * p.y});
    return corners;
  }
};

double distance_to_edge(Vec2d p, Vec2d a, Vec2d b) {
  const Vec2d way = b - a;
  const double length = length_squared(way);
  const double share = length > 0 ? std::clamp(dot(p - a, way) / length, 0.0, 1.0) : 0;
  return std::sqrt(length_squared(p - (a + share * way)));
}

bool contains(const std::vector<Vec2d>& hull, Vec2d p) {
  if (hull.size() < 3) return false;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2d a = hull[i], b = hull[(i + 1) % hull.size()];
    if (cross(b - a, p - a) < 0) return false;
  }
  return true;
}

// By brute force: hulls that are apart are nearest at a corner of one of them.
double distance_between(const std::vector<Vec2d>& a, const std::vector<Vec2d>& b) {
  double least = 1e9;
  const auto corners_of = [&](const std::vector<Vec2d>& from, const std::vector<Vec2d>& to) {
    for (const Vec2d p : from) {
      if (contains(to, p)) least = 0;
      for (std::size_t i = 0; i < to.size(); ++i)
        least = std::min(least, distance_to_edge(p, to[i], to[(i + 1) % to.size()]));
    }
  };
  corners_of(a, b), corners_of(b, a);
  return least;
}

// m, how near they come to each other within a time.
double nearest(const Mover& a, const Mover& b, double time, int samples) {
  double least = 1e9;
  for (int i = 0; i <= samples; ++i) {
    const double t = time * i / samples;
    least = std::min(least, distance_between(a.corners_at(t), b.corners_at(t)));
  }
  return least - a.outline.radius - b.outline.radius;
}

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double operator()(double a, double b) {
    return a + (b - a) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  Outline outline() {
    const double w = (*this)(0.3, 1.2), h = w * (*this)(0.3, 1);
    switch (random_() % 4) {
      case 0:
        return {{{-w / 2, -h / 2}, {w / 2, -h / 2}, {w / 2, h / 2}, {-w / 2, h / 2}}, 0, Box{w, h}, h};
      case 1:
        return {{{0, 0}}, w / 2, Circle{w / 2}, w};
      case 2:
        return {{{-w / 2, 0}, {w / 2, 0}}, h / 3, Capsule{{-w / 2, 0}, {w / 2, 0}, h / 3}, h};
      default: {
        std::vector<Vec2d> corners;
        for (int i = 0; i < 5; ++i) {
          const double a = 2 * 3.14159265358979 * i / 5;
          corners.push_back({w / 2 * std::cos(a), w / 2 * std::sin(a)});
        }
        return {corners, 0, Polygon{corners}, w};
      }
    }
  }

 private:
  std::mt19937_64 random_;
};

template <class Real>
BodyId add(BasicWorld<Real>& world, const Mover& mover, BodyType type, const Material& material) {
  return world.create_body({.type = type,
                            .position = mover.position,
                            .angle = mover.angle,
                            .velocity = mover.velocity,
                            .angular_velocity = mover.spin},
                           {.geometry = mover.outline.geometry, .material = material});
}

// A flight past a second body, one that stands or one that flies too, with so much room between them.
template <class Real>
void pass(Draw& draw, int round) {
  const double speed = std::exp(draw(0, std::log(100.0)));
  Mover a{draw.outline(), {}, {}, draw(-3, 3), draw(0, 1) < 0.5 ? 0 : draw(-10, 10)};
  Mover b{draw.outline(), {}, {}, draw(-3, 3), draw(0, 1) < 0.5 ? 0 : draw(-10, 10)};
  const int kind = static_cast<int>(draw(0, 3));
  const BodyType type = kind == 0 ? BodyType::Static : kind == 1 ? BodyType::Kinematic : BodyType::Dynamic;
  if (type == BodyType::Static) b.spin = 0;
  if (type != BodyType::Static) b.velocity = {draw(-0.5, 0.5) * speed, draw(-0.5, 0.5) * speed};
  const double way = draw(-3.14, 3.14);
  const Vec2d relative = speed * Vec2d{std::cos(way), std::sin(way)};
  a.velocity = b.velocity + relative;
  // They are nearest after about 3 to 4 steps.
  const double time = draw(3, 4) * kStep, total = 8 * kStep;
  const double size = std::min(a.outline.size, b.outline.size);
  const double wanted = size * std::exp(draw(std::log(0.01), std::log(0.2)));
  const Vec2d aside{-relative.y / speed, relative.x / speed};
  const double far = a.outline.extent() + b.outline.extent() + size;
  double low = 0, high = far;
  const auto room = [&](double offset) {
    a.position = offset * aside - time * relative;
    return nearest(a, b, total, 60 + static_cast<int>(20 * speed * total / size));
  };
  for (int i = 0; i < 18; ++i) {
    const double middle = (low + high) / 2;
    (room(middle) < wanted ? low : high) = middle;
  }
  const double open = room(high);
  if (nearest(a, b, 0, 0) < 0.3 * size || !(open > 0.0099 * size)) return;
  for (const double restitution : {0.0, 1.0}) {
    BasicWorld<Real> world(weightless());
    const Material material{.friction = 0.5, .restitution = restitution};
    const BodyId first = add(world, a, BodyType::Dynamic, material), second = add(world, b, type, material);
    const Vec2d va = world.velocity(first), vb = world.velocity(second);
    const double wa = world.angular_velocity(first), wb = world.angular_velocity(second);
    run(world, 8);
    EXPECT_EQ(world.velocity(first), va) << round << ": " << speed << " m/s, room " << open / size;
    EXPECT_EQ(world.angular_velocity(first), wa) << round;
    EXPECT_EQ(world.velocity(second), vb) << round;
    EXPECT_EQ(world.angular_velocity(second), wb) << round;
  }
}

TEST(NearMisses, DeflectNothing) {
  const int count = cases(120);
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    Draw draw(static_cast<unsigned>(i + 1));
    pass<float>(draw, i);
    Draw again(static_cast<unsigned>(i + 1));
    pass<double>(again, i);
  }
}

// A box of 0.9 m passes the corner of a box with 5 cm to spare, a disc with 2 cm, from everywhere in a step.
template <class Real>
void pass_a_corner(const ShapeGeometry& geometry, double height, double speed, int k) {
  BasicWorld<Real> world(weightless());
  world.create_body({.type = BodyType::Static, .position = {0, -0.5}}, {.geometry = Box{1, 1}});
  const BodyId body = world.create_body(
      {.position = {-3 - speed / 60 * k / 40, height}, .velocity = {speed, 0}}, {.geometry = geometry});
  run(world, static_cast<int>(60 * 6 / speed) + 10);
  EXPECT_EQ(world.velocity(body), (Vec2d{speed, 0})) << speed << ", " << k;
  EXPECT_EQ(world.angular_velocity(body), 0) << speed << ", " << k;
}

TEST(NearMisses, ABoxPassesACorner) {
  for (const double speed : {1.0, 5.0, 10.0, 20.0, 40.0, 100.0}) {
    for (int k = 0; k < 40; ++k) {
      pass_a_corner<float>(Box{0.9, 0.9}, 0.5, speed, k);
      pass_a_corner<double>(Box{0.9, 0.9}, 0.459, speed, k);
      pass_a_corner<float>(Circle{0.5}, 0.52, speed, k);
      pass_a_corner<double>(Circle{0.5}, 0.51, speed, k);
    }
  }
}

// A box flies over a bar that stands still on a hinge, 5 to 50 mm above its highest corner.
template <class Real>
void pass_a_hinged_bar(double angle, double speed, double room, double phase, double step,
                       Solver solver = Solver::SoftSteps) {
  BasicWorld<Real> world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
  const BodyId frame = world.create_body({.type = BodyType::Static});
  const BodyId bar = world.create_body({.angle = angle}, {.geometry = Box{1, 0.3}});
  world.create_joint(frame, bar, {.kind = RevoluteDefinition{}});
  const double top = 0.5 * std::abs(std::sin(angle)) + 0.15 * std::abs(std::cos(angle));
  const BodyId box =
      world.create_body({.position = {-2 - phase * speed * step, top + room + 0.15}, .velocity = {speed, 0}},
                        {.geometry = Box{0.5, 0.3}});
  run(world, static_cast<int>(4 / (speed * step)) + 2, step);
  EXPECT_EQ(world.velocity(box), (Vec2d{speed, 0}))
      << angle << ", " << speed << ", " << room << ", " << phase;
  EXPECT_EQ(world.angular_velocity(box), 0) << angle << ", " << speed << ", " << room << ", " << phase;
  EXPECT_EQ(world.angular_velocity(bar), 0) << angle << ", " << speed << ", " << room << ", " << phase;
}

TEST(NearMisses, ABoxPassesABarOnAHinge) {
  for (const Solver solver : {Solver::SoftSteps, Solver::SequentialImpulses, Solver::Direct})
    pass_a_hinged_bar<float>(0.85084801034723567, 10, 0.02, 0, kStep, solver);
  for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 480})
    for (const double speed : {1.0, 3.0, 10.0, 30.0})
      for (const double room : {0.005, 0.02, 0.05})
        for (int k = 0; k < 8; ++k) {
          const double angle = (k + 0.5) * 3.14159265358979 / 8;
          pass_a_hinged_bar<float>(angle, speed, room, k / 8.0, step);
          pass_a_hinged_bar<double>(angle, speed, room, (7 - k) / 8.0, step);
        }
}

// A body flies straight over a crate of 1 m that rests on the floor, and over one on top of another.
template <class Real>
void pass_a_resting_crate(const ShapeGeometry& geometry, int crates, double speed, double room, int k) {
  BasicWorld<Real> world({.sleeping = false});
  world.create_body({.type = BodyType::Static, .position = {0, -1}}, {.geometry = Box{60, 2}});
  for (int i = 0; i < crates; ++i)
    world.create_body({.position = {0, 0.5 + i}}, {.geometry = Box{1, 1}, .density = 100});
  run(world, 20);
  const BodyId body = world.create_body({.position = {-2 - k / 8.0 * speed * kStep, crates + room + 0.15},
                                         .velocity = {speed, 0},
                                         .gravity_scale = 0},
                                        {.geometry = geometry});
  run(world, static_cast<int>(4.5 / (speed * kStep)) + 1);
  EXPECT_EQ(world.velocity(body), (Vec2d{speed, 0})) << crates << ", " << speed << ", " << room << ", " << k;
  EXPECT_EQ(world.angular_velocity(body), 0) << crates << ", " << speed << ", " << room << ", " << k;
}

TEST(NearMisses, WhatFliesOverARestingCrateIsNotDeflected) {
  for (const int crates : {1, 2})
    for (const double speed : {3.0, 10.0, 30.0})
      for (int k = 0; k < 8; ++k) {
        pass_a_resting_crate<float>(Circle{0.15}, crates, speed, 0.02, k);
        pass_a_resting_crate<double>(Box{0.5, 0.3}, crates, speed, 0.02, k);
        pass_a_resting_crate<float>(Capsule{{-0.3, 0}, {0.3, 0}, 0.15}, crates, speed, 0.05, k);
      }
}

// Checks that what does meet the bar still does: in time, whatever the step and the phase. The box strikes
// its end flat, and without restitution both move on together: m u = m v + I w / r, v = r w at the arm r of
// the blow.
TEST(NearMisses, WhatMeetsABarOnAHingeStrikesIt) {
  for (const double speed : {1.0, 3.0, 10.0, 30.0, 100.0})
    for (int k = 0; k < 8; ++k) {
      World world({.gravity = {0, 0}, .sleeping = false});
      const BodyId frame = world.create_body({.type = BodyType::Static});
      const BodyId bar = world.create_body({}, {.geometry = Box{0.3, 1}, .material = {.friction = 0}});
      world.create_joint(frame, bar, {.kind = RevoluteDefinition{}});
      const BodyId ball =
          world.create_body({.position = {-1 - k / 8.0 * speed * kStep, 0.45}, .velocity = {speed, 0}},
                            {.geometry = Circle{0.1}, .material = {.friction = 0}});
      const double mass = world.mass(ball), arm = 0.45;
      const double after = speed * mass / (mass + world.inertia(bar) / (arm * arm));
      const double meets = (0.75 + k / 8.0 * speed * kStep) / speed;
      while (world.time() + kStep < meets - 2 * kStep) world.step(kStep);
      EXPECT_EQ(world.velocity(ball).x, speed);
      while (world.time() < meets + kStep) world.step(kStep);
      EXPECT_NEAR(world.velocity(ball).x, after, 0.1 * speed) << speed << ", " << k;
      EXPECT_NEAR(world.angular_velocity(bar), -after / arm, 0.15 * speed / arm) << speed << ", " << k;
    }
}

// Two gears coast inside their backlash at the speeds of their ratio: the teeth pass in and out of the gaps
// and never touch.
TEST(NearMisses, GearsThatCoastKeepTheirEnergy) {
  constexpr double kPi = 3.14159265358979323846, kDistance = 1.55;
  for (const double spin : {3.0, 7.0, 12.0, 20.0}) {
    World world({.gravity = {0, 0}});
    const BodyId frame = world.create_body({.type = BodyType::Static});
    const auto gear = [&](double x, int teeth, double radius, double phase) {
      const BodyId body = world.create_body({.position = {x, 0}});
      world.create_shape(body, {.geometry = Circle{radius * 0.8}, .material = {.friction = 0}});
      for (int i = 0; i < teeth; ++i) {
        const double angle = phase + i * 2 * kPi / teeth, width = kPi * radius / teeth;
        const double c = std::cos(angle), s = std::sin(angle);
        std::vector<Vec2d> tooth{{radius * 0.75, -0.52 * width},
                                 {radius * 0.75, 0.52 * width},
                                 {radius + 0.12, 0.25 * width},
                                 {radius + 0.12, -0.25 * width}};
        for (Vec2d& p : tooth) p = {p.x * c - p.y * s, p.x * s + p.y * c};
        world.create_shape(body, {.geometry = Polygon{tooth}, .material = {.friction = 0}});
      }
      world.create_joint(frame, body, {.kind = RevoluteDefinition{.anchor_a = {x, 0}}});
      return body;
    };
    const BodyId large = gear(0, 16, 1, 0), small = gear(kDistance, 8, 0.5, kPi + kPi / 8);
    world.set_angular_velocity(large, spin), world.set_angular_velocity(small, -2 * spin);
    run(world, 300);
    EXPECT_NEAR(world.angular_velocity(large), spin, 1e-4 * spin);
    EXPECT_NEAR(world.angular_velocity(small), -2 * spin, 2e-4 * spin);
  }
}

}  // namespace
}  // namespace plumb
