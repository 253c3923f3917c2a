#include "reference/support/range.h"

#include <cmath>
#include <initializer_list>

#include "engine/core/text.h"

namespace plumb::reference {
namespace {

class Checker {
 public:
  explicit Checker(const Range& range) : range_(range) {}

  void at_most(const std::string& who, const char* field, std::initializer_list<double> values) {
    for (const double value : values) {
      if (std::abs(value) > range_.largest) reject(who, field, value);
    }
  }

  void within(const std::string& who, const char* field, std::initializer_list<double> values) {
    for (const double value : values) {
      if (value > range_.largest || value < range_.smallest) reject(who, field, value);
    }
  }

  void inertia(const std::string& who, double value) {
    const double least = range_.smallest_inertia, most = range_.largest_inertia;
    if (value > most || value < least) reject(who, "inertia", value, least, most);
  }

  std::string reason;

 private:
  void reject(const std::string& who, const char* field, double value) {
    reject(who, field, value, range_.smallest, range_.largest);
  }
  void reject(const std::string& who, const char* field, double value, double least, double most) {
    if (!reason.empty()) return;
    reason = who + ": " + field + " " + shortest(value) + " is beyond the range of its arithmetic, " +
             shortest(least) + " to " + shortest(most);
  }

  Range range_;
};

void check(const std::string& who, const Circle& circle, Checker& checker) {
  checker.within(who, "radius", {circle.radius});
}
void check(const std::string& who, const Box& box, Checker& checker) {
  checker.within(who, "box side", {box.width, box.height});
}
void check(const std::string& who, const Capsule& capsule, Checker& checker) {
  checker.within(who, "radius", {capsule.radius});
  checker.at_most(who, "end", {capsule.start.x, capsule.start.y, capsule.end.x, capsule.end.y});
}
void check(const std::string& who, const Segment& segment, Checker& checker) {
  checker.at_most(who, "end", {segment.start.x, segment.start.y, segment.end.x, segment.end.y});
}
void check(const std::string& who, const Polygon& polygon, Checker& checker) {
  checker.at_most(who, "radius", {polygon.radius});
  for (const Vec2d point : polygon.points) checker.at_most(who, "point", {point.x, point.y});
}
void check(const std::string& who, const Chain& chain, Checker& checker) {
  for (const Vec2d point : chain.points) checker.at_most(who, "point", {point.x, point.y});
}

void check(const Body& body, Checker& checker) {
  const std::string who = "body " + plumb::quoted(body.name);
  checker.at_most(who, "position", {body.position.x, body.position.y});
  checker.at_most(who, "angle", {body.angle});
  checker.at_most(who, "velocity", {body.velocity.x, body.velocity.y});
  checker.at_most(who, "angular_velocity", {body.angular_velocity});
  if (body.type == BodyType::Dynamic) {
    checker.within(who, "mass", {body.mass});
    if (!body.fixed_rotation) checker.inertia(who, inertia_of(body));
  }
  for (const Shape& shape : body.shapes) {
    checker.at_most(who, "shape position", {shape.position.x, shape.position.y});
    checker.at_most(who, "friction", {shape.friction});
    std::visit([&](const auto& geometry) { check(who, geometry, checker); }, shape.geometry);
  }
}

void check(const Joint& joint, Checker& checker) {
  std::visit(
      [&](const auto& j) {
        const std::string who = "joint " + plumb::quoted(j.name);
        if constexpr (requires { j.anchor_a; }) checker.at_most(who, "anchor", {j.anchor_a.x, j.anchor_a.y});
        if constexpr (requires { j.anchor_b; }) checker.at_most(who, "anchor", {j.anchor_b.x, j.anchor_b.y});
      },
      joint);
  if (const auto* rod = std::get_if<DistanceJoint>(&joint))
    checker.within("joint " + plumb::quoted(rod->name), "length", {rod->length});
}

}  // namespace

std::string out_of_range(const Scene& scene, const Range& range) {
  Checker checker(range);
  checker.at_most("scene", "gravity", {scene.gravity.x, scene.gravity.y});
  for (const Body& body : scene.bodies) check(body, checker);
  for (const Joint& joint : scene.joints) check(joint, checker);
  return checker.reason;
}

}  // namespace plumb::reference
