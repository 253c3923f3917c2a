#include "engine/scene/number.h"

#include <charconv>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "engine/scene/error.h"
#include "engine/scene/scene_fields.h"

namespace plumb {
namespace {

/// Reads a path from left to right.
class Path {
 public:
  explicit Path(std::string_view text) : rest_(text) {}

  bool empty() const { return rest_.empty(); }

  /// Removes a name from the front if the path begins with the whole name.
  bool take(std::string_view name) {
    if (!rest_.starts_with(name)) return false;
    const std::string_view after = rest_.substr(name.size());
    if (!after.empty() && after.front() != '.' && after.front() != '[') return false;
    rest_ = after.starts_with('.') ? after.substr(1) : after;
    return true;
  }

  /// Removes an index in brackets from the front.
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

std::string_view name_of(const Body& body) { return body.name; }
std::string_view name_of(const Joint& joint) {
  return std::visit([](const auto& any) { return std::string_view(any.name); }, joint);
}
std::string_view name_of(const auto&) { return {}; }  // force laws and drives have no names

/// Removes the name or the index of one of `things` from the front of `path`; returns its index. Names may
/// contain dots: if several fit, the longest one counts.
template <class Things>
std::optional<std::size_t> take_entry(Path& path, const Things& things) {
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

/// Collects the numbers that the rest of a path names, from the fields that it visits.
struct Finder {
  Path& path;
  Numbers& found;
  FieldRule rule{};  ///< of the numbers found

  void operator()(std::string_view name, auto&& value, const auto& of_field) {
    if (!found.empty()) return;
    const Path before = path;
    if (path.take(name)) find(value, of_field);
    if (found.empty()) path = before;
  }

 private:
  void find(double& value, const FieldRule& of_number) {
    // Infinity means "none". Derivatives by the times at which a force begins or ends are not supported.
    if (!path.empty() || std::isinf(value) || of_number.unit == std::string_view("s")) return;
    found.push_back(&value);
    rule = of_number;
  }
  void find(Vec2d& value, const FieldRule& of_vector) {
    (*this)("x", value.x, of_vector);
    (*this)("y", value.y, of_vector);
  }
  template <class T>
  void find(std::optional<T>& value, const FieldRule& of_value) {
    if (value) find(*value, of_value);
  }
  template <class T>
  requires std::is_class_v<T>
  void find(T& value, const FieldRule& of_value) { inner_fields(value, of_value, *this); }

  void find(std::vector<Vec2d>& points, const FieldRule& of_points) {
    const auto index = path.take_index();
    if (index && *index < points.size()) find(points[*index], of_points);
  }
  void find(std::vector<Shape>& shapes, const ListRule&) {
    if (const auto index = path.take_index()) {
      if (*index < shapes.size()) all_fields(shapes[*index], *this);
      return;
    }
    Numbers all;
    for (Shape& shape : shapes) {
      Path rest = path;
      Numbers of_shape;
      Finder each{rest, of_shape};
      all_fields(shape, each);
      if (!of_shape.empty()) rule = each.rule;
      all.insert(all.end(), of_shape.begin(), of_shape.end());
    }
    found = std::move(all);
  }
  template <class Part>
  void find(std::vector<Part>& parts, const ListRule&) {
    if (const auto index = take_entry(path, parts)) all_fields(parts[*index], *this);
  }
  void find(auto&, const auto&) {}  // no number
};

}  // namespace

std::vector<double*> numbers_at(Scene& scene, std::string_view path) {
  Path rest(path);
  Numbers found;
  all_fields(scene, Finder{rest, found});
  if (found.empty()) {
    throw Error(Error::Kind::Name, "parameter", "", std::string(path),
                "names no number of the scene; write 'gravity.y', 'bodies.ball.mass', "
                "'bodies.ball.shapes[0].friction', 'joints.rod.length', 'forces[0].stiffness'");
  }
  return found;
}

NumberKind kind_of_number(Scene& scene, std::string_view path) {
  Path rest(path);
  Numbers found;
  Finder finder{rest, found};
  all_fields(scene, finder);
  const std::string_view unit = finder.rule.unit;
  if (finder.rule.limits == Limits::NotZero)
    return NumberKind::Relative;  // a direction, or a ratchet's tooth angle
  if (unit == "m") return NumberKind::Length;
  return unit == "rad" ? NumberKind::Angle : NumberKind::Relative;
}

std::optional<std::size_t> body_of_initial_state(const Scene& scene, std::string_view path) {
  Path rest(path);
  if (!rest.take("bodies")) return std::nullopt;
  const auto body = take_entry(rest, scene.bodies);
  if (!body) return std::nullopt;
  for (const std::string_view field : {"position", "angle", "velocity", "angular_velocity"}) {
    if (rest.take(field)) return body;
  }
  return std::nullopt;
}

}  // namespace plumb
