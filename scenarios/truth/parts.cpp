#include "scenarios/truth/parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/scene/error.h"
#include "scenarios/truth/set_up.h"

namespace plumb::scenarios::truth {

Scene scene_of(std::string_view name, std::string_view variant, double gravity) {
  std::string label(name);
  if (!variant.empty()) label += "/" + std::string(variant);
  return {.name = std::move(label), .gravity = {0, 0 - gravity}};  // no negative zero
}

Scene scene_of(std::string_view name, int size, double gravity) {
  return scene_of(std::string(name) + "[" + std::to_string(size) + "]", "", gravity);
}

Shape solid(const Geometry& geometry, double friction, double restitution) {
  return {.geometry = geometry, .friction = friction, .restitution = restitution};
}

Body piece(std::string name, Vec2d position, const Shape& shape, double mass) {
  return {.name = std::move(name), .position = position, .mass = mass, .shapes = {shape}};
}

Body thrown(Body body, Vec2d velocity, double angular_velocity) {
  body.velocity = velocity;
  body.angular_velocity = angular_velocity;
  return body;
}

RevoluteJoint hinge(std::string_view a, Vec2d anchor_a, std::string_view b, Vec2d anchor_b) {
  return {.name = std::string(a) + "-" + std::string(b),
          .body_a = std::string(a),
          .body_b = std::string(b),
          .anchor_a = anchor_a,
          .anchor_b = anchor_b};
}

void name_apart(Scene& scene) {
  std::map<std::string, int> bearers, given;
  for (const Body& body : scene.bodies) ++bearers[body.name];
  for (Body& body : scene.bodies)
    if (bearers[body.name] > 1) body.name += std::to_string(given[body.name]++);
}

Body fixed(std::string name, Vec2d position, const Shape& shape, double angle) {
  return {.name = std::move(name),
          .type = BodyType::Static,
          .position = position,
          .angle = angle,
          .shapes = {shape}};
}

Body ground(double friction, double restitution) {
  return fixed("ground", {0, -1}, solid(Box{40, 2}, friction, restitution));
}

Body ramp(double tilt, double friction, double restitution) {
  const Vec2d way = set_up::direction(tilt);
  return fixed("ramp", {-way.y, -way.x}, solid(Box{40, 2}, friction, restitution), -tilt);
}

Body on_ramp(double tilt, Body body, double height) {
  const Vec2d way = set_up::direction(tilt);
  body.position = height * Vec2d{way.y, way.x};
  body.angle = -tilt;
  return body;
}

double choose(std::string_view variant, std::initializer_list<Choice> choices) {
  for (const Choice& choice : choices)
    if (choice.variant == variant) return choice.value;
  throw Error(Error::Kind::Name, "scenario", "variant", std::string(variant), "has no value");
}

Bounds within(double digits) {
  return {digits, digits, digits, digits, digits, digits, digits, digits, digits};
}

Truth follow(const Scene& scene, std::string source, Path path, std::vector<double> impacts) {
  std::vector<std::size_t> moving;
  std::vector<Motion> start;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].type != BodyType::Dynamic) continue;
    moving.push_back(i);
    start.push_back(motion_of(scene.bodies[i]));
  }
  const auto exact = [all = motions_of(scene), moving, start, path = std::move(path)](
                         double time, std::span<BodyState> out) {
    std::vector<Motion> now = start;
    path(time, now);
    std::ranges::transform(all, out.begin(), [&](const Motion& m) { return rounded(coast(m, time)); });
    for (std::size_t k = 0; k < moving.size(); ++k) out[moving[k]] = rounded(now[k]);
  };
  return {.source = std::move(source), .exact = exact, .impacts = std::move(impacts)};
}

Truth follow_in_contact(const Scene& scene, std::string source, Path path, std::vector<double> impacts) {
  Truth truth = follow(scene, std::move(source), std::move(path), std::move(impacts));
  truth.contacts_last = true;
  return truth;
}

Truth integrated(Truth truth) {
  truth.kind = TruthKind::Integrated;
  return truth;
}

Truth one_impact(const Scene& scene, std::string source, Real at, std::vector<Acceleration> jumps) {
  const Acceleration fall{scene.gravity.as<Real>()};
  const auto path = [at, jumps = std::move(jumps), fall](Real time, Moving moving) {
    for (std::size_t i = 0; i < moving.size(); ++i) {
      moving[i] = coast(moving[i], std::fmin(time, at), fall);
      if (time < at) continue;
      moving[i].velocity += jumps[i].linear;
      moving[i].angular_velocity += jumps[i].angular;
      moving[i] = coast(moving[i], time - at, fall);
    }
  };
  return follow(scene, std::move(source), path, {static_cast<double>(at)});
}

Truth equilibrium(const Scene& scene, std::string source) {
  Truth truth = follow_in_contact(scene, std::move(source), [](Real, Moving) {});
  truth.kind = TruthKind::Equilibrium;
  return truth;
}

}  // namespace plumb::scenarios::truth
