#include "engine/world/scene/scene_drives.h"

#include <string>
#include <variant>

namespace plumb {

template <class Real>
SceneDrives<Real>::SceneDrives(const Scene& scene, const SceneParts& parts) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (!scene.bodies[i].motion.empty())
      prescribed_.push_back({i, parts.bodies[i], PrescribedPath(scene.bodies[i])});
  const auto name_of = [](const auto& joint) -> const std::string& { return joint.name; };
  for (const Drive& drive : scene.drives)
    for (std::size_t i = 0; i < scene.joints.size(); ++i)
      if (std::visit(name_of, scene.joints[i]) == drive.joint)
        driven_.push_back({parts.joints[i], Formula(drive.speed, kTimeVariable)});
}

template <class Real>
void SceneDrives<Real>::apply(BasicWorld<Real>& world, double dt) const {
  const double start = world.time(), end = start + dt;
  for (const Prescribed& prescribed : prescribed_) {
    const BodyState target = prescribed.path.at(end).state;
    world.move_towards(prescribed.body, target.position, target.angle, dt);
  }
  for (const Driven& driven : driven_) {
    if (!world.valid(driven.joint)) continue;
    const auto speed = [&](double time) {
      const double now[] = {time};
      return driven.speed.at(std::span<const double>(now));
    };
    JointKind kind = world.kind(driven.joint);
    std::visit(
        [&](auto& joint) {
          if constexpr (requires { joint.motor; })
            joint.motor->speed = (speed(start) + 4 * speed(0.5 * (start + end)) + speed(end)) / 6;
        },
        kind);
    world.change(driven.joint, kind);
  }
}

template <class Real>
void SceneDrives<Real>::read_velocities(double time, std::span<BodyState> states) const {
  for (const Prescribed& prescribed : prescribed_) {
    const BodyState now = prescribed.path.at(time).state;
    states[prescribed.index].velocity = now.velocity;
    states[prescribed.index].angular_velocity = now.angular_velocity;
  }
}

template class SceneDrives<float>;
template class SceneDrives<double>;

}  // namespace plumb
