#include "engine/scene/number.h"

#include <charconv>
#include <type_traits>
#include <utility>

#include "engine/scene/error.h"
#include "engine/scene/joint_fields.h"

namespace plumb {
namespace {

/// Reads a path from left to right.
class Path {
 public:
  explicit Path(std::string_view text) : rest_(text) {}

  bool empty() const { return rest_.empty(); }

  /// Takes a name off the front, if it is there as a whole.
  bool take(std::string_view name) {
    if (!rest_.starts_with(name)) return false;
    const std::string_view after = rest_.substr(name.size());
    if (!after.empty() && after.front() != '.' && after.front() != '[') return false;
    rest_ = after.starts_with('.') ? after.substr(1) : after;
    return true;
  }

  /// Takes an index in brackets off the front.
  std::optional<std::size_t> take_index() {
    const std::size_t end = rest_.find(']');
    if (!rest_.starts_with('[') || end == std::string_view::npos) return std::nullopt;
    std::size_t index = 0;
    const auto read = std::from_chars(rest_.data() + 1, rest_.data() + end, index);
    if (read.ec != std::errc{} || read.ptr != rest_.data() + end) return std::nullopt;
    rest_ = rest_.substr(end + 1);
    if (rest_.starts_with('.')) rest_ = rest_.substr(1);
    return index;
  }

 private:
  std::string_view rest_;
};

using Numbers = std::vector<double*>;

/// Collects the numbers that the rest of a path names in one value of the scene.
struct Finder {
  Path& path;
  Numbers& found;

  void operator()(double& value) {
    if (path.empty()) found.push_back(&value);
  }
  void operator()(Vec2d& value) {
    field("x", value.x);
    field("y", value.y);
  }
  void operator()(Spring& spring) {
    field("hertz", spring.hertz);
    field("damping_ratio", spring.damping_ratio);
  }
  void operator()(Motor& motor) {
    field("speed", motor.speed);
    field("max_force", motor.max_force);
  }
  void operator()(Range& range) {
    field("lower", range.lower);
    field("upper", range.upper);
  }
  template <class T>
  void operator()(std::optional<T>& value) {
    if (value) (*this)(*value);
  }
  void operator()(std::string&) {}  // a formula is no number
  template <class T>
  requires(std::is_same_v<T, bool> || std::is_enum_v<T> || std::is_same_v<T, int>) void operator()(T&) {}

  template <class T>
  void field(std::string_view name, T& value) {
    if (!found.empty()) return;
    const Path before = path;
    if (path.take(name)) (*this)(value);
    if (found.empty()) path = before;
  }
};

void find_in(Finder& find, ContactRules& rules) {
  find.field("restitution_threshold", rules.restitution_threshold);
  find.field("yield_speed", rules.yield_speed);
  find.field("tangential_restitution", rules.tangential_restitution);
  find.field("friction_after_stop", rules.friction_after_stop);
  find.field("friction_while_sliding", rules.friction_while_sliding);
}

void find_in(Finder& find, Shape& shape) {
  find.field("position", shape.position);
  find.field("angle", shape.angle);
  find.field("friction", shape.friction);
  find.field("restitution", shape.restitution);
  std::visit(
      [&](auto& geometry) {
        if constexpr (requires { geometry.radius; }) find.field("radius", geometry.radius);
        if constexpr (requires { geometry.width; }) {
          find.field("width", geometry.width);
          find.field("height", geometry.height);
        }
        if constexpr (requires { geometry.start; }) {
          find.field("start", geometry.start);
          find.field("end", geometry.end);
        }
        if constexpr (requires { geometry.points; }) {
          if (!find.path.take("points")) return;
          const auto index = find.path.take_index();
          if (index && *index < geometry.points.size()) find(geometry.points[*index]);
        }
      },
      shape.geometry);
}

void find_in(Finder& find, Body& body) {
  find.field("position", body.position);
  find.field("angle", body.angle);
  find.field("velocity", body.velocity);
  find.field("angular_velocity", body.angular_velocity);
  find.field("mass", body.mass);
  find.field("inertia", body.inertia);
  find.field("gravity_scale", body.gravity_scale);
  find.field("linear_damping", body.linear_damping);
  find.field("angular_damping", body.angular_damping);
  if (!find.found.empty() || !find.path.take("shapes")) return;
  if (const auto index = find.path.take_index()) {
    if (*index < body.shapes.size()) find_in(find, body.shapes[*index]);
    return;
  }
  Numbers all;
  const Path rest = find.path;
  for (Shape& shape : body.shapes) {
    Path path = rest;
    Numbers of_shape;
    Finder each{path, of_shape};
    find_in(each, shape);
    all.insert(all.end(), of_shape.begin(), of_shape.end());
  }
  find.found = std::move(all);
}

void find_in(Finder& find, Joint& joint) {
  std::visit(
      [&](auto& any) {
        const auto field = [&](std::string_view name, auto& value, const FieldRule&) {
          find.field(name, value);
        };
        anchor_fields(any, field);
        own_fields(any, field);
      },
      joint);
}

void find_in(Finder& find, ForceLaw& force) {
  std::visit(
      [&](auto& law) {
        if constexpr (requires { law.coefficient; }) find.field("coefficient", law.coefficient);
        if constexpr (requires { law.angular_coefficient; })
          find.field("angular_coefficient", law.angular_coefficient);
        if constexpr (requires { law.force; }) find.field("force", law.force);
        if constexpr (requires { law.point; }) find.field("point", law.point);
        if constexpr (requires { law.torque; }) find.field("torque", law.torque);
        if constexpr (requires { law.anchor_a; }) {
          find.field("anchor_a", law.anchor_a);
          find.field("anchor_b", law.anchor_b);
        }
        if constexpr (requires { law.stiffness; }) {
          find.field("rest_length", law.rest_length);
          find.field("stiffness", law.stiffness);
          find.field("damping", law.damping);
        }
        if constexpr (requires { law.centre; }) find.field("centre", law.centre);
        if constexpr (requires { law.strength; }) find.field("strength", law.strength);
        if constexpr (requires { law.amplitude; }) {
          find.field("amplitude", law.amplitude);
          find.field("angular_frequency", law.angular_frequency);
          find.field("phase", law.phase);
        }
      },
      force);
}

/// Takes the name or the index of one of `things` off the front of `path`; returns its index. Names may have
/// dots: of several that fit, the longest is meant.
template <class Things, class NameOf>
std::optional<std::size_t> take_one(Path& path, const Things& things, const NameOf& name_of) {
  if (const auto index = path.take_index()) return *index < things.size() ? index : std::nullopt;
  std::optional<std::size_t> longest;
  for (std::size_t i = 0; i < things.size(); ++i) {
    const std::string_view name = name_of(things[i]);
    if (longest && name.size() <= name_of(things[*longest]).size()) continue;
    if (Path(path).take(name)) longest = i;
  }
  if (longest) path.take(name_of(things[*longest]));
  return longest;
}

std::string_view name_of_body(const Body& body) { return body.name; }
std::string_view name_of_joint(const Joint& joint) {
  return std::visit([](const auto& any) { return std::string_view(any.name); }, joint);
}

bool ends_with_field(std::string_view path, std::string_view field) {
  return path.ends_with(field) &&
         (path.size() == field.size() || path[path.size() - field.size() - 1] == '.');
}

}  // namespace

std::vector<double*> numbers_at(Scene& scene, std::string_view path) {
  Path rest(path);
  Numbers found;
  Finder find{rest, found};
  find.field("gravity", scene.gravity);
  if (found.empty() && rest.take("contact_rules")) {
    find_in(find, scene.contact_rules);
  } else if (found.empty() && rest.take("bodies")) {
    if (const auto body = take_one(rest, scene.bodies, name_of_body)) find_in(find, scene.bodies[*body]);
  } else if (found.empty() && rest.take("joints")) {
    if (const auto joint = take_one(rest, scene.joints, name_of_joint)) find_in(find, scene.joints[*joint]);
  } else if (found.empty() && rest.take("forces")) {
    if (const auto force = rest.take_index(); force && *force < scene.forces.size())
      find_in(find, scene.forces[*force]);
  }
  if (found.empty()) {
    throw Error(Error::Kind::Name, "parameter", "", std::string(path),
                "names no number of the scene; write 'gravity.y', 'bodies.ball.mass', "
                "'bodies.ball.shapes[0].friction', 'joints.rod.length', 'forces[0].stiffness'");
  }
  return found;
}

NumberKind kind_of_number(std::string_view path) {
  for (const std::string_view end : {".x", ".y"}) {
    if (path.ends_with(end)) path.remove_suffix(end.size());
  }
  for (const std::string_view field : {"position", "anchor_a", "anchor_b", "radius", "width", "height",
                                       "start", "end", "length", "rest_length", "centre", "point", "target",
                                       "ground_a", "ground_b", "target_position", "target_translation"}) {
    if (ends_with_field(path, field)) return NumberKind::Length;
  }
  if (path.ends_with(']')) return NumberKind::Length;  // a corner of a polygon
  for (const std::string_view field : {"angle", "reference_angle", "target_angle", "phase"}) {
    if (ends_with_field(path, field)) return NumberKind::Angle;
  }
  return NumberKind::Relative;
}

std::optional<std::size_t> body_of_start(const Scene& scene, std::string_view path) {
  Path rest(path);
  if (!rest.take("bodies")) return std::nullopt;
  const auto body = take_one(rest, scene.bodies, name_of_body);
  if (!body) return std::nullopt;
  for (const std::string_view field : {"position", "angle", "velocity", "angular_velocity"}) {
    if (rest.take(field)) return body;
  }
  return std::nullopt;
}

}  // namespace plumb
