// Judges the loads of wind on a scene's bodies, integrated here over their outlines.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "engine/world/force_laws.h"
#include "harness/hunt/outline.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/random.h"
#include "harness/hunt/subject.h"

namespace plumb::harness::hunt {
namespace {

constexpr int kBodies = 3;    // number of bodies in a scene
constexpr int kPieces = 400;  // number of straight pieces that approximate an arc
// Tolerance, as a fraction of the load: the body rotates in the wind during the step, and the engine limits
// the load's effect.
constexpr double kShare = 0.01;
constexpr double kRounding = 2e-6;  // relative tolerance of the velocities of a World in float

struct Load {
  Vec2d force{};
  double torque = 0;
};

/// Adds the pressure of a wind `flow` relative to a piece of the surface.
void press(Load& load, Vec2d flow, Vec2d normal, double size, Vec2d at, double density) {
  const double into = -dot(flow, normal);
  if (into <= 0) return;
  const Vec2d force = (-0.5 * density * into * into * size) * normal;
  load.force += force;
  load.torque += cross(at, force);
}

/// Returns the load on an outline about the origin, which moves at `velocity` and rotates at `spin`. The wind
/// on an edge is evaluated at its middle, on an arc at its centre.
Load load_of(const Outline& outline, const Wind& wind, Vec2d velocity, double spin) {
  Load out;
  const auto flow_at = [&](Vec2d at) { return wind.velocity - velocity - spin * Vec2d{-at.y, at.x}; };
  const std::vector<Vec2d>& core = outline.core;
  const std::size_t count = core.size();
  std::vector<double> angles;  // angles of the edges' normals
  for (std::size_t i = 0; i < count && count > 1; ++i) {
    const Vec2d along = core[(i + 1) % count] - core[i];
    const double size = length(along);
    const Vec2d normal{along.y / size, -along.x / size};
    angles.push_back(std::atan2(normal.y, normal.x));
    const Vec2d middle = 0.5 * (core[i] + core[(i + 1) % count]) + outline.radius * normal;
    press(out, flow_at(middle), normal, size, middle, wind.density);
  }
  for (std::size_t i = 0; i < count && outline.radius > 0; ++i) {
    const double from = count > 1 ? angles[(i + count - 1) % count] : 0;
    double turn = count > 1 ? angles[i] - from : 2 * M_PI;
    while (turn < 0) turn += 2 * M_PI;
    for (int k = 0; k < kPieces; ++k) {
      const double angle = from + turn * (k + 0.5) / kPieces;
      press(out, flow_at(core[i]), {std::cos(angle), std::sin(angle)}, outline.radius * turn / kPieces,
            core[i], wind.density);
    }
  }
  return out;
}

template <class Real>
std::string blown(const Body& body, Random& random) {
  const double dt = 1e-3, angle = random.within(-3, 3);
  std::vector<ShapeDefinition> shapes;
  double reach = 0;
  std::vector<Outline> outlines;
  for (const Shape& shape : body.shapes) {
    ShapeDefinition definition{.position = shape.position, .angle = shape.angle};
    bool fits = true;
    std::visit(
        [&](const auto& geometry) {
          if constexpr (std::is_same_v<std::decay_t<decltype(geometry)>, Chain>)
            fits = false;
          else
            definition.geometry = geometry;
        },
        shape.geometry);
    if (!fits) return {};
    shapes.push_back(definition);
    outlines.push_back(placed(outlines_of(shape).front(), {.angle = angle}));
    reach = std::max(reach, reach_of(outlines.back()));
  }
  if (shapes.empty() || !(reach > 0)) return {};
  const Wind wind{{random.within(-10, 10) * reach, random.within(-10, 10) * reach}, 1.2};
  const Vec2d velocity{random.within(-5, 5) * reach, random.within(-5, 5) * reach};
  const double spin = random.pick({0.0, 1.0, 1.0}) * random.within(-10, 10);
  Load right;
  for (const Outline& outline : outlines) {
    const Load part = load_of(outline, wind, velocity, spin);
    right.force += part.force, right.torque += part.torque;
  }
  // Mass for which a step changes the velocity by a hundredth.
  const double fastest = length(wind.velocity - velocity) + reach * std::abs(spin);
  const double mass = 100 * dt * wind.density * fastest * reach + 1e-3, inertia = mass * reach * reach;
  BasicWorld<Real> world({.gravity = {0, 0}});
  BodyDefinition definition{.angle = angle, .velocity = velocity, .angular_velocity = spin};
  definition.mass = MassProperties{mass, {}, inertia};
  const BodyId made = world.create_body(definition, shapes);
  apply_wind(world, wind, dt);
  world.step(dt, 1);
  const Vec2d gain = mass / dt * (world.velocity(made) - velocity);
  const double turn = inertia / dt * (world.angular_velocity(made) - spin);
  const double scale = length(right.force) + std::abs(right.torque) / reach +
                       1e-3 * wind.density * fastest * fastest * reach,
               rounding = std::is_same_v<Real, float> ? kRounding : 1e-12;
  const double bound = kShare * 2 * scale + rounding * mass / dt * fastest;
  if (length(gain - right.force) > bound)
    return fmt::format("wind exerts on '{}' a force of {:.5g}, {:.5g} N, not {:.5g}, {:.5g}", body.name,
                       gain.x, gain.y, right.force.x, right.force.y);
  if (std::abs(turn - right.torque) > bound * reach)
    return fmt::format("wind exerts on '{}' a torque of {:.5g} N m, not {:.5g}", body.name, turn,
                       right.torque);
  return {};
}

}  // namespace

Verdict wind(const Case& one, const Engine& engine, const Motion&) {
  Random random(one.seed, one.index + 11);
  int left = kBodies;
  for (const Body& body : one.scene.bodies) {
    if (body.type != BodyType::Dynamic || left-- <= 0) continue;
    std::string what;
    try {
      what = engine.kind == Engine::Kind::World ? blown<float>(body, random) : blown<double>(body, random);
    } catch (const Error&) {
      continue;  // a shape that the world rejects
    }
    if (!what.empty())
      return Objection{
          .law = "wind",
          .judge = "wind",
          .what = what,
          .right = "the pressure of wind on a surface is rho/2 u^2, with u the relative normal speed",
          .subject = body.name};
  }
  return {};
}

}  // namespace plumb::harness::hunt
