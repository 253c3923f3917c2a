#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "engine/world/world.h"

/// Random encounters of bodies with things that they must not pass: drawn by number, the same each time.
namespace plumb::passages {

class Draw {
 public:
  explicit Draw(std::uint64_t number) : random_(number * 0x9E3779B97F4A7C15u + 1) { random_.discard(4); }
  double even(double from, double to) {
    return from + (to - from) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  /// As likely in each decade.
  double spread(double from, double to) { return std::exp(even(std::log(from), std::log(to))); }
  int choose(int count) { return static_cast<int>(random_() % static_cast<std::uint64_t>(count)); }
  bool chance(double share) { return even(0, 1) < share; }
  Vec2d direction() {
    const double angle = even(0, 2 * std::numbers::pi);
    return {std::cos(angle), std::sin(angle)};
  }
  double sign() { return chance(0.5) ? 1 : -1; }

 private:
  std::mt19937_64 random_;
};

inline constexpr double kSteps[] = {1.0 / 30, 1.0 / 60, 1.0 / 60, 1.0 / 120, 1.0 / 240};

/// A body of the given length across, of any kind.
inline std::vector<ShapeDefinition> any_shapes(Draw& draw, double length) {
  const Material material{.friction = draw.even(0, 1), .restitution = draw.chance(0.3) ? draw.even(0, 1) : 0};
  const double thickness = length * draw.spread(0.03, 0.5);
  const auto with = [&](ShapeGeometry geometry, Vec2d position = {}, double angle = 0) {
    return ShapeDefinition{.geometry = geometry, .position = position, .angle = angle, .material = material};
  };
  const auto rod = [&] { return with(Box{length, thickness}); };
  const auto capsule = [&] { return with(Capsule{{-length / 2, 0}, {length / 2, 0}, thickness / 2}); };
  switch (draw.choose(8)) {
    case 0:
      return {rod()};
    case 1:
      return {
          with(Polygon{{{-length / 2, -thickness / 2}, {length / 2, -thickness / 2}, {0, thickness / 2}}})};
    case 2:
      return {with(Polygon{{{-length / 2, -thickness / 2},
                            {length / 2, -thickness / 2 * draw.even(0, 1)},
                            {-length / 2, thickness / 2}}})};
    case 3:
      return {capsule()};
    case 4:
      return {with(Box{length, length * draw.even(0.5, 1)})};
    case 5:
      return {with(Circle{length / 2})};
    case 6:  // a T
      return {rod(), with(Box{length / 2, thickness}, {0, length / 4}, std::numbers::pi / 2)};
    default:  // a dumbbell
      return {with(Circle{length / 5}, {-length / 2, 0}), rod(), with(Circle{length / 6}, {length / 2, 0})};
  }
}

/// The middle of a shape, in the frame of its body.
inline Vec2d middle_of(const ShapeDefinition& shape) {
  Vec2d middle = shape.position;
  if (const auto* polygon = std::get_if<Polygon>(&shape.geometry)) {
    Vec2d sum{};
    for (const Vec2d corner : polygon->points) sum += corner;
    middle += 1.0 / static_cast<double>(polygon->points.size()) * sum;
  }
  return middle;
}

struct Passenger {
  BodyId body{};
  std::vector<Vec2d> middles;  ///< of its shapes, in its frame
};

template <class Real>
Vec2d placed(const BasicWorld<Real>& world, BodyId body, Vec2d local) {
  const double angle = world.angle(body), c = std::cos(angle), s = std::sin(angle);
  const Vec2d origin = world.position(body);
  return {origin.x + c * local.x - s * local.y, origin.y + s * local.x + c * local.y};
}
template <class Real>
Vec2d seen_from(const BasicWorld<Real>& world, BodyId body, Vec2d point) {
  const double angle = world.angle(body), c = std::cos(angle), s = std::sin(angle);
  const Vec2d d = point - world.position(body);
  return {c * d.x + s * d.y, c * d.y - s * d.x};
}

template <class Real>
Passenger add_passenger(BasicWorld<Real>& world, Draw& draw, double length, Vec2d place, double speed,
                        double spin, int group) {
  std::vector<ShapeDefinition> shapes = any_shapes(draw, length);
  Passenger passenger;
  for (ShapeDefinition& shape : shapes) {
    shape.density = 1000;
    shape.filter.group = group;
    passenger.middles.push_back(middle_of(shape));
  }
  passenger.body = world.create_body({.position = place,
                                      .angle = draw.even(-3, 3),
                                      .velocity = speed * draw.direction(),
                                      .angular_velocity = spin * draw.sign()},
                                     shapes);
  return passenger;
}

enum class Walls { Boxes, Segments, Capsules, Chain };

/// Describes an encounter, and what went wrong.
struct Outcome {
  std::string what;
  std::string fault;  ///< empty: nothing
};

/// A closed room of 4 m, static, moved as it is told or flying itself, and bodies that are thrown about in
/// it: none of their shapes gets out. `plain`: it stands, and no joints tie its bodies.
template <class Real>
Outcome closed_room(std::uint64_t number, bool plain) {
  Draw draw(number);
  BasicWorld<Real> world({.gravity = {0, draw.chance(0.5) ? -9.81 : 0}});
  const double dt = kSteps[draw.choose(5)], half = 2;
  const double thickness = draw.spread(0.001, 0.1);
  const Walls walls = static_cast<Walls>(draw.choose(4));
  const int mover = draw.choose(plain ? 3 : 5);  // 3: kinematic, 4: dynamic
  BodyDefinition room{.type = mover == 3   ? BodyType::Kinematic
                              : mover == 4 ? BodyType::Dynamic
                                           : BodyType::Static};
  const bool moves = mover >= 3;
  if (moves) room.velocity = draw.spread(1, 100) * draw.direction();
  if (moves) room.angular_velocity = draw.even(-4, 4);
  if (mover == 4) room.mass = MassProperties{1e5, {}, 4e5};
  const Material material{.friction = draw.even(0, 1), .restitution = draw.chance(0.2) ? draw.even(0, 1) : 0};
  const Vec2d corners[] = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  const BodyId shell = [&] {
    if (walls == Walls::Chain) {
      const BodyId body = world.create_body(room);
      // The front of a chain is on the right of its way.
      world.create_chain(
          body,
          {.points = {corners[3], corners[2], corners[1], corners[0]}, .closed = true, .material = material});
      return body;
    }
    std::vector<ShapeDefinition> shapes;
    for (int i = 0; i < 4; ++i) {
      const Vec2d from = corners[i], to = corners[(i + 1) % 4], middle = 0.5 * (from + to);
      const double out = walls == Walls::Boxes ? 1 + thickness / 2 / half : 1;
      ShapeDefinition wall{.density = 1, .material = material};
      if (walls == Walls::Boxes) {
        wall.geometry = Box{2 * (half + thickness), thickness};
        wall.angle = i * std::numbers::pi / 2;
        wall.position = out * middle;
      } else if (walls == Walls::Segments) {
        wall.geometry = Segment{from, to};
      } else {
        wall.geometry = Capsule{from, to, thickness / 2};
      }
      shapes.push_back(wall);
    }
    return world.create_body(room, shapes);
  }();
  const int count = 1 + draw.choose(8), group = draw.chance(0.4) ? -1 : 0;
  const double fastest = draw.spread(1, 2000), most_spin = draw.spread(1, 500);
  std::vector<Passenger> passengers;
  for (int i = 0; i < count; ++i) {
    const double length = draw.spread(0.05, 1);
    const Vec2d place{draw.even(-half, half) * 0.6, draw.even(-half, half) * 0.6};
    passengers.push_back(
        add_passenger(world, draw, length, place, draw.even(0, fastest), draw.even(0, most_spin), group));
  }
  int joints = 0;
  if (!plain && draw.chance(0.35)) {
    for (int i = 0; i + 1 < count && joints < 4; i += 1 + draw.choose(2)) {
      const BodyId a = passengers[i].body, b = passengers[i + 1].body;
      const Vec2d between = seen_from(world, a, world.position(b));
      // They start as the joint lets them.
      world.set_velocity(b, world.velocity(a));
      world.set_angular_velocity(a, 0), world.set_angular_velocity(b, 0);
      switch (draw.choose(3)) {
        case 0:
          world.create_joint(a, b, {.kind = RevoluteDefinition{.anchor_a = between}});
          break;
        case 1:
          world.create_joint(
              a, b, {.kind = DistanceDefinition{.length = std::max(0.01, std::hypot(between.x, between.y))}});
          break;
        default:
          world.create_joint(a, b,
                             {.kind = WeldDefinition{.anchor_a = between,
                                                     .reference_angle = world.angle(b) - world.angle(a)}});
      }
      ++joints;
    }
  }
  std::ostringstream what;
  what << "room " << number << ": walls " << static_cast<int>(walls) << " of " << thickness << " m, mover "
       << mover << ", dt 1/" << std::lround(1 / dt) << ", " << count << " bodies to " << fastest << " m/s, "
       << most_spin << " rad/s, group " << group << ", " << joints << " joints";
  Outcome outcome{what.str(), {}};
  const double outside = half + (walls == Walls::Boxes ? thickness : thickness / 2) + 0.001;
  for (int step = 1; step <= 90; ++step) {
    world.step(dt);
    for (int i = 0; i < count; ++i) {
      for (const Vec2d middle : passengers[i].middles) {
        const Vec2d at = seen_from(world, shell, placed(world, passengers[i].body, middle));
        if (std::max(std::abs(at.x), std::abs(at.y)) <= outside) continue;
        std::ostringstream fault;
        fault << "step " << step << ": body " << i << " is at " << at.x << ", " << at.y;
        outcome.fault = fault.str();
        return outcome;
      }
    }
  }
  return outcome;
}

/// A body that turns about a hinge, and a pin in its way: it stays on its side.
template <class Real>
Outcome hinged(std::uint64_t number) {
  Draw draw(number);
  BasicWorld<Real> world({.gravity = {0, 0}});
  // By a quarter of a turn in a step: what touches something is held by sweeps, which do not follow more.
  const double dt = kSteps[draw.choose(5)], length = draw.spread(0.05, 4), rate = draw.spread(1, 1.4 / dt);
  const double thickness = length * draw.spread(0.01, 0.3), size = draw.spread(0.001, 0.1);
  const bool centred = draw.chance(0.4);
  // About its middle it sweeps half of its length.
  const double shift = centred ? 0 : length / 2;
  // The very tip of a point may get past: half of the blade's width.
  const double reach = (centred ? 0.5 : 1) * length, arm = reach * draw.even(0.25, 0.93) - thickness / 2;
  const int kind = draw.choose(5);
  std::vector<ShapeDefinition> shapes;
  switch (kind) {
    case 0:
      shapes = {{.geometry = Box{length, thickness}, .position = {shift, 0}}};
      break;
    case 1:
      shapes = {{.geometry = Capsule{{-length / 2 + shift, 0}, {length / 2 + shift, 0}, thickness / 2}}};
      break;
    case 2:  // a blade that comes to a point
      shapes = {{.geometry = Polygon{{{-length / 2 + shift, -thickness / 2},
                                      {length / 2 + shift, 0},
                                      {-length / 2 + shift, thickness / 2}}}}};
      break;
    case 3:
      shapes = {{.geometry = Box{length / 2, thickness}, .position = {shift - length / 4, 0}},
                {.geometry = Box{length / 2, thickness / 2}, .position = {shift + length / 4, 0}}};
      break;
    default:
      shapes = {{.geometry = Box{length, thickness}, .position = {shift, 0}},
                {.geometry = Circle{thickness}, .position = {shift + length / 2, 0}}};
  }
  const double start = -draw.even(0.4, 3);
  const BodyId hub = world.create_body({.type = BodyType::Static});
  const BodyId rod = world.create_body({.angle = start, .angular_velocity = rate}, shapes);
  RevoluteDefinition hinge;
  if (draw.chance(0.5)) hinge.motor = Motor{rate, draw.spread(0.1, 100)};
  world.create_joint(hub, rod, {.kind = hinge});
  const int pin = draw.choose(4);
  ShapeDefinition obstacle;
  if (pin == 0) obstacle.geometry = Circle{size / 2};
  if (pin == 1) obstacle.geometry = Box{size, size};
  if (pin == 2) obstacle.geometry = Segment{{-size, 0}, {size, 0}};
  if (pin == 3) obstacle.geometry = Capsule{{-size, 0}, {size, 0}, size / 2};
  const bool clear = std::atan2(thickness + 3 * size, arm) < 0.35;  // at the start
  std::ostringstream what;
  what << "hinged " << number << ": kind " << kind << " of " << length << " x " << thickness << " m at "
       << rate << " rad/s, centred " << centred << ", pin " << pin << " of " << size << " at " << arm
       << ", dt 1/" << std::lround(1 / dt) << ", motor " << hinge.motor.has_value();
  Outcome outcome{what.str(), {}};
  if (!clear) return outcome;
  world.create_body({.type = BodyType::Static, .position = {arm, 0}}, obstacle);
  for (int step = 1; step <= 120; ++step) {
    world.step(dt);
    const double angle = world.angle(rod);
    // A body that turns about its middle has a second arm, half a turn behind.
    const double back = centred ? std::numbers::pi : 2 * std::numbers::pi;
    const Vec2d seen = seen_from(world, rod, {arm, 0});
    const bool beyond = std::abs(angle) < 0.3 && seen.y < 0 && std::abs(seen.x - shift) < length / 2;
    if (angle < 0.3 && angle > -back && !beyond) continue;
    std::ostringstream fault;
    fault << "step " << step << ": the rod is at " << angle << " rad";
    outcome.fault = fault.str();
    return outcome;
  }
  return outcome;
}

/// A shaft with a plate that slides along it, and bodies above: plate and bodies fly at each other. None of
/// them gets below the plate, which reaches into the sides so that there is no gap, and none leaves the
/// shaft.
template <class Real>
Outcome plate(std::uint64_t number) {
  Draw draw(number);
  BasicWorld<Real> world({.gravity = {0, 0}});
  const double dt = kSteps[draw.choose(5)], half = 1, thickness = draw.spread(0.002, 0.2);
  const bool kinematic = draw.chance(0.3);
  constexpr unsigned kSide = 2;  // the category of the shaft's sides
  for (int side = 0; side < 4; ++side) {
    const double sign = side < 2 ? -1 : 1;
    const bool flat = side % 2 == 0;
    world.create_body(
        {.type = BodyType::Static, .position = flat ? Vec2d{0, sign * 5.5} : Vec2d{sign * (half + 0.5), 0}},
        {.geometry = flat ? Box{4, 1} : Box{1, 12}, .filter = {.category = flat ? 1u : kSide}});
  }
  const double speed = draw.spread(1, 1000);
  const double own = kinematic ? draw.spread(0.5, 60) : draw.spread(0.5, 500);
  const ShapeGeometry form =
      draw.chance(0.5)
          ? ShapeGeometry{Box{2.4 * half, thickness}}
          : ShapeGeometry{Capsule{{-1.2 * half, 0}, {1.2 * half, 0}, std::min(thickness / 2, 0.03)}};
  const BodyId board = world.create_body(
      {.type = kinematic ? BodyType::Kinematic : BodyType::Dynamic,
       .position = {0, -2},
       .velocity = {0, own},
       .lock_x = true,
       .lock_rotation = true},
      {.geometry = form, .density = 1000 * draw.spread(0.1, 100), .filter = {.mask = ~std::uint64_t{kSide}}});
  const int count = 1 + draw.choose(3), group = draw.chance(0.5) ? -1 : 0;
  std::vector<Passenger> passengers;
  for (int i = 0; i < count; ++i) {
    passengers.push_back(add_passenger(world, draw, draw.spread(0.15, 0.6),
                                       {draw.even(-0.5, 0.5), draw.even(0, 3)}, 0, draw.even(0, 100), group));
    world.set_velocity(passengers.back().body, {draw.even(-0.3, 0.3) * speed, -speed});
  }
  std::ostringstream what;
  what << "plate " << number << ": " << thickness << " m, kinematic " << kinematic << " at " << own
       << " m/s, " << count << " bodies at " << speed << " m/s, group " << group << ", dt 1/"
       << std::lround(1 / dt);
  Outcome outcome{what.str(), {}};
  for (int step = 1; step <= 60; ++step) {
    // Between a piston and the lid there is no room left.
    if (kinematic && world.position(board).y + own * dt > 2.5) break;
    world.step(dt);
    for (int i = 0; i < count; ++i) {
      for (const Vec2d middle : passengers[i].middles) {
        const Vec2d at = placed(world, passengers[i].body, middle), on = seen_from(world, board, at);
        const bool below = on.y < -thickness / 2 && std::abs(on.x) < half;
        if (std::abs(at.x) <= half && at.y <= 5 && at.y >= -5 && !below) continue;
        std::ostringstream fault;
        fault << "step " << step << ": body " << i << " is at " << at.x << ", " << at.y
              << ", above the plate " << on.y;
        outcome.fault = fault.str();
        return outcome;
      }
    }
  }
  return outcome;
}

}  // namespace plumb::passages
