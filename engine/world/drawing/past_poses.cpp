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

template <class Real>
Pose<double> PastPoses<Real>::between(const WorldData<Real>& data, int body, double fraction) const {
  const Rotation<Real> q = data.rotation[body];
  const Pose<double> now{data.position[body], {q.c, q.s}};
  if (static_cast<std::size_t>(body) >= past_.size()) return now;
  const Past& past = past_[body];
  if (past.generation != data.bodies.generation(body)) return now;
  const double turned = data.bodies[body].angle - past.angle;
  return {past.position + fraction * (now.position - past.position),
          turned == 0 ? now.rotation : rotation_of(past.angle + fraction * turned)};
}

template class PastPoses<float>;
template class PastPoses<double>;

}  // namespace plumb
