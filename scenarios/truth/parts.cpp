#include "scenarios/truth/parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/scene/error.h"

namespace plumb::scenarios::truth {

Scene scene_of(std::string_view name, std::string_view variant, double gravity) {
  std::string label(name);
  if (!variant.empty()) label += "/" + std::string(variant);
  return {.name = std::move(label), .gravity = {0, -gravity}};
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
  return fixed("ramp", {-std::sin(tilt), -std::cos(tilt)}, solid(Box{40, 2}, friction, restitution), -tilt);
}

Body on_ramp(double tilt, Body body, double height) {
  body.position = height * Vec2d{std::sin(tilt), std::cos(tilt)};
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

Truth equilibrium(const Scene& scene, std::string source) {
  return follow_in_contact(scene, std::move(source), [](Real, Moving) {});
}

}  // namespace plumb::scenarios::truth
