#include "engine/world/past_poses.h"

#include "engine/math/trigonometry.h"
#include "engine/world/world_data.h"

namespace plumb {

template <class Real>
void PastPoses<Real>::keep(const BasicWorld<Real>& world) {
  const WorldData<Real>& data = world.data();
  past_.resize(static_cast<std::size_t>(data.bodies.size()));
  for (int body = 0; body < data.bodies.size(); ++body) {
    past_[body] = {data.position[body], data.bodies[body].angle, data.bodies.generation(body)};
  }
}

/// Returns null for a body that did not exist when the poses were stored.
template <class Real>
auto PastPoses<Real>::find(const WorldData<Real>& data, int body) const -> const Past* {
  if (static_cast<std::size_t>(body) >= past_.size()) return nullptr;
  const Past& past = past_[body];
  return past.generation == data.bodies.generation(body) ? &past : nullptr;
}

template <class Real>
Pose<double> PastPoses<Real>::between(const WorldData<Real>& data, int body, double fraction) const {
  const Rotation<Real> q = data.rotation[body];
  const Pose<double> now{data.position[body], {q.c, q.s}};
  const Past* past = find(data, body);
  if (past == nullptr) return now;
  return {past->position + fraction * (now.position - past->position),
          data.bodies[body].angle == past->angle ? now.rotation
                                                 : rotation_of(angle_between(data, body, fraction))};
}

template <class Real>
double PastPoses<Real>::angle_between(const WorldData<Real>& data, int body, double fraction) const {
  const double now = data.bodies[body].angle;
  const Past* past = find(data, body);
  return past == nullptr ? now : past->angle + fraction * (now - past->angle);
}

template class PastPoses<float>;
template class PastPoses<double>;

}  // namespace plumb
