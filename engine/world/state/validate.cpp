#include "engine/world/state/validate.h"

#include <cmath>

#include "engine/core/loop_scheduler.h"
#include "engine/core/text.h"
#include "engine/geometry/convex_hull.h"
#include "engine/joints/joint_check.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "engine/world/state/query_shape.h"

namespace plumb {
namespace {

[[noreturn]] void throw_invalid(const std::string& subject, const std::string& field, double value,
                                const char* problem) {
  throw Error(Error::Kind::Value, subject, field, shortest(value), problem);
}

std::string text_of(Vec2d v) { return "[" + shortest(v.x) + ", " + shortest(v.y) + "]"; }

template <class Enum>
void require_one_of(const std::string& subject, const std::string& field, Enum value, int count) {
  const int number = static_cast<int>(value);
  if (number >= 0 && number < count) return;
  throw Error(Error::Kind::Value, subject, field, std::to_string(number), "is no member of its enumeration");
}

void require_fraction(const std::string& subject, const std::string& field, double value) {
  if (!(value >= 0 && value <= 1)) throw_invalid(subject, field, value, "must be a number from 0 to 1");
}

constexpr int kCombineRules = 5, kBodyTypes = 3;

std::string point_field(std::size_t index) { return "points[" + std::to_string(index) + "]"; }

// Builds the field's name only for errors, because chains may have 100,000 points.
void require_point(const std::string& subject, std::size_t index, Vec2d point) {
  if (!(std::abs(point.x) <= kLargestNumber && std::abs(point.y) <= kLargestNumber))
    require_finite(subject, point_field(index), point);
}

struct CheckGeometry {
  const std::string subject = "shape";
  void operator()(const Circle& circle) const { require_positive(subject, "radius", circle.radius); }
  void operator()(const Box& box) const {
    require_positive(subject, "width", box.width);
    require_positive(subject, "height", box.height);
  }
  void operator()(const Capsule& capsule) const {
    require_finite(subject, "start", capsule.start);
    require_finite(subject, "end", capsule.end);
    require_positive(subject, "radius", capsule.radius);
  }
  void operator()(const Polygon& polygon) const {
    require_not_negative(subject, "radius", polygon.radius);
    for (std::size_t i = 0; i < polygon.points.size(); ++i) require_point(subject, i, polygon.points[i]);
    convex_hull(polygon.points);  // rejects polygons without area
  }
  void operator()(const Segment& segment) const {
    require_finite(subject, "start", segment.start);
    require_finite(subject, "end", segment.end);
    if (!(length_squared(segment.end - segment.start) > kSmallestNumber * kSmallestNumber)) {
      throw Error(Error::Kind::Value, subject, "end", text_of(segment.end), "must be apart from the start");
    }
  }
};

}  // namespace

void require_finite(const std::string& subject, const std::string& field, double value) {
  if (!(std::abs(value) <= kLargestNumber))
    throw_invalid(subject, field, value, "must be a number between -1e12 and 1e12");
}

void require_finite(const std::string& subject, const std::string& field, Vec2d value) {
  if (!(std::abs(value.x) <= kLargestNumber && std::abs(value.y) <= kLargestNumber)) {
    throw Error(Error::Kind::Value, subject, field, text_of(value), "must be numbers between -1e12 and 1e12");
  }
}

void require_query_position(const std::string& subject, const std::string& field, Vec2d value) {
  if (!(std::abs(value.x) <= 1e100 && std::abs(value.y) <= 1e100)) {
    throw Error(Error::Kind::Value, subject, field, text_of(value),
                "must be numbers between -1e100 and 1e100");
  }
}

void require_not_negative(const std::string& subject, const std::string& field, double value) {
  if (!(value >= 0 && value <= kLargestNumber))
    throw_invalid(subject, field, value, "must be a number from 0 to 1e12");
}

void require_positive(const std::string& subject, const std::string& field, double value) {
  if (!(value >= kSmallestNumber && value <= kLargestNumber)) {
    throw_invalid(subject, field, value, "must be a positive number between 1e-12 and 1e12");
  }
}

void require_inertia(const std::string& subject, double value) {
  if (!(value >= kSmallestInertia && value <= kLargestInertia))
    throw_invalid(subject, "inertia", value, "must be a positive number between 1e-30 and 1e30");
}

void validate(const WorldDefinition& definition) {
  require_finite("world", "gravity", definition.gravity);
  require_one_of("world", "combine_friction", definition.combine_friction, kCombineRules);
  require_one_of("world", "combine_restitution", definition.combine_restitution, kCombineRules);
  require_one_of("world", "integrator", definition.integrator, 3);
  require_one_of("world", "solver", definition.solver, static_cast<int>(std::size(kSolverNames)));
  if (definition.iterations < 1 || definition.iterations > 1000) {
    throw Error(Error::Kind::Value, "world", "iterations", std::to_string(definition.iterations),
                "must be a number from 1 to 1000");
  }
  require_threads(definition.threads);
  require_finite("world", "thresholds.hit", definition.thresholds.hit);
  require_finite("world", "thresholds.bounce", definition.thresholds.bounce);
  require_finite("world", "thresholds.sleep", definition.thresholds.sleep);
}

void require_threads(int threads) {
  if (threads >= 1 && threads <= LoopScheduler::kMaxThreads) return;
  throw Error(Error::Kind::Value, "world", "threads", std::to_string(threads),
              "must be a number from 1 to " + std::to_string(LoopScheduler::kMaxThreads));
}

void validate(const BodyDefinition& definition) {
  const std::string subject = definition.name.empty() ? "body" : "body " + quoted(definition.name);
  require_one_of(subject, "type", definition.type, kBodyTypes);
  require_finite(subject, "position", definition.position);
  require_finite(subject, "angle", definition.angle);
  require_finite(subject, "velocity", definition.velocity);
  require_finite(subject, "angular_velocity", definition.angular_velocity);
  require_finite(subject, "gravity_scale", definition.gravity_scale);
  require_not_negative(subject, "linear_damping", definition.linear_damping);
  require_not_negative(subject, "angular_damping", definition.angular_damping);
  if (!definition.mass) return;
  if (!(definition.mass->mass >= 1 / kLargestMass && definition.mass->mass <= kLargestMass))
    throw_invalid(subject, "mass", definition.mass->mass, "must be a positive number between 1e-18 and 1e18");
  require_finite(subject, "centre", definition.mass->centre);
  require_inertia(subject, definition.mass->inertia);
}

void validate(const ShapeDefinition& definition) {
  const std::string subject = "shape";
  std::visit(CheckGeometry{}, definition.geometry);
  require_finite(subject, "position", definition.position);
  require_finite(subject, "angle", definition.angle);
  if (definition.density != 0 &&
      !(definition.density >= kSmallestNumber && definition.density <= kLargestNumber))
    throw_invalid(subject, "density", definition.density, "must be 0 or a number from 1e-12 to 1e12");
  validate(subject, definition.material);
}

void validate(const ChainDefinition& definition) {
  const std::string subject = "chain";
  const std::size_t least = definition.closed ? 3 : 2;
  if (definition.points.size() < least) {
    throw Error(Error::Kind::Value, subject, "points", std::to_string(definition.points.size()),
                "must be " + std::to_string(least) + " or more points");
  }
  for (std::size_t i = 0; i < definition.points.size(); ++i) {
    require_point(subject, i, definition.points[i]);
    const bool last = i + 1 == definition.points.size();
    if (last && !definition.closed) break;
    const std::size_t after = last ? 0 : i + 1;
    const Vec2d next = definition.points[after];
    if (!(length_squared(next - definition.points[i]) > kSmallestNumber * kSmallestNumber)) {
      throw Error(Error::Kind::Value, subject, point_field(after), text_of(next),
                  "must be apart from the point before it");
    }
  }
  validate(subject, definition.material);
  const std::size_t segments = definition.points.size() - (definition.closed ? 0 : 1);
  const std::size_t materials = definition.materials.size();
  if (materials != 0 && materials != segments) {
    throw Error(Error::Kind::Value, subject, "materials", std::to_string(materials),
                "must be none, or " + std::to_string(segments) + ": one per segment");
  }
  for (std::size_t i = 0; i < materials; ++i) {
    try {
      validate(subject, definition.materials[i]);
    } catch (const Error& error) {
      throw Error(error.kind(), subject, "materials[" + std::to_string(i) + "]." + error.field(),
                  error.value(), error.problem());
    }
  }
}

void validate(const JointDefinition& definition) {
  validate(definition.kind);
  require_not_negative("joint", "break_force", definition.break_force);
  require_not_negative("joint", "report_force", definition.report_force);
  require_not_negative("joint", "report_torque", definition.report_torque);
  require_not_negative("joint", "break_torque", definition.break_torque);
}

void validate(const std::string& subject, const Material& material) {
  require_not_negative(subject, "friction", material.friction);
  require_fraction(subject, "restitution", material.restitution);
  require_not_negative(subject, "rolling_resistance", material.rolling_resistance);
  require_finite(subject, "surface_speed", material.surface_speed);
}

void validate(BodyType type) { require_one_of("body", "type", type, kBodyTypes); }

void require_float_mass(const ShapeDefinition& definition) {
  if (definition.density == 0) return;
  ConvexMass part = convex_mass(QueryShape(definition.geometry).convex(), definition.density);
  part.centroid = definition.position + rotation_of(definition.angle) * part.centroid;
  require_float_mass(definition.density, part);
}

// The inertia about any point of the body is an upper bound of that about the centre of mass.
void require_float_mass(double density, const ConvexMass& part) {
  if (part.mass == 0) return;
  const double whole = part.inertia + part.mass * length_squared(part.centroid);
  const bool fits_float = part.mass >= kSmallestFloatMass && part.mass <= kLargestFloatMass &&
                          part.inertia >= kSmallestFloatMass && whole <= kLargestFloatMass;
  if (fits_float) return;
  throw Error(Error::Kind::Value, "shape", "density", shortest(density),
              "gives a mass of " + shortest(part.mass) + " kg and an inertia of " + shortest(whole) +
                  " kg m^2, of which single precision holds 1e-36 to 1e36");
}

}  // namespace plumb
