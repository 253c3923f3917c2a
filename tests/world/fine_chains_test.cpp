#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "engine/world/world.h"

namespace plumb {
namespace {

constexpr double kGravity = 9.81, kPi = 3.14159265358979323846;

// A body with rounded corners: the points of its core, and the radius around them.
struct Mover {
  const char* name;
  std::vector<Vec2d> core;
  double radius;
  ShapeGeometry geometry;
};

std::vector<Mover> movers(double r) {
  const std::vector<Vec2d> box{
      {-0.6 * r, -0.4 * r}, {0.6 * r, -0.4 * r}, {0.6 * r, 0.4 * r}, {-0.6 * r, 0.4 * r}};
  return {{"disc", {{0, 0}}, r, Circle{r}},
          {"capsule", {{-r, 0}, {r, 0}}, r / 2, Capsule{{-r, 0}, {r, 0}, r / 2}},
          {"rounded box", box, 0.2 * r, Polygon{box, 0.2 * r}}};
}

// A closed chain of n segments around a circle.
std::vector<Vec2d> circle(int n, double radius, double sense) {
  std::vector<Vec2d> points;
  for (int i = 0; i < n; ++i) {
    const double angle = sense * 2 * kPi * i / n;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return points;
}

// Returns how far a point, enlarged by a radius, lies beyond a bowl's polygon, m.
double depth_in_bowl(Vec2d at, double radius, int n, double bowl) {
  const double edges = std::atan2(at.y, at.x) * n / (2 * kPi);
  const double from_middle = (edges - std::floor(edges) - 0.5) * 2 * kPi / n;
  return std::hypot(at.x, at.y) * std::cos(from_middle) + radius - bowl * std::cos(kPi / n);
}

// The largest energy, as a fraction of that at the release, that at the end, and the largest depth, m.
struct Swing {
  double most = 0, last = 0, depth = 0;
};

// Lets a body slide or roll in a bowl of n segments, released at 0.5 rad.
template <class SomeWorld>
Swing swing(const Mover& mover, int n, double bowl, double friction, int substeps, double seconds) {
  constexpr double kRelease = 0.5, kStep = 1.0 / 60;
  SomeWorld w({.sleeping = false});
  const BodyId ground = w.create_body({.type = BodyType::Static});
  w.create_chain(ground, {.points = circle(n, bowl, -1), .closed = true, .material = {.friction = friction}});
  const Vec2d corner = mover.core.front();  // the lowest, and the farthest
  const double reach = bowl * std::cos(kPi / n) - mover.radius;
  const double below = std::sqrt(reach * reach - corner.x * corner.x) + corner.y;
  const BodyId body = w.create_body(
      {.position = {below * std::sin(kRelease), -below * std::cos(kRelease)}, .angle = kRelease},
      ShapeDefinition{.geometry = mover.geometry, .material = {.friction = friction}});
  const double mass = w.mass(body), inertia = w.inertia(body),
               released = mass * kGravity * below * (1 - std::cos(kRelease));
  Swing result;
  for (int i = 0; i < static_cast<int>(seconds / kStep); ++i) {
    w.step(kStep, substeps);
    const Vec2d x = w.position(body), v = w.velocity(body);
    const double spin = w.angular_velocity(body), angle = w.angle(body);
    result.last = (0.5 * mass * (v.x * v.x + v.y * v.y) + 0.5 * inertia * spin * spin +
                   mass * kGravity * (x.y + below)) /
                  released;
    result.most = std::max(result.most, result.last);
    for (const Vec2d p : mover.core) {
      const Vec2d at{x.x + std::cos(angle) * p.x - std::sin(angle) * p.y,
                     x.y + std::sin(angle) * p.x + std::cos(angle) * p.y};
      result.depth = std::max(result.depth, depth_in_bowl(at, mover.radius, n, bowl));
    }
  }
  return result;
}

template <class SomeWorld>
class FineChains : public testing::Test {};
using Worlds = testing::Types<World, BasicWorld<double>>;
TYPED_TEST_SUITE(FineChains, Worlds);

// Without restitution no motion gains energy, and nothing sinks into a surface. Before segments ahead were
// searched, a disc gained 50 % in 10 s, and sank by up to half its radius.
TYPED_TEST(FineChains, BodiesInABowlNeitherGainEnergyNorSink) {
  for (const Mover& mover : movers(0.05))
    for (const double friction : {0.0, 0.5})
      for (const int n : {100, 400, 800, 1600})
        for (const int substeps : {4, 16}) {
          SCOPED_TRACE(std::string(mover.name) + ", " + std::to_string(n) + " segments, friction " +
                       std::to_string(friction) + ", " + std::to_string(substeps) + " substeps");
          const Swing result = swing<TypeParam>(mover, n, 1, friction, substeps, 5);
          EXPECT_LT(result.most, 1.01);
          EXPECT_LT(result.depth, 0.01 * 0.05);
        }
}

// With one substep, the planes that hold a body are those of one instant: it may sink deeper, but gains
// nothing either.
TYPED_TEST(FineChains, BodiesInABowlGainNoEnergyWithOneSubstep) {
  for (const Mover& mover : movers(0.05))
    for (const double friction : {0.0, 0.5})
      for (const int n : {100, 400, 1600}) {
        SCOPED_TRACE(std::string(mover.name) + ", " + std::to_string(n) + " segments");
        const Swing result = swing<TypeParam>(mover, n, 1, friction, 1, 5);
        EXPECT_LT(result.most, 1.01);
      }
}

// Each of n corners takes the fraction sin^2(2 pi / n) of the energy, which vanishes with n. What a step
// takes more, because a substep's load has the normal at its end, stays below a third in 5 s.
TYPED_TEST(FineChains, DiscKeepsMostOfItsEnergyInAFineBowl) {
  const Swing result = swing<TypeParam>(movers(0.05)[0], 1600, 1, 0, 4, 5);
  EXPECT_GT(result.last, 0.7);
}

// A disc that rolls off a hump touches it until the normal force vanishes, and sinks nowhere. With friction
// it fell freely for single steps, by g dt^2 / 2 = 1.4 mm.
TYPED_TEST(FineChains, DiscRollsOverAHumpWithoutSinking) {
  constexpr double kRadius = 0.05, kHump = 1, kStep = 1.0 / 60;
  for (const int n : {400, 800, 1600}) {
    SCOPED_TRACE(n);
    TypeParam w({.sleeping = false});
    const BodyId ground = w.create_body({.type = BodyType::Static});
    w.create_chain(ground, {.points = circle(n, kHump, 1), .closed = true, .material = {.friction = 0.5}});
    const double speed = 0.02 * std::sqrt(kGravity * kHump);
    const BodyId body = w.create_body(
        {.position = {0, kHump + kRadius}, .velocity = {speed, 0}, .angular_velocity = -speed / kRadius},
        ShapeDefinition{.geometry = Circle{kRadius}, .material = {.friction = 0.5}});
    double depth = 0;
    for (int i = 0; i < 300 && w.position(body).y > 0; ++i) {
      w.step(kStep);
      const Vec2d x = w.position(body);
      // The polygon lies within the circle, by no more than its sagitta.
      depth = std::max(depth, kHump * std::cos(kPi / n) + kRadius - std::hypot(x.x, x.y));
    }
    EXPECT_LT(depth, 0.01 * kRadius);
  }
}

// An elastic disc that falls onto a flat chain of short segments returns to its height.
TYPED_TEST(FineChains, ElasticDiscReturnsToItsHeight) {
  TypeParam w({.sleeping = false});
  const BodyId ground = w.create_body({.type = BodyType::Static});
  std::vector<Vec2d> points;
  for (int i = 0; i <= 1000; ++i) points.push_back({2 - 0.004 * i, 0});
  w.create_chain(ground, {.points = points, .material = {.friction = 0, .restitution = 1}});
  const BodyId body = w.create_body(
      {.position = {0, 0.55}}, ShapeDefinition{.geometry = Circle{0.05}, .material = {.restitution = 1}});
  double highest = 0;
  for (int i = 0; i < 120; ++i) {
    w.step();
    if (i > 30) highest = std::max(highest, w.position(body).y);
  }
  EXPECT_NEAR(highest, 0.55, 0.01);
}

}  // namespace
}  // namespace plumb
