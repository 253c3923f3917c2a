#include "reference/support/plain_scene.h"

#include <variant>

#include "engine/core/text.h"
#include "engine/math/trigonometry.h"

namespace plumb::reference {
namespace {

std::string not_plain(const RevoluteJoint& joint) {
  return joint.limits || joint.motor || joint.spring ? "limits, motors and springs of hinges are not mapped"
                                                     : "";
}
std::string not_plain(const DistanceJoint& joint) {
  return joint.range || joint.motor || joint.spring ? "ranges, motors and springs of rods are not mapped"
                                                    : "";
}
template <class Other>
std::string not_plain(const Other& joint) {
  return "joint " + plumb::quoted(joint.name) + " is neither a hinge nor a rod";
}

}  // namespace

std::string not_plain_joints(const Scene& scene) {
  for (const Joint& joint : scene.joints)
    if (std::string reason = std::visit([](const auto& j) { return not_plain(j); }, joint); !reason.empty())
      return reason;
  return "";
}

std::string not_circles_and_boxes(const Body& body) {
  for (const Shape& shape : body.shapes)
    if (!std::holds_alternative<Circle>(shape.geometry) && !std::holds_alternative<Box>(shape.geometry))
      return "body " + plumb::quoted(body.name) + ": shapes but circles and boxes are not mapped";
  return "";
}

Vec2d anchor_in_world(const Scene& scene, const std::string& name, Vec2d anchor) {
  const auto index = find_body(scene, name);
  if (!index) return anchor;
  const Body& body = scene.bodies[*index];
  return body.position + rotation_of(body.angle) * anchor;
}

}  // namespace plumb::reference
