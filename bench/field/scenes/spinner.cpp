// A ring of 360 segments, radius 40 m, friction 0.1. In it a paddle of 0.8 x 40 m, rounded by 0.2 m, turns at
// 5 rad/s by a motor without a limit. 6076 bodies in turn: capsule (axis 0.5 m, radius 0.25 m), disc (0.35
// m), square (0.7 m); density 0.25 kg/m^2, friction and restitution 0.1. They start 0.5 m apart, so they
// overlap at first. 6078 bodies, 1 joint. Without continuous collision, because that alone costs Box2D 2.4
// more time than the rest.
#include <cmath>
#include <limits>
#include <numbers>

#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

constexpr Vec2d kCentre{0, 32};
constexpr double kRadius = 40;

int add_ring(Builder& world) {
  const int n = 360;
  const auto point = [](int i) {
    const double angle = 2 * std::numbers::pi * i / n;
    return kCentre + kRadius * Vec2d{std::cos(angle), std::sin(angle)};
  };
  std::vector<ShapeDefinition> ring;
  for (int i = 0; i < n; ++i)
    ring.push_back({.geometry = Segment{point(i), point((i + 1) % n)}, .friction = 0.1});
  return world.create_body({.type = BodyType::Static}, ring);
}

Built build(Builder& world, bool quick) {
  const int ring = add_ring(world);
  const Vec2d hub{0, 12};
  const ShapeDefinition paddle{.geometry = box(0.4, 20, {}, 0.2), .friction = 0};
  const int spinner = world.create_body({.position = hub}, paddle);
  world.create_revolute(
      ring, spinner,
      {.anchor_a = hub, .motor = Motor{.speed = 5, .max_torque = std::numeric_limits<float>::max()}});

  const std::vector<Geometry> kinds{Capsule{{-0.25, 0}, {0.25, 0}, 0.25}, Circle{{}, 0.35}, box(0.35, 0.35)};
  const int count = quick ? 300 : 6076, in_a_row = 92;
  const double pitch = 0.5;
  for (int i = 0; i < count; ++i) {
    const Vec2d position{-23 + pitch * (i % in_a_row), 2 + pitch * (i / in_a_row)};
    const ShapeDefinition shape{
        .geometry = kinds[i % 3], .density = 0.25, .friction = 0.1, .restitution = 0.1};
    world.create_body({.position = position}, shape);
  }
  const Vec2d reach{kRadius + 1, kRadius + 1};
  return {.region = Region{kCentre - reach, kCentre + reach}};
}

}  // namespace

Scene spinner() {
  return {.name = "spinner",
          .summary = "a motor's paddle stirs 6076 capsules, discs and squares in a ring",
          .steps = 500,
          .quick_steps = 60,
          .continuous = false,
          .build = build};
}

}  // namespace plumb::field
