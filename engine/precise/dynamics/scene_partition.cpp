#include "engine/precise/dynamics/scene_partition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <string_view>
#include <variant>

#include "engine/forces/attraction_force.h"
#include "engine/forces/compile.h"
#include "engine/math/trigonometry.h"
#include "engine/precise/dynamics/joints.h"
#include "engine/scene/geometry.h"
#include "engine/scene/prescribed_path.h"

namespace plumb::precise {
namespace {

using Index = std::map<std::string_view, std::size_t>;

Index index_of_bodies(const Scene& scene) {
  Index index;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) index.emplace(scene.bodies[i].name, i);
  return index;
}

/// Returns true if a law's wrench on its body is constant between switching times, however the body moves.
bool is_constant(const LinearDrag& law, const Body&) {
  return law.coefficient == 0 && law.angular_coefficient == 0;
}
bool is_constant(const QuadraticDrag& law, const Body&) { return law.coefficient == 0; }
bool is_constant(const PointForce& law, const Body& body) {
  const bool no_lever = law.point == Vec2d{} || body.fixed_rotation;
  return law.force == Vec2d{} || (law.frame == Frame::World && no_lever);
}
bool is_constant(const Torque&, const Body&) { return true; }
bool is_constant(const SpringForce& law, const Body&) { return law.stiffness == 0 && law.damping == 0; }
bool is_constant(const AttractionForce& law, const Body&) { return law.strength == 0; }
bool is_constant(const SinusoidalForce& law, const Body&) { return law.amplitude == Vec2d{}; }

bool is_constant(const FormulaForce&, const Body&) { return false; }
bool is_constant(const FormulaSpring&, const Body&) { return false; }

void add_window(const ForceLaw& law, std::vector<double>& switches) {
  std::visit(
      [&](const auto& l) {
        if constexpr (requires { l.start; }) {
          for (const double time : {l.start, l.start + l.duration}) {
            if (time > 0 && std::isfinite(time)) switches.push_back(time);
          }
        }
      },
      law);
}

void sort_unique(auto& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Marks, by index, the bodies with a joint or with a law that is not constant.
std::vector<char> needs_integration(const Scene& scene, const Index& index) {
  std::vector<char> result(scene.bodies.size(), 0);
  const auto mark = [&](std::string_view name) {
    if (name != kWorld) result[index.at(name)] = 1;
  };
  for (const Joint& joint : scene.joints) {
    std::visit([&](const auto& j) { mark(j.body_a), mark(j.body_b); }, joint);
  }
  for (const ForceLaw& law : scene.forces) {
    for (const std::string_view name : ends_of(law)) {
      if (name == kWorld) continue;
      const Body& body = scene.bodies[index.at(name)];
      if (!std::visit([&](const auto& l) { return is_constant(l, body); }, law)) mark(name);
    }
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    // Prescribed bodies are integrated too, because steps and contact searches need their path.
    if (scene.bodies[i].type != BodyType::Dynamic) result[i] = scene.bodies[i].motion.empty() ? 0 : 1;
  }
  return result;
}

std::vector<std::pair<std::size_t, std::size_t>> non_colliding_pairs(const Scene& scene, const Index& index) {
  std::vector<std::pair<std::size_t, std::size_t>> non_colliding;
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          if (j.collide || j.body_a == kWorld || j.body_b == kWorld) return;
          non_colliding.push_back(std::minmax(index.at(j.body_a), index.at(j.body_b)));
        },
        joint);
  }
  sort_unique(non_colliding);
  return non_colliding;
}

/// Returns another body with a shape that `shape` of body `a` may touch, or `a` if there is none.
std::size_t partner(const Scene& scene, const ScenePartition& partition, std::size_t a, const Shape& shape) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    for (const Shape& other : scene.bodies[b].shapes) {
      if (may_collide(scene, partition, a, shape.filter, b, other.filter)) return b;
    }
  }
  return a;
}

/// Length and acceleration that a law has at the start, used as scales.
struct LawScale {
  double length = 0, acceleration = 0;
};

class LawScales {
 public:
  LawScales(const Scene& scene, const Index& index) : scene_(scene), index_(index) {}

  LawScale operator()(const LinearDrag&) const { return {}; }
  LawScale operator()(const QuadraticDrag&) const { return {}; }
  LawScale operator()(const Torque&) const { return {}; }
  LawScale operator()(const PointForce& law) const {
    return {length(law.point), length(law.force) / mass(law.body)};
  }
  LawScale operator()(const SinusoidalForce& law) const {
    return {length(law.point), length(law.amplitude) / mass(law.body)};
  }
  LawScale operator()(const SpringForce& law) const {
    const double span = length(place(law.body_b, law.anchor_b) - place(law.body_a, law.anchor_a));
    const double pull = law.stiffness * std::abs(span - law.rest_length);
    return {std::max(span, law.rest_length), pull / std::min(mass(law.body_a), mass(law.body_b))};
  }
  LawScale operator()(const AttractionForce& law) const {
    const double distance = length(place(law.centre_body, law.centre) - place(law.body, {}));
    if (distance == 0) return {};
    return {distance, std::abs(law.strength) * whole_power(distance, -law.exponent)};
  }
  LawScale operator()(const FormulaForce& law) const {
    const Body& body = scene_.bodies[index_.at(law.body)];
    const FormulaForceLaw compiled = LawCompiler(scene_).compile(law);
    const Wrench<double> start =
        compiled.wrench(0, {body.position, rotation_of(body.angle)}, {body.velocity, body.angular_velocity});
    return {length(law.point), finite(length(start.force) / mass(law.body))};
  }
  LawScale operator()(const FormulaSpring& law) const {
    const double span = length(place(law.body_b, law.anchor_b) - place(law.body_a, law.anchor_a));
    const double now[] = {0, span, 0};
    const double pull = std::abs(LawCompiler(scene_).compile(law).tension.at(std::span<const double>(now)));
    return {span, finite(pull / std::min(mass(law.body_a), mass(law.body_b)))};
  }

 private:
  static double finite(double value) { return std::isfinite(value) ? value : 0; }
  double mass(std::string_view name) const {
    if (name == kWorld) return std::numeric_limits<double>::infinity();
    const Body& body = scene_.bodies[index_.at(name)];
    return body.type == BodyType::Dynamic ? body.mass : std::numeric_limits<double>::infinity();
  }
  Vec2d place(std::string_view name, Vec2d point) const {
    if (name == kWorld) return point;
    const Body& body = scene_.bodies[index_.at(name)];
    return body.position + rotation_of(body.angle) * point;
  }

  const Scene& scene_;
  const Index& index_;
};

/// Returns the acceleration (m/s^2) that springs of joints cause at the start, of points up to `arm` away.
double acceleration_by_springs(const Scene& scene, double arm) {
  const GeneralJoints joints(scene);
  if (!joints.has_springs()) return 0;
  std::vector<Pose<double>> poses;
  std::vector<double> angles;
  std::vector<Twist<double>> twists;
  for (const Body& body : scene.bodies) {
    poses.push_back({body.position, rotation_of(body.angle)});
    angles.push_back(body.angle);
    twists.push_back({body.velocity, body.angular_velocity});
  }
  std::vector<Wrench<double>> wrenches(scene.bodies.size());
  joints.add_springs({poses, angles, twists}, wrenches);
  double most = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    const double inertia = inertia_of(body);
    most = std::max(most, length(wrenches[i].force) / body.mass);
    if (inertia > 0) most = std::max(most, arm * std::abs(wrenches[i].torque) / inertia);
  }
  return most;
}

}  // namespace

Scene with_laws_on(const Scene& scene, const std::vector<std::size_t>& bodies) {
  Scene part = scene;
  std::erase_if(part.forces, [&](const ForceLaw& law) {
    const auto ends = ends_of(law);
    return std::none_of(ends.begin(), ends.end(), [&](std::string_view name) {
      const auto body = find_body(scene, name);
      return body && std::binary_search(bodies.begin(), bodies.end(), *body);
    });
  });
  return part;
}

ScenePartition partition_scene(const Scene& scene) {
  const Index index = index_of_bodies(scene);
  ScenePartition partition;
  partition.non_colliding = non_colliding_pairs(scene, index);
  std::vector<char> integrated = needs_integration(scene, index);
  partition.constant_forces =
      std::none_of(integrated.begin(), integrated.end(), [](char is) { return is != 0; });
  double extent = 0;
  for (const Body& body : scene.bodies) {
    for (const Shape& shape : body.shapes)
      extent = std::max(extent, length(body.position) + length(shape.position) + reach_of(shape.geometry));
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    for (const Shape& shape : scene.bodies[i].shapes) {
      if (partner(scene, partition, i, shape) == i) continue;
      for (FeatureShape& feature_shape : feature_shapes_of(i, shape, extent))
        partition.shapes.push_back(std::move(feature_shape));
      if (scene.bodies[i].type == BodyType::Dynamic) integrated[i] = 1;
    }
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    (integrated[i] ? partition.integrated : partition.ballistic).push_back(i);
  }
  for (const ForceLaw& law : scene.forces) add_window(law, partition.switches);
  sort_unique(partition.switches);
  return partition;
}

bool may_collide(const Scene& scene, const ScenePartition& partition, std::size_t body_a, const Filter& a,
                 std::size_t body_b, const Filter& b) {
  if (body_a == body_b) return false;
  const bool dynamic =
      scene.bodies[body_a].type == BodyType::Dynamic || scene.bodies[body_b].type == BodyType::Dynamic;
  return dynamic && may_touch(a, b) &&
         !std::binary_search(partition.non_colliding.begin(), partition.non_colliding.end(),
                             std::pair<std::size_t, std::size_t>(std::minmax(body_a, body_b)));
}

Scales scales_of(const Scene& scene, const ScenePartition& partition) {
  const Index index = index_of_bodies(scene);
  double largest = 0, acceleration = length(scene.gravity), speed = 0;
  for (const std::size_t i : partition.integrated) {
    const Body& body = scene.bodies[i];
    speed = std::max(speed, length(body.velocity));
    if (!body.motion.empty()) {
      const PrescribedPath::Point start = PrescribedPath(body).at(0);
      speed = std::max(speed, length(start.state.velocity));
      acceleration = std::max(acceleration, length(start.acceleration));
    }
    for (const Shape& shape : body.shapes) {
      largest = std::max(largest, reach_of(shape.geometry));
    }
  }
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          if constexpr (requires { j.anchor_a; }) {
            if (j.body_a != kWorld) largest = std::max(largest, length(j.anchor_a));
            if (j.body_b != kWorld) largest = std::max(largest, length(j.anchor_b));
          }
        },
        joint);
    if (const auto* rod = std::get_if<DistanceJoint>(&joint)) largest = std::max(largest, rod->length);
  }
  for (const ForceLaw& law : scene.forces) {
    const LawScale scale = std::visit(LawScales(scene, index), law);
    largest = std::max(largest, scale.length);
    acceleration = std::max(acceleration, scale.acceleration);
  }
  Scales scales;
  if (largest > 0) scales.length = largest;
  acceleration = std::max(acceleration, acceleration_by_springs(scene, scales.length));
  for (const std::size_t i : partition.integrated) {
    speed = std::max(speed, scales.length * std::abs(scene.bodies[i].angular_velocity));
  }
  const double gained = std::sqrt(acceleration * scales.length);
  scales.speed = gained > 0 ? gained : speed > 0 ? speed : scales.length;
  return scales;
}

}  // namespace plumb::precise
