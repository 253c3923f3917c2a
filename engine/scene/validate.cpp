#include "engine/scene/validate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/check.h"
#include "engine/scene/error.h"
#include "engine/scene/formula.h"
#include "engine/scene/joint_fields.h"
#include "engine/scene/names.h"
#include "engine/scene/prescribed_path.h"
#include "engine/scene/subject.h"

namespace plumb {
namespace {

std::string text_of(Vec2d v) { return "[" + shortest(v.x) + ", " + shortest(v.y) + "]"; }

using Index = std::unordered_map<std::string_view, std::size_t>;

/// Checks a scene in order and throws at the first error.
class Checker {
 public:
  Checker(const Scene& scene, Place& place) : scene_(scene), place_(place) {}

  void run() {
    place_ = {};
    check_scene();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      place_ = {Place::List::Bodies, i};
      check_body(scene_.bodies[i]);
    }
    for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
      place_ = {Place::List::Joints, i};
      std::visit([this](const auto& joint) { check_joint(joint); }, scene_.joints[i]);
    }
    for (std::size_t i = 0; i < scene_.forces.size(); ++i) {
      place_ = {Place::List::Forces, i};
      std::visit([this](const auto& law) { check_force(law); }, scene_.forces[i]);
    }
    for (std::size_t i = 0; i < scene_.drives.size(); ++i) {
      place_ = {Place::List::Drives, i};
      check_drive(scene_.drives[i]);
    }
    place_ = {};
  }

 private:
  [[noreturn]] void fail(Error::Kind kind, const std::string& field, std::string value,
                         std::string problem) const {
    throw Error(kind, subject(), prefix_ + field, std::move(value), std::move(problem));
  }

  std::string subject() const {
    switch (place_.list) {
      case Place::List::Bodies:
        return body_subject(place_.index, scene_.bodies[place_.index].name);
      case Place::List::Joints:
        return std::visit([this](const auto& joint) { return joint_subject(place_.index, joint.name); },
                          scene_.joints[place_.index]);
      case Place::List::Forces: {
        const ForceLaw& law = scene_.forces[place_.index];
        return force_subject(place_.index, kForceNames[law.index()], ends_of(law)[0]);
      }
      case Place::List::Drives:
        return drive_subject(place_.index);
      case Place::List::None:
        break;
    }
    return scene_subject(scene_.name);
  }

  void number(const std::string& field, double value, Limits range, const char* unit) const {
    if (!std::isfinite(value) || !within(range, value)) {
      fail(Error::Kind::Value, field, shortest(value), describe(range, unit));
    }
    if (std::abs(value) > kLargest) too_large(field, shortest(value));
    if ((range == Limits::Positive || range == Limits::NotZero) && std::abs(value) < kSmallest) {
      fail(Error::Kind::Value, field, shortest(value),
           "must be at least " + shortest(kSmallest) + (range == Limits::NotZero ? " in magnitude" : "") +
               ": products with its reciprocal would overflow");
    }
  }

  [[noreturn]] void too_large(const std::string& field, std::string value) const {
    fail(Error::Kind::Value, field, std::move(value),
         "must be at most " + shortest(kLargest) + " in magnitude: products of such numbers overflow");
  }

  void vector(const std::string& field, Vec2d value, const char* unit) const {
    if (!std::isfinite(value.x) || !std::isfinite(value.y)) {
      fail(Error::Kind::Value, field, text_of(value), std::string("must be two finite numbers of ") + unit);
    }
    if (std::abs(value.x) > kLargest || std::abs(value.y) > kLargest) too_large(field, text_of(value));
  }

  template <class Enum, std::size_t kCount>
  void member(const char* field, Enum value, const std::array<std::string_view, kCount>& names) const {
    const auto number = static_cast<int>(value);
    if (number >= 0 && number < static_cast<int>(names.size())) return;
    fail(Error::Kind::Value, field, std::to_string(number), "is no member of its enumeration");
  }

  void text(const char* field, const std::string& value) const {
    if (!is_utf8(value)) fail(Error::Kind::Name, field, printable(value), "must be UTF-8");
    if (has_control_character(value)) {
      fail(Error::Kind::Name, field, printable(value), "must not contain control characters");
    }
  }

  /// Checks the name of a body or joint: unique and not empty.
  void name(const std::string& value, Index& taken) const {
    if (value.empty()) fail(Error::Kind::Name, "name", "", "must not be empty");
    text("name", value);
    const auto [other, is_new] = taken.try_emplace(value, place_.index);
    if (is_new) return;
    const std::string thing = place_.list == Place::List::Bodies ? "body " : "joint ";
    fail(Error::Kind::Name, "name", printable(value),
         "must be unique: " + thing + std::to_string(other->second) + " has this name too (counted from 0)");
  }

  void check_scene() const {
    text("name", scene_.name);
    vector("gravity", scene_.gravity, "m/s^2");
    member("contact_rules.friction", scene_.contact_rules.friction, kCombineNames);
    member("contact_rules.restitution", scene_.contact_rules.restitution, kCombineNames);
    number("contact_rules.restitution_threshold", scene_.contact_rules.restitution_threshold,
           Limits::NonNegative, "m/s");
    member("contact_rules.simultaneous", scene_.contact_rules.simultaneous, kSimultaneousNames);
    member("contact_rules.impact", scene_.contact_rules.impact, kImpactNames);
    number("contact_rules.yield_speed", scene_.contact_rules.yield_speed, Limits::NonNegative, "m/s");
    number("contact_rules.tangential_restitution", scene_.contact_rules.tangential_restitution,
           Limits::ZeroToOne, "");
    number("contact_rules.friction_after_stop", scene_.contact_rules.friction_after_stop, Limits::ZeroToOne,
           "");
    number("contact_rules.friction_while_sliding", scene_.contact_rules.friction_while_sliding,
           Limits::ZeroToOne, "");
  }

  void check_body(const Body& body) {
    name(body.name, body_names_);
    if (body.name == kWorld) {
      fail(Error::Kind::Name, "name", body.name, "must be another: joints mean the fixed frame by this name");
    }
    member("type", body.type, kBodyTypeNames);
    vector("position", body.position, "m");
    number("angle", body.angle, Limits::Any, "rad");
    check_motion(body);
    check_path(body);
    const bool dynamic = body.type == BodyType::Dynamic;
    number("mass", body.mass, dynamic ? Limits::Positive : Limits::NonNegative, "kg");
    if (body.inertia) number("inertia", *body.inertia, Limits::Positive, "kg m^2");
    for (std::size_t i = 0; i < body.shapes.size(); ++i) {
      prefix_ = "shapes[" + std::to_string(i) + "].";
      check_shape(body.shapes[i]);
      prefix_.clear();
    }
    number("gravity_scale", body.gravity_scale, Limits::Any, "");
    number("linear_damping", body.linear_damping, Limits::NonNegative, "1/s");
    number("angular_damping", body.angular_damping, Limits::NonNegative, "1/s");
    if (dynamic) check_mass(body);
  }

  /// Checks that mass and densities agree, and that the inertia can be computed from the shapes.
  void check_mass(const Body& body) const {
    const auto has = [](const Shape& shape) { return shape.density.has_value(); };
    if (std::any_of(body.shapes.begin(), body.shapes.end(), has)) {
      for (std::size_t i = 0; i < body.shapes.size(); ++i) {
        if (has(body.shapes[i])) continue;
        fail(Error::Kind::Value, "shapes[" + std::to_string(i) + "].density", "absent",
             "must be given in kg/m^2 when another shape of the body has its density");
      }
      const double sum = *mass_by_density(body);
      if (!(sum >= kSmallest && sum <= kLargest))
        fail(Error::Kind::Value, "mass", shortest(sum),
             "by the shapes' densities is out of range: it must be positive");
      // Tolerance of a decimal with 9 digits.
      if (!(std::abs(body.mass - sum) <= 1e-9 * sum))
        fail(Error::Kind::Value, "mass", shortest(body.mass),
             "must be " + shortest(sum) + " kg, what the shapes' densities give; it may be left out");
    }
    if (body.inertia || body.fixed_rotation) return;
    const auto weighs = [](const Shape& shape) {
      return shape.density.value_or(1) > 0 && extent_of(shape.geometry).area > 0;
    };
    if (body.shapes.empty()) {
      fail(Error::Kind::Value, "inertia", "absent",
           "must be given in kg m^2 for a dynamic body without shapes, unless fixed_rotation is true");
    }
    if (std::none_of(body.shapes.begin(), body.shapes.end(), weighs)) {
      fail(Error::Kind::Value, "inertia", "absent",
           "must be given in kg m^2 for a dynamic body whose shapes weigh nothing, unless fixed_rotation is "
           "true");
    }
  }

  void check_motion(const Body& body) const {
    vector("velocity", body.velocity, "m/s");
    number("angular_velocity", body.angular_velocity, Limits::Any, "rad/s");
    if (body.type == BodyType::Static && body.velocity != Vec2d{}) {
      fail(Error::Kind::Value, "velocity", text_of(body.velocity),
           "must be zero for a static body; a kinematic one moves as it is told");
    }
    if (body.angular_velocity == 0) return;
    if (body.type == BodyType::Static) {
      fail(Error::Kind::Value, "angular_velocity", shortest(body.angular_velocity),
           "must be zero for a static body; a kinematic one moves as it is told");
    }
    if (body.fixed_rotation) {
      fail(Error::Kind::Value, "angular_velocity", shortest(body.angular_velocity),
           "must be zero for a body whose fixed_rotation is true");
    }
  }

  void check_shape(const Shape& shape) const {
    std::visit([this](const auto& geometry) { check_geometry(geometry); }, shape.geometry);
    vector("position", shape.position, "m");
    number("angle", shape.angle, Limits::Any, "rad");
    number("friction", shape.friction, Limits::NonNegative, "");
    number("restitution", shape.restitution, Limits::ZeroToOne, "");
    number("rolling_resistance", shape.rolling_resistance, Limits::NonNegative, "");
    number("surface_speed", shape.surface_speed, Limits::Any, "m/s");
    if (shape.density) number("density", *shape.density, Limits::NonNegative, "kg/m^2");
  }

  void check_geometry(const Circle& circle) const { number("radius", circle.radius, Limits::Positive, "m"); }

  void check_geometry(const Box& box) const {
    number("width", box.width, Limits::Positive, "m");
    number("height", box.height, Limits::Positive, "m");
  }

  void check_geometry(const Capsule& capsule) const {
    vector("start", capsule.start, "m");
    vector("end", capsule.end, "m");
    number("radius", capsule.radius, Limits::Positive, "m");
  }

  void check_geometry(const Polygon& polygon) const {
    points(polygon.points, 3);
    number("radius", polygon.radius, Limits::NonNegative, "m");
    if (!(extent_of(polygon).area > 0))
      fail(Error::Kind::Value, "points", std::to_string(polygon.points.size()) + " points",
           "must not lie on a line: a polygon has an area");
  }

  void check_geometry(const Segment& segment) const {
    vector("start", segment.start, "m");
    vector("end", segment.end, "m");
    if (segment.start == segment.end)
      fail(Error::Kind::Value, "end", text_of(segment.end), "must differ from start: a segment has a length");
  }

  void check_geometry(const Chain& chain) const {
    points(chain.points, 2);
    if (chain.closed && chain.points.size() < 3)
      fail(Error::Kind::Value, "points", std::to_string(chain.points.size()) + " points",
           "must be 3 or more when closed");
    for (std::size_t i = 0; i < chain.points.size(); ++i) {
      const bool last = i + 1 == chain.points.size();
      const std::size_t next = last ? 0 : i + 1;
      if ((last && !chain.closed) || chain.points[i] != chain.points[next]) continue;
      fail(Error::Kind::Value, "points[" + std::to_string(next) + "]", text_of(chain.points[next]),
           "must differ from the point before it");
    }
  }

  void points(const std::vector<Vec2d>& points, std::size_t least) const {
    if (points.size() < least)
      fail(Error::Kind::Value, "points", std::to_string(points.size()) + " points",
           "must be " + std::to_string(least) + " or more");
    for (std::size_t i = 0; i < points.size(); ++i)
      vector("points[" + std::to_string(i) + "]", points[i], "m");
  }

  /// Returns the body named by `field`; nullptr for the world if that is allowed.
  const Body* body_called(const char* field, const std::string& name, bool or_world) const {
    if (or_world && name == kWorld) return nullptr;
    if (const auto found = body_names_.find(name); found != body_names_.end())
      return &scene_.bodies[found->second];
    std::vector<std::string> known;
    for (const Body& body : scene_.bodies) known.push_back(body.name);
    if (or_world) known.emplace_back(kWorld);
    const std::string allowed =
        or_world ? "must be the name of a body or 'world'" : "must be the name of a body";
    fail(Error::Kind::Name, field, printable(name), allowed + did_you_mean(name, known));
  }

  template <class AnyJoint>
  void check_joint(const AnyJoint& joint) {
    name(joint.name, joint_names_);
    const Body* a = body_called("body_a", joint.body_a, true);
    const Body* b = body_called("body_b", joint.body_b, true);
    if (a == b) {
      fail(Error::Kind::Name, "body_b", joint.body_b,
           "must differ from body_a: a joint holds two bodies together");
    }
    const auto moves = [](const Body* body) { return body != nullptr && body->type == BodyType::Dynamic; };
    if (!moves(a) && !moves(b)) {
      fail(Error::Kind::Name, "body_b", joint.body_b,
           "must be dynamic when " + quoted(joint.body_a) + " is not: a joint has to have something to hold");
    }
    const auto check = [this](const char* field, const auto& value, const FieldRule& rule) {
      this->field(field, value, rule);
    };
    anchor_fields(joint, check);
    own_fields(joint, check);
    last_fields(joint, check);
  }

  // Checks a field of a joint, by its type.
  void field(const std::string& name, double value, const FieldRule& rule) const {
    number(name, value, rule.limits, rule.unit);
  }
  void field(const std::string&, bool, const FieldRule&) const {}
  void field(const std::string& name, Vec2d value, const FieldRule& rule) const {
    vector(name, value, rule.unit);
    if (rule.limits == Limits::NotZero && std::max(std::abs(value.x), std::abs(value.y)) < kSmallest)
      fail(Error::Kind::Value, name, text_of(value), "must not be zero: it is a direction");
  }
  void field(const std::string& name, const Spring& spring, const FieldRule&) const {
    number(name + ".hertz", spring.hertz, Limits::Positive, "1/s");
    number(name + ".damping_ratio", spring.damping_ratio, Limits::NonNegative, "");
  }
  void field(const std::string& name, const Motor& motor, const FieldRule& rule) const {
    number(name + ".speed", motor.speed, Limits::Any, rule.unit);
    number(name + ".max_force", motor.max_force, Limits::NonNegative, "N or N m");
  }
  void field(const std::string& name, const Range& range, const FieldRule& rule) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (range.lower != -kInfinity) number(name + ".lower", range.lower, rule.limits, rule.unit);
    if (range.upper != kInfinity) number(name + ".upper", range.upper, rule.limits, rule.unit);
    if (!(range.lower <= range.upper))
      fail(Error::Kind::Value, name + ".upper", shortest(range.upper),
           "must be at least the lower bound, " + shortest(range.lower));
  }
  template <class T>
  void field(const std::string& name, const std::optional<T>& value, const FieldRule& rule) const {
    if (value) field(name, *value, rule);
  }

  void check_force(const LinearDrag& law) const {
    body_called("body", law.body, false);
    number("coefficient", law.coefficient, Limits::NonNegative, "N s/m");
    number("angular_coefficient", law.angular_coefficient, Limits::NonNegative, "N m s");
  }

  void check_force(const QuadraticDrag& law) const {
    body_called("body", law.body, false);
    number("coefficient", law.coefficient, Limits::NonNegative, "N s^2/m^2");
  }

  void check_force(const PointForce& law) const {
    body_called("body", law.body, false);
    vector("force", law.force, "N");
    vector("point", law.point, "m");
    member("frame", law.frame, kFrameNames);
    check_time(law.start, law.duration);
  }

  void check_force(const Torque& law) const {
    body_called("body", law.body, false);
    number("torque", law.torque, Limits::Any, "N m");
    check_time(law.start, law.duration);
  }

  void check_force(const SpringForce& law) const {
    const Body* a = body_called("body_a", law.body_a, true);
    const Body* b = body_called("body_b", law.body_b, true);
    if (a == b)
      fail(Error::Kind::Name, "body_b", law.body_b, "must differ from body_a: a spring pulls two ends");
    vector("anchor_a", law.anchor_a, "m");
    vector("anchor_b", law.anchor_b, "m");
    number("rest_length", law.rest_length, Limits::NonNegative, "m");
    number("stiffness", law.stiffness, Limits::NonNegative, "N/m");
    number("damping", law.damping, Limits::NonNegative, "N s/m");
  }

  void check_force(const AttractionForce& law) const {
    const Body* attracted = body_called("body", law.body, false);
    if (body_called("centre_body", law.centre_body, true) == attracted)
      fail(Error::Kind::Name, "centre_body", law.centre_body,
           "must differ from body: nothing attracts itself");
    vector("centre", law.centre, "m");
    number("strength", law.strength, Limits::Any, "m^(1 + exponent)/s^2");
    if (law.exponent < -kLargestExponent || law.exponent > kLargestExponent)
      fail(Error::Kind::Value, "exponent", std::to_string(law.exponent),
           "must be a whole number from -9 to 9");
  }

  void check_force(const SinusoidalForce& law) const {
    body_called("body", law.body, false);
    vector("amplitude", law.amplitude, "N");
    vector("point", law.point, "m");
    number("angular_frequency", law.angular_frequency, Limits::NonNegative, "rad/s");
    number("phase", law.phase, Limits::Any, "rad");
  }

  void formula(const std::string& field, const std::string& value,
               std::span<const std::string_view> variables) const {
    if (!is_utf8(value) || has_control_character(value))
      fail(Error::Kind::Name, field, printable(value), "must be UTF-8 without control characters");
    try {
      (void)Formula(value, variables);
    } catch (const std::invalid_argument& problem) {
      fail(Error::Kind::Syntax, field, printable(value), std::string("is no formula: it ") + problem.what());
    }
  }

  void check_force(const FormulaForce& law) const {
    body_called("body", law.body, false);
    formula("force[0]", law.x, kForceVariables);
    formula("force[1]", law.y, kForceVariables);
    formula("torque", law.torque, kForceVariables);
    vector("point", law.point, "m");
  }

  void check_force(const FormulaSpring& law) const {
    const Body* a = body_called("body_a", law.body_a, true);
    const Body* b = body_called("body_b", law.body_b, true);
    if (a == b)
      fail(Error::Kind::Name, "body_b", law.body_b, "must differ from body_a: a spring pulls two ends");
    vector("anchor_a", law.anchor_a, "m");
    vector("anchor_b", law.anchor_b, "m");
    formula("tension", law.tension, kSpringVariables);
  }

  void check_path(const Body& body) const {
    if (body.motion.empty()) return;
    if (body.type != BodyType::Kinematic)
      fail(Error::Kind::Value, "motion", "formulas", "must be absent: only a kinematic body has one");
    if (!body.motion.x.empty()) formula("motion.x", body.motion.x, kTimeVariable);
    if (!body.motion.y.empty()) formula("motion.y", body.motion.y, kTimeVariable);
    if (!body.motion.angle.empty()) formula("motion.angle", body.motion.angle, kTimeVariable);
    const PrescribedPath::Point start = PrescribedPath(body).at(0);
    vector("motion at t = 0", start.state.position, "m");
    vector("motion's velocity at t = 0", start.state.velocity, "m/s");
    number("motion's angle at t = 0", start.state.angle, Limits::Any, "rad");
    number("motion's angular velocity at t = 0", start.state.angular_velocity, Limits::Any, "rad/s");
  }

  void check_drive(const Drive& drive) const {
    const auto joint = std::find_if(scene_.joints.begin(), scene_.joints.end(), [&](const Joint& any) {
      return std::visit([&](const auto& j) { return j.name == drive.joint; }, any);
    });
    if (joint == scene_.joints.end()) {
      std::vector<std::string> known;
      for (const Joint& any : scene_.joints)
        known.push_back(std::visit([](const auto& j) { return j.name; }, any));
      fail(Error::Kind::Name, "joint", printable(drive.joint),
           "must be the name of a joint" + did_you_mean(drive.joint, known));
    }
    const bool motor = std::visit(
        [](const auto& j) {
          if constexpr (requires { j.motor; }) return j.motor.has_value();
          return false;
        },
        *joint);
    if (!motor)
      fail(Error::Kind::Value, "joint", printable(drive.joint),
           "must have a motor: the drive sets its speed");
    for (std::size_t other = 0; other < place_.index; ++other) {
      if (scene_.drives[other].joint == drive.joint)
        fail(Error::Kind::Name, "joint", printable(drive.joint), "must have one drive at most");
    }
    formula("speed", drive.speed, kTimeVariable);
  }

  void check_time(double start, double duration) const {
    number("start", start, Limits::NonNegative, "s");
    if (duration != std::numeric_limits<double>::infinity()) {
      number("duration", duration, Limits::NonNegative, "s");
    }
  }

  const Scene& scene_;
  Place& place_;
  std::string prefix_;  ///< prefix of field names of the shape being checked
  Index body_names_, joint_names_;
};

}  // namespace

void check(const Scene& scene, Place& place) { Checker(scene, place).run(); }

void validate(const Scene& scene) {
  Place place;
  check(scene, place);
}

}  // namespace plumb
