#include "engine/scene/prescribed_path.h"

#include <string>

namespace plumb {
namespace {

std::optional<Formula> compiled(const std::string& text) {
  if (text.empty()) return std::nullopt;
  return Formula(text, kTimeVariable);
}

}  // namespace

PrescribedPath::PrescribedPath(const Body& body)
    : x_(compiled(body.motion.x)),
      y_(compiled(body.motion.y)),
      angle_(compiled(body.motion.angle)),
      start_{body.position, body.angle, body.velocity, body.angular_velocity} {}

PrescribedPath::Point PrescribedPath::at(double t) const {
  const Jet now[] = {{t, 1}};
  const auto coordinate = [&](const std::optional<Formula>& formula, double start, double speed) {
    return formula ? formula->at(std::span<const Jet>(now)) : Jet{start + t * speed, speed};
  };
  const Jet x = coordinate(x_, start_.position.x, start_.velocity.x),
            y = coordinate(y_, start_.position.y, start_.velocity.y),
            angle = coordinate(angle_, start_.angle, start_.angular_velocity);
  return {
      {{x.value, y.value}, angle.value, {x.first, y.first}, angle.first}, {x.second, y.second}, angle.second};
}

}  // namespace plumb
