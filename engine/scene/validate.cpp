#include "engine/scene/validate.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/scene/check.h"
#include "engine/scene/error.h"
#include "engine/scene/names.h"
#include "engine/scene/subject.h"
#include "engine/scene/suggest.h"
#include "engine/scene/text.h"

namespace plumb {
namespace {

/// Which numbers a field takes.
enum class Range { Any, NonNegative, Positive, ZeroToOne };

std::string describe(Range range, const std::string& unit) {
  const std::string of = unit.empty() ? "" : " of " + unit;
  switch (range) {
    case Range::NonNegative:
      return "must be zero or a positive number" + of;
    case Range::Positive:
      return "must be a positive number" + of;
    case Range::ZeroToOne:
      return "must be a number from 0 to 1" + of;
    case Range::Any:
      break;
  }
  return "must be a finite number" + of;
}

bool within(Range range, double value) {
  switch (range) {
    case Range::NonNegative:
      return value >= 0;
    case Range::Positive:
      return value > 0;
    case Range::ZeroToOne:
      return value >= 0 && value <= 1;
    case Range::Any:
      break;
  }
  return true;
}

std::string text_of(Vec2d v) { return "[" + shortest(v.x) + ", " + shortest(v.y) + "]"; }

using Index = std::unordered_map<std::string_view, std::size_t>;

/// Looks at one thing after another and throws at the first that is wrong.
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
      case Place::List::None:
        break;
    }
    return scene_subject(scene_.name);
  }

  void number(const char* field, double value, Range range, const char* unit) const {
    if (!std::isfinite(value) || !within(range, value)) {
      fail(Error::Kind::Value, field, shortest(value), describe(range, unit));
    }
    if (std::abs(value) > kLargest) too_large(field, shortest(value));
    if (range == Range::Positive && value < kSmallest) {
      fail(Error::Kind::Value, field, shortest(value),
           "must be at least " + shortest(kSmallest) + ": products with its reciprocal would overflow");
    }
  }

  [[noreturn]] void too_large(const char* field, std::string value) const {
    fail(Error::Kind::Value, field, std::move(value),
         "must be at most " + shortest(kLargest) + " in magnitude: products of such numbers overflow");
  }

  void vector(const char* field, Vec2d value, const char* unit) const {
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

  /// A name of a body or joint: of its own, not empty.
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
           Range::NonNegative, "m/s");
    member("contact_rules.simultaneous", scene_.contact_rules.simultaneous, kSimultaneousNames);
  }

  void check_body(const Body& body) {
    name(body.name, body_names_);
    if (body.name == kWorld) {
      fail(Error::Kind::Name, "name", body.name, "must be another: joints mean the fixed frame by this name");
    }
    member("type", body.type, kBodyTypeNames);
    vector("position", body.position, "m");
    number("angle", body.angle, Range::Any, "rad");
    check_motion(body);
    const bool dynamic = body.type == BodyType::Dynamic;
    number("mass", body.mass, dynamic ? Range::Positive : Range::NonNegative, "kg");
    if (body.inertia) number("inertia", *body.inertia, Range::Positive, "kg m^2");
    for (std::size_t i = 0; i < body.shapes.size(); ++i) {
      prefix_ = "shapes[" + std::to_string(i) + "].";
      check_shape(body.shapes[i]);
      prefix_.clear();
    }
    if (dynamic && !body.inertia && !body.fixed_rotation && body.shapes.empty()) {
      fail(Error::Kind::Value, "inertia", "absent",
           "must be given in kg m^2 for a dynamic body without shapes, unless fixed_rotation is true");
    }
  }

  void check_motion(const Body& body) const {
    vector("velocity", body.velocity, "m/s");
    number("angular_velocity", body.angular_velocity, Range::Any, "rad/s");
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
    number("angle", shape.angle, Range::Any, "rad");
    number("friction", shape.friction, Range::NonNegative, "");
    number("restitution", shape.restitution, Range::ZeroToOne, "");
  }

  void check_geometry(const Circle& circle) const { number("radius", circle.radius, Range::Positive, "m"); }

  void check_geometry(const Box& box) const {
    number("width", box.width, Range::Positive, "m");
    number("height", box.height, Range::Positive, "m");
  }

  /// The body that `field` names; nullptr for the world where that is allowed.
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
    vector("anchor_a", joint.anchor_a, "m");
    vector("anchor_b", joint.anchor_b, "m");
    check_size(joint);
  }

  void check_size(const RevoluteJoint&) const {}
  void check_size(const DistanceJoint& joint) const { number("length", joint.length, Range::Positive, "m"); }

  void check_force(const LinearDrag& law) const {
    body_called("body", law.body, false);
    number("coefficient", law.coefficient, Range::NonNegative, "N s/m");
  }

  void check_force(const QuadraticDrag& law) const {
    body_called("body", law.body, false);
    number("coefficient", law.coefficient, Range::NonNegative, "N s^2/m^2");
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
    number("torque", law.torque, Range::Any, "N m");
    check_time(law.start, law.duration);
  }

  void check_force(const SpringForce& law) const {
    const Body* a = body_called("body_a", law.body_a, true);
    const Body* b = body_called("body_b", law.body_b, true);
    if (a == b)
      fail(Error::Kind::Name, "body_b", law.body_b, "must differ from body_a: a spring pulls two ends");
    vector("anchor_a", law.anchor_a, "m");
    vector("anchor_b", law.anchor_b, "m");
    number("rest_length", law.rest_length, Range::NonNegative, "m");
    number("stiffness", law.stiffness, Range::NonNegative, "N/m");
    number("damping", law.damping, Range::NonNegative, "N s/m");
  }

  void check_force(const AttractionForce& law) const {
    const Body* attracted = body_called("body", law.body, false);
    if (body_called("centre_body", law.centre_body, true) == attracted)
      fail(Error::Kind::Name, "centre_body", law.centre_body,
           "must differ from body: nothing attracts itself");
    vector("centre", law.centre, "m");
    number("strength", law.strength, Range::Any, "m^(1 + exponent)/s^2");
    if (std::abs(law.exponent) > kLargestExponent)
      fail(Error::Kind::Value, "exponent", std::to_string(law.exponent),
           "must be a whole number from -9 to 9");
  }

  void check_force(const SinusoidalForce& law) const {
    body_called("body", law.body, false);
    vector("amplitude", law.amplitude, "N");
    vector("point", law.point, "m");
    number("angular_frequency", law.angular_frequency, Range::NonNegative, "rad/s");
    number("phase", law.phase, Range::Any, "rad");
  }

  void check_time(double start, double duration) const {
    number("start", start, Range::NonNegative, "s");
    if (duration != std::numeric_limits<double>::infinity()) {
      number("duration", duration, Range::NonNegative, "s");
    }
  }

  const Scene& scene_;
  Place& place_;
  std::string prefix_;  ///< of the fields of the shape that is looked at
  Index body_names_, joint_names_;
};

}  // namespace

void check(const Scene& scene, Place& place) { Checker(scene, place).run(); }

void validate(const Scene& scene) {
  Place place;
  check(scene, place);
}

}  // namespace plumb
