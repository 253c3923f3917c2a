#include <algorithm>

#include "engine/collision/distance/distance.h"
#include "engine/core/capacity.h"
#include "engine/world/state/bodies.h"
#include "engine/world/state/contacts.h"
#include "engine/world/step/step.h"

namespace plumb {
namespace {

template <class Real>
ShapeId id_of(const WorldData<Real>& w, int shape) {
  return {static_cast<std::uint32_t>(shape), w.shapes.generation(shape)};
}

template <class Real>
bool overlap(const WorldData<Real>& w, int a, int b) {
  const int body_a = w.shapes[a].body, body_b = w.shapes[b].body;
  const Rotation<Real> to_a = w.rotation[body_a].inverse(), q = w.rotation[body_b];
  const Vec2<Real> a_to_b = (w.position[body_b] - w.position[body_a]).template as<Real>();
  const Pose<Real> b_in_a{to_a * a_to_b, {to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s}};
  return distance(w.convex(a), w.convex(b), b_in_a).distance <= 0;
}

constexpr bool is_less(const ShapeId& a, const ShapeId& b) {
  return a.index != b.index ? a.index < b.index : a.generation < b.generation;
}

}  // namespace

template <class Real>
void update_sensors(WorldData<Real>& w) {
  for (SensorRecord& sensor : w.sensors) {
    std::vector<ShapeId>& visitors = w.scratch.visitors;
    visitors.clear();
    const int shape = sensor.shape, body = w.shapes[shape].body;
    const auto visit = [&](int other, int) {
      const bool seen = w.shapes[other].body != body && !w.forms[other].sensor &&
                        may_touch(w.shapes[shape].filter, w.shapes[other].filter) && overlap(w, shape, other);
      if (seen) visitors.push_back(id_of(w, other));
      return true;
    };
    const bool senses = !w.bodies[body].quarantined;
    if (senses) w.dynamic_tree.query(w.tight_aabbs[shape], effective_mask(w.shapes[shape].filter), visit);
    if (senses && w.bodies[body].type != BodyType::Static) {
      w.static_tree.query(w.tight_aabbs[shape], effective_mask(w.shapes[shape].filter), visit);
    }
    std::sort(visitors.begin(), visitors.end(), is_less);
    // Reserve first, so that events and visitors stay consistent if memory runs out.
    Events& out = w.event_buffer();
    ensure_capacity(sensor.visitors, visitors.size());
    ensure_capacity(out.sensor_begin, out.sensor_begin.size() + visitors.size());
    ensure_capacity(out.sensor_end, out.sensor_end.size() + sensor.visitors.size());
    const ShapeId id = id_of(w, shape);
    for (const ShapeId& visitor : visitors) {
      if (!std::binary_search(sensor.visitors.begin(), sensor.visitors.end(), visitor, is_less)) {
        out.sensor_begin.push_back({id, visitor});
      }
    }
    for (const ShapeId& visitor : sensor.visitors) {
      if (!std::binary_search(visitors.begin(), visitors.end(), visitor, is_less)) {
        out.sensor_end.push_back({id, visitor});
      }
    }
    sensor.visitors.assign(visitors.begin(), visitors.end());
  }
}

template <class Real>
void end_overlaps(WorldData<Real>& w, int shape) {
  const auto sensor = std::find_if(w.sensors.begin(), w.sensors.end(),
                                   [&](const SensorRecord& each) { return each.shape == shape; });
  std::vector<SensorEvent>& out = w.event_buffer().sensor_end;
  ensure_capacity(out, out.size() + sensor->visitors.size());
  for (const ShapeId& visitor : sensor->visitors) out.push_back({id_of(w, shape), visitor});
  w.sensors.erase(sensor);
}

template void end_overlaps(WorldData<float>&, int);
template void end_overlaps(WorldData<double>&, int);
template void update_sensors(WorldData<float>&);
template void update_sensors(WorldData<double>&);

}  // namespace plumb
