#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "engine/math/trigonometry.h"
#include "engine/scene/prescribed_path.h"

namespace plumb {
BodyState initial_state(const Body& body) {
  const BodyState given{body.position, body.angle, body.velocity, body.angular_velocity};
  return body.motion.empty() ? given : PrescribedPath(body).at(0).state;
}

double inertia_of(const Body& body) {
  if (body.type != BodyType::Dynamic || body.fixed_rotation) return 0;
  if (body.inertia) return *body.inertia;
  double total = 0;
  for (const Shape& shape : body.shapes) total += shape.density.value_or(1) * extent_of(shape.geometry).area;
  // I = m sum s_i (k_i^2 + |r_i|^2), s_i a shape's fraction of the mass, k_i its radius of gyration about its
  // own centroid, r_i the centroid's position. The polar moment does not depend on a shape's angle.
  double mean_square = 0;
  for (const Shape& shape : body.shapes) {
    const Extent extent = extent_of(shape.geometry);
    if (extent.area == 0) continue;
    const double mass_fraction = shape.density.value_or(1) * extent.area / total;
    Vec2d centre = shape.position;
    if (extent.centroid != Vec2d{}) centre += rotation_of(shape.angle) * extent.centroid;
    mean_square += mass_fraction * (extent.gyration_squared + length_squared(centre));
  }
  return body.mass * mean_square;
}

std::optional<double> mass_by_density(const Body& body) {
  if (body.shapes.empty() || !body.shapes.front().density) return std::nullopt;
  double sum = 0;
  for (const Shape& shape : body.shapes) sum += shape.density.value_or(0) * extent_of(shape.geometry).area;
  return sum;
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

bool has_formulas(const Scene& scene) {
  return !scene.drives.empty() || std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) {
    return !body.motion.empty();
  }) || std::any_of(scene.forces.begin(), scene.forces.end(), [](const ForceLaw& law) {
    return std::holds_alternative<FormulaForce>(law) || std::holds_alternative<FormulaSpring>(law);
  });
}

std::optional<std::size_t> find_body(const Scene& scene, std::string_view name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return i;
  }
  return std::nullopt;
}

}  // namespace plumb
