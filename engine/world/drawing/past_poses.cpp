#include "engine/world/past_poses.h"

#include "engine/math/trigonometry.h"
#include "engine/world/world_data.h"

namespace plumb {

template <class Real>
void PastPoses<Real>::keep(const BasicWorld<Real>& world) {
  const WorldData<Real>& data = world.data();
  stored_.resize(static_cast<std::size_t>(data.bodies.size()));
  for (int body = 0; body < data.bodies.size(); ++body) {
    stored_[body] = {data.position[body], data.bodies[body].angle, data.bodies.generation(body)};
  }
}

/// Returns null for a body that did not exist when the poses were stored.
template <class Real>
auto PastPoses<Real>::find(const WorldData<Real>& data, int body) const -> const Stored* {
  if (static_cast<std::size_t>(body) >= stored_.size()) return nullptr;
  const Stored& stored = stored_[body];
  return stored.generation == data.bodies.generation(body) ? &stored : nullptr;
}

template <class Real>
Pose<double> PastPoses<Real>::between(const WorldData<Real>& data, int body, double fraction) const {
  const Rotation<Real> q = data.rotation[body];
  const Pose<double> now{data.position[body], {q.c, q.s}};
  const Stored* stored = find(data, body);
  if (stored == nullptr) return now;
  return {stored->position + fraction * (now.position - stored->position),
          data.bodies[body].angle == stored->angle ? now.rotation
                                                   : rotation_of(angle_between(data, body, fraction))};
}

template <class Real>
double PastPoses<Real>::angle_between(const WorldData<Real>& data, int body, double fraction) const {
  const double now = data.bodies[body].angle;
  const Stored* stored = find(data, body);
  return stored == nullptr ? now : stored->angle + fraction * (now - stored->angle);
}

template <class Real>
BodyPose PastPoses<Real>::pose_between(const BasicWorld<Real>& world, BodyId body, double fraction) const {
  const Vec2d centre = world.local_point(body, world.centre(body));
  const int index = static_cast<int>(body.index);
  const Pose<double> pose = between(world.data(), index, fraction);
  return {pose.position - pose.rotation * centre, angle_between(world.data(), index, fraction)};
}

template class PastPoses<float>;
template class PastPoses<double>;

}  // namespace plumb
