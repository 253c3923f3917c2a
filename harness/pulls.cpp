#include "harness/pulls.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "engine/math/trigonometry.h"
#include "harness/magnitude.h"

namespace plumb::harness {
namespace {

double distance_of(const Scene& scene, std::span<const BodyState> states, const std::string& a,
                   Vec2d anchor_a, const std::string& b, Vec2d anchor_b) {
  const auto place = [&](const std::string& name, Vec2d anchor) {
    const auto body = find_body(scene, name);
    return body ? states[*body].position + rotation_of(states[*body].angle) * anchor : anchor;
  };
  return magnitude(place(b, anchor_b) - place(a, anchor_a));
}

}  // namespace

std::vector<Pull> pulls_in(const Scene& scene, std::span<const BodyState> states) {
  std::vector<Pull> out;
  const auto add = [&](const std::string& a, Vec2d anchor_a, const std::string& b, Vec2d anchor_b,
                       Pull pull) {
    const auto one = find_body(scene, a), other = find_body(scene, b);
    pull.arm = magnitude(anchor_a), pull.partner_arm = magnitude(anchor_b);
    if (one) out.push_back(pull), out.back().body = *one, out.back().partner = other;
    std::swap(pull.arm, pull.partner_arm);
    if (other) out.push_back(pull), out.back().body = *other, out.back().partner = one;
  };
  for (const ForceLaw& law : scene.forces) {
    if (const auto* spring = std::get_if<SpringForce>(&law)) {
      const double length =
          distance_of(scene, states, spring->body_a, spring->anchor_a, spring->body_b, spring->anchor_b);
      const double force = spring->stiffness * std::abs(length - spring->rest_length);
      add(spring->body_a, spring->anchor_a, spring->body_b, spring->anchor_b,
          {0, {}, 0, 0, std::max(spring->stiffness, force / length), spring->damping, force});
    } else if (const auto* pull = std::get_if<AttractionForce>(&law)) {
      const double r = distance_of(scene, states, pull->body, {}, pull->centre_body, pull->centre);
      const double mass = scene.bodies[*find_body(scene, pull->body)].mass;
      const double force = std::abs(pull->strength) * mass / std::pow(r, pull->exponent);
      add(pull->body, {}, pull->centre_body, pull->centre,
          {0, {}, 0, 0, std::max(1, std::abs(pull->exponent)) * force / r, 0, force});
    }
  }
  return out;
}

}  // namespace plumb::harness
