#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/json.h"

namespace plumb {
namespace {

double area(const Circle& circle) { return std::numbers::pi * circle.radius * circle.radius; }
double area(const Box& box) { return box.width * box.height; }

/// Square of the radius of gyration about the shape's own centre, m^2: I/m.
double gyration_squared(const Circle& circle) { return circle.radius * circle.radius / 2; }
double gyration_squared(const Box& box) { return (box.width * box.width + box.height * box.height) / 12; }

}  // namespace

BodyState initial_state(const Body& body) {
  return {body.position, body.angle, body.velocity, body.angular_velocity};
}

double inertia_of(const Body& body) {
  if (body.type != BodyType::Dynamic || body.fixed_rotation) return 0;
  if (body.inertia) return *body.inertia;
  double total_area = 0;
  for (const Shape& shape : body.shapes) {
    total_area += std::visit([](const auto& geometry) { return area(geometry); }, shape.geometry);
  }
  // I = sum m_i (k_i^2 + |r_i|^2) with m_i = m A_i / A: the polar moment does not depend on a shape's angle.
  double mean_square = 0;
  for (const Shape& shape : body.shapes) {
    const double share =
        std::visit([](const auto& geometry) { return area(geometry); }, shape.geometry) / total_area;
    const double own =
        std::visit([](const auto& geometry) { return gyration_squared(geometry); }, shape.geometry);
    mean_square += share * (own + length_squared(shape.position));
  }
  return body.mass * mean_square;
}

double combine(Combine rule, double a, double b) {
  switch (rule) {
    case Combine::GeometricMean:
      return std::sqrt(a * b);
    case Combine::Product:
      return a * b;
    case Combine::Maximum:
      return std::max(a, b);
    case Combine::Minimum:
      return std::min(a, b);
    case Combine::Average:
      return (a + b) / 2;
  }
  return 0;
}

bool may_touch(const Filter& a, const Filter& b) {
  if (a.group != 0 && a.group == b.group) return a.group > 0;
  return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

std::array<std::string_view, 2> ends_of(const ForceLaw& law) {
  return std::visit(
      [](const auto& l) -> std::array<std::string_view, 2> {
        if constexpr (requires { l.body_b; }) {
          return {l.body_a, l.body_b};
        } else if constexpr (requires { l.centre_body; }) {
          return {l.body, l.centre_body};
        } else {
          return {l.body, kWorld};
        }
      },
      law);
}

std::optional<std::size_t> find_body(const Scene& scene, std::string_view name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return i;
  }
  return std::nullopt;
}

std::uint64_t hash(const Scene& scene) {
  // http://www.isthe.com/chongo/tech/comp/fnv: FNV-1a, 64 bits.
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const char c : to_json(scene, -1)) {
    h ^= static_cast<unsigned char>(c);
    h *= 0x100000001b3u;
  }
  return h;
}

}  // namespace plumb
