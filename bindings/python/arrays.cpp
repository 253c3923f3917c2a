#include "bindings/python/arrays.h"

#include <algorithm>
#include <limits>

#include "engine/world/world_data.h"

namespace plumb::python {

template <class Real>
void write_poses(const BasicWorld<Real>& world, double* to) {
  const WorldData<Real>& data = world.data();
  const BodyRecord<Real>* records = std::get<0>(data.bodies.parts()).data();
  const Rotation<Real>* rotation = data.rotation.data();
  const Vec2d* position = data.position.data();
  const int count = data.bodies.size();
  for (int body = 0; body < count; ++body, to += 3) {
    const Vec2d origin = position[body] - (rotation[body] * records[body].centre).template as<double>();
    to[0] = origin.x, to[1] = origin.y, to[2] = records[body].angle;
  }
  if (data.bodies.count() == count) return;
  to -= 3 * std::ptrdiff_t{count};
  for (int body = 0; body < count; ++body) {
    if (!data.bodies.used(body)) std::fill_n(to + 3 * body, 3, std::numeric_limits<double>::quiet_NaN());
  }
}

template void write_poses(const World&, double*);
template void write_poses(const DoubleWorld&, double*);

}  // namespace plumb::python
