#include "engine/scene/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/check.h"
#include "engine/scene/error.h"
#include "engine/scene/formula.h"
#include "engine/scene/prescribed_path.h"
#include "engine/scene/scene_fields.h"
#include "engine/scene/subject.h"

namespace plumb {
namespace {

std::string text_of(Vec2d v) { return "[" + shortest(v.x) + ", " + shortest(v.y) + "]"; }
std::string count_of(const std::vector<Vec2d>& points) { return std::to_string(points.size()) + " points"; }

SceneLocation::List list_of(const std::vector<Body>&) { return SceneLocation::List::Bodies; }
SceneLocation::List list_of(const std::vector<Joint>&) { return SceneLocation::List::Joints; }
SceneLocation::List list_of(const std::vector<ForceLaw>&) { return SceneLocation::List::Forces; }
SceneLocation::List list_of(const std::vector<Drive>&) { return SceneLocation::List::Drives; }

using Index = std::unordered_map<std::string_view, std::size_t>;

/// Checks a scene in order and throws at the first error.
class Checker {
 public:
  Checker(const Scene& scene, SceneLocation& location) : scene_(scene), location_(location) {}

  void run() {
    location_ = {};
    all_fields(scene_, *this);
    location_ = {};
  }

  // Checks a field by its type and rule.
  void operator()(const std::string& field, double value, const FieldRule& rule) {
    if (value == rule.none) return;
    if (!std::isfinite(value) || !within(rule.limits, value)) {
      fail(Error::Kind::Value, field, shortest(value), describe(rule.limits, rule.unit));
    }
    if (std::abs(value) > kLargest) fail_too_large(field, shortest(value));
    const bool either_sign = rule.limits == Limits::NotZero;
    if ((rule.limits == Limits::Positive || either_sign) && std::abs(value) < kSmallest) {
      fail(Error::Kind::Value, field, shortest(value),
           "must be at least " + shortest(kSmallest) + (either_sign ? " in magnitude" : "") +
               ": products with its reciprocal would overflow");
    }
  }
  void operator()(const std::string& field, Vec2d value, const FieldRule& rule) {
    if (!std::isfinite(value.x) || !std::isfinite(value.y)) {
      fail(Error::Kind::Value, field, text_of(value),
           std::string("must be two finite numbers of ") + rule.unit);
    }
    if (std::abs(value.x) > kLargest || std::abs(value.y) > kLargest) fail_too_large(field, text_of(value));
    if (rule.limits == Limits::NotZero && std::max(std::abs(value.x), std::abs(value.y)) < kSmallest)
      fail(Error::Kind::Value, field, text_of(value), "must not be zero: it is a direction");
  }
  void operator()(const std::string&, bool, const FieldRule&) {}
  void operator()(const std::string&, std::uint64_t, const FieldRule&) {}
  void operator()(const std::string& field, std::int32_t value, const WholeRule& rule) {
    if (value < rule.lowest || value > rule.highest)
      fail(Error::Kind::Value, field, std::to_string(value),
           "must be a whole number from " + shortest(rule.lowest) + " to " + shortest(rule.highest));
  }
  template <class Enum>
  void operator()(const std::string& field, Enum value, const ChoiceRule& rule) {
    const auto number = static_cast<int>(value);
    if (number >= 0 && number < static_cast<int>(rule.names.size())) return;
    fail(Error::Kind::Value, field, std::to_string(number), "is no member of its enumeration");
  }

  void operator()(const std::string& field, const std::string& name, const NameRule& rule) {
    if (rule.required && name.empty()) fail(Error::Kind::Name, field, "", "must not be empty");
    if (!is_utf8(name)) fail(Error::Kind::Name, field, printable(name), "must be UTF-8");
    if (has_control_character(name))
      fail(Error::Kind::Name, field, printable(name), "must not contain control characters");
    if (rule.required) check_unique(field, name);
  }
  void operator()(const std::string& field, const std::string& name, const BodyRule& rule) {
    if ((rule.or_world && name == kWorld) || body_names_.contains(name)) return;
    std::vector<std::string> known;
    for (const Body& body : scene_.bodies) known.push_back(body.name);
    if (rule.or_world) known.emplace_back(kWorld);
    const std::string allowed = "must be the name of a body";
    fail(Error::Kind::Name, field, printable(name),
         allowed + (rule.or_world ? " or 'world'" : "") + did_you_mean(name, known));
  }
  void operator()(const std::string& field, const std::string& name, const MotorRule&) {
    const auto joint = std::find_if(scene_.joints.begin(), scene_.joints.end(), [&](const Joint& any) {
      return std::visit([&](const auto& j) { return j.name == name; }, any);
    });
    if (joint == scene_.joints.end()) {
      std::vector<std::string> known;
      for (const Joint& any : scene_.joints)
        known.push_back(std::visit([](const auto& j) { return j.name; }, any));
      fail(Error::Kind::Name, field, printable(name),
           "must be the name of a joint" + did_you_mean(name, known));
    }
    const bool motor = std::visit(
        [](const auto& j) {
          if constexpr (requires { j.motor; }) return j.motor.has_value();
          return false;
        },
        *joint);
    if (!motor)
      fail(Error::Kind::Value, field, printable(name), "must have a motor: the drive sets its speed");
  }

  void operator()(const std::string& field, const std::string& formula, const FormulaRule& rule) {
    if (rule.or_none && formula.empty()) return;
    if (!is_utf8(formula) || has_control_character(formula))
      fail(Error::Kind::Name, field, printable(formula), "must be UTF-8 without control characters");
    try {
      (void)Formula(formula, rule.variables);
    } catch (const std::invalid_argument& problem) {
      fail(Error::Kind::Syntax, field, printable(formula),
           std::string("is not a formula: it ") + problem.what());
    }
  }
  void operator()(const std::string& field, std::tuple<const std::string&, const std::string&> formulas,
                  const FormulaRule& rule) {
    (*this)(field + "[0]", std::get<0>(formulas), rule);
    (*this)(field + "[1]", std::get<1>(formulas), rule);
  }

  void operator()(const std::string& field, const std::vector<Vec2d>& points, const FieldRule& rule) {
    for (std::size_t i = 0; i < points.size(); ++i)
      (*this)(field + "[" + std::to_string(i) + "]", points[i], rule);
  }
  template <class T>
  void operator()(const std::string& field, const std::optional<T>& value, const FieldRule& rule) {
    if (value) (*this)(field, *value, rule);
  }
  template <class T>
  void operator()(const std::string& field, const T& value, const FieldRule& rule) {
    const std::string outer = prefix_;
    prefix_ += field + ".";
    inner_fields(value, rule, *this);
    check_consistency(value);
    prefix_ = outer;
  }

  void operator()(const std::string& field, const std::vector<Shape>& shapes, const ListRule&) {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      prefix_ = field + "[" + std::to_string(i) + "].";
      all_fields(shapes[i], *this);
      std::visit([&](const auto& geometry) { check_consistency(geometry); }, shapes[i].geometry);
      prefix_.clear();
    }
  }
  template <class Part>
  void operator()(const std::string&, const std::vector<Part>& parts, const ListRule&) {
    for (location_ = {list_of(parts), 0}; location_.index < parts.size(); ++location_.index) {
      all_fields(parts[location_.index], *this);
      check_consistency(parts[location_.index]);
    }
  }

 private:
  [[noreturn]] void fail(Error::Kind kind, const std::string& field, std::string value,
                         std::string problem) const {
    throw Error(kind, subject(), prefix_ + field, std::move(value), std::move(problem));
  }

  std::string subject() const {
    switch (location_.list) {
      case SceneLocation::List::Bodies:
        return body_subject(location_.index, scene_.bodies[location_.index].name);
      case SceneLocation::List::Joints:
        return std::visit([this](const auto& joint) { return joint_subject(location_.index, joint.name); },
                          scene_.joints[location_.index]);
      case SceneLocation::List::Forces: {
        const ForceLaw& law = scene_.forces[location_.index];
        return force_subject(location_.index, kForceNames[law.index()], ends_of(law)[0]);
      }
      case SceneLocation::List::Drives:
        return drive_subject(location_.index);
      case SceneLocation::List::None:
        break;
    }
    return scene_subject(scene_.name);
  }

  [[noreturn]] void fail_too_large(const std::string& field, std::string value) const {
    fail(Error::Kind::Value, field, std::move(value),
         "must be at most " + shortest(kLargest) + " in magnitude: products of such numbers overflow");
  }

  void check_unique(const std::string& field, const std::string& name) {
    const bool body = location_.list == SceneLocation::List::Bodies;
    const auto [other, is_new] = (body ? body_names_ : joint_names_).try_emplace(name, location_.index);
    if (!is_new) {
      fail(Error::Kind::Name, field, printable(name),
           std::string("must be unique: ") + (body ? "body " : "joint ") + std::to_string(other->second) +
               " has this name too (counted from 0)");
    }
    if (body && name == kWorld)
      fail(Error::Kind::Name, field, name, "must be another: joints mean the fixed frame by this name");
  }

  // Checks conditions that involve several fields of a part.

  template <class... Kinds>
  void check_consistency(const std::variant<Kinds...>& part) {
    std::visit([&](const auto& kind) { check_consistency(kind); }, part);
  }

  void check_consistency(const Body& body) {
    check_motion(body);
    check_path(body);
    if (body.type == BodyType::Dynamic) check_mass(body);
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
    const auto has_mass = [](const Shape& shape) {
      return shape.density.value_or(1) > 0 && extent_of(shape.geometry).area > 0;
    };
    if (body.shapes.empty()) {
      fail(Error::Kind::Value, "inertia", "absent",
           "must be given in kg m^2 for a dynamic body without shapes, unless fixed_rotation is true");
    }
    if (std::none_of(body.shapes.begin(), body.shapes.end(), has_mass)) {
      fail(Error::Kind::Value, "inertia", "absent",
           "must be given in kg m^2 for a dynamic body whose shapes weigh nothing, unless fixed_rotation is "
           "true");
    }
  }

  void check_motion(const Body& body) const {
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

  void check_path(const Body& body) {
    if (body.motion.empty()) return;
    if (body.type != BodyType::Kinematic)
      fail(Error::Kind::Value, "motion", "formulas", "must be absent: only a kinematic body has one");
    const BodyState start = PrescribedPath(body).at(0).state;
    (*this)("motion at t = 0", start.position, FieldRule{Limits::Any, "m"});
    (*this)("motion's velocity at t = 0", start.velocity, FieldRule{Limits::Any, "m/s"});
    (*this)("motion's angle at t = 0", start.angle, FieldRule{Limits::Any, "rad"});
    (*this)("motion's angular velocity at t = 0", start.angular_velocity, FieldRule{Limits::Any, "rad/s"});
  }

  void check_consistency(const Polygon& polygon) {
    require_count(3, polygon.points, "");
    if (!(extent_of(polygon).area > 0))
      fail(Error::Kind::Value, "points", count_of(polygon.points),
           "must not lie on a line: a polygon has an area");
  }

  void check_consistency(const Segment& segment) {
    if (segment.start == segment.end)
      fail(Error::Kind::Value, "end", text_of(segment.end), "must differ from start: a segment has a length");
  }

  void check_consistency(const Chain& chain) {
    require_count(2, chain.points, "");
    if (chain.closed) require_count(3, chain.points, " when closed");
    for (std::size_t i = 0; i < chain.points.size(); ++i) {
      const bool last = i + 1 == chain.points.size();
      const std::size_t next = last ? 0 : i + 1;
      if ((last && !chain.closed) || chain.points[i] != chain.points[next]) continue;
      fail(Error::Kind::Value, "points[" + std::to_string(next) + "]", text_of(chain.points[next]),
           "must differ from the point before it");
    }
  }

  void require_count(std::size_t count, const std::vector<Vec2d>& points, const std::string& when) const {
    if (points.size() < count)
      fail(Error::Kind::Value, "points", count_of(points),
           "must be " + std::to_string(count) + " or more" + when);
  }

  void check_consistency(const Range& range) {
    if (!(range.lower <= range.upper))
      fail(Error::Kind::Value, "upper", shortest(range.upper),
           "must be at least the lower bound, " + shortest(range.lower));
  }

  void check_consistency(const Drive& drive) {
    for (std::size_t other = 0; other < location_.index; ++other) {
      if (scene_.drives[other].joint == drive.joint)
        fail(Error::Kind::Name, "joint", printable(drive.joint), "must have one drive at most");
    }
  }

  void check_consistency(const AttractionForce& law) {
    if (law.centre_body == law.body)
      fail(Error::Kind::Name, "centre_body", law.centre_body,
           "must differ from body: nothing attracts itself");
  }

  /// Checks the two ends of joints and springs.
  void check_consistency(const auto& part) {
    if constexpr (requires { part.body_a; }) {
      const bool joint = requires { part.collide; };
      if (part.body_a == part.body_b) {
        fail(Error::Kind::Name, "body_b", part.body_b,
             std::string("must differ from body_a: ") +
                 (joint ? "a joint holds two bodies together" : "a spring pulls two ends"));
      }
      if (joint && !is_dynamic(part.body_a) && !is_dynamic(part.body_b)) {
        fail(
            Error::Kind::Name, "body_b", part.body_b,
            "must be dynamic when " + quoted(part.body_a) + " is not: a joint has to have something to hold");
      }
    }
  }

  bool is_dynamic(const std::string& name) const {
    return name != kWorld && scene_.bodies[body_names_.at(name)].type == BodyType::Dynamic;
  }

  const Scene& scene_;
  SceneLocation& location_;
  std::string prefix_;  ///< prefix of the names of fields: "shapes[1]."
  Index body_names_, joint_names_;
};

}  // namespace

void check(const Scene& scene, SceneLocation& location) { Checker(scene, location).run(); }

void validate(const Scene& scene) {
  SceneLocation location;
  check(scene, location);
}

}  // namespace plumb
