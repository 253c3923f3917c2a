#include "engine/world/continuous/swept_bodies.h"

#include <variant>

#include "engine/core/room.h"
#include "engine/world/continuous/rebound.h"
#include "engine/world/continuous/toi_events.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/shape_boxes.h"

namespace plumb {

template <class Real>
void set_arm(const WorldData<Real>& w, SweptBody& flight) {
  const BodyRecord<Real>& record = w.bodies[flight.body];
  if (record.type != BodyType::Dynamic || flight.turn == 0 || record.lock_x || record.lock_y) return;
  for_each_edge(w.joints, record.first_joint, [&](int edge, const JointRecord& joint) {
    const bool is_a = (edge & 1) == 0;
    if (!joint.active || w.is_dynamic(is_a ? joint.body_b : joint.body_a)) return;
    const auto* hinge = std::get_if<RevoluteDefinition>(&w.joint_set.definition(joint.slot));
    if (hinge != nullptr)
      flight.arm = (is_a ? hinge->anchor_a : hinge->anchor_b) - record.centre.template as<double>();
  });
}

template <class Real>
void insert_swept_aabb(WorldData<Real>& w, SweptBody& flight) {
  const int body = flight.body;
  flight.shown = true;
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (w.shapes[shape].proxy == kNone) continue;
    DynamicTree<Real>& tree = w.tree_of(w.bodies[body].type);
    tree.enlarge(w.shapes[shape].proxy, merged(way_of(w, flight), tree.box(w.shapes[shape].proxy)));
  }
}

template <class Real>
void restore_fat_aabb(WorldData<Real>& w, int body, Real dt) {
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (w.shapes[shape].proxy == kNone) continue;
    w.tree_of(w.bodies[body].type).enlarge(w.shapes[shape].proxy, fat_aabb(w, shape, dt));
    w.enlarged[body] = 1;
    if (!w.shapes[shape].moved) append(w.move_buffer, shape);
    w.shapes[shape].moved = true;
  }
}

template <class Real>
int flight_place(WorldData<Real>& w, int body, double dt) {
  int& place = w.scratch.swept_body_places[body];
  if (place == kNone) {
    place = static_cast<int>(w.scratch.swept_bodies.size());
    w.scratch.swept_bodies.push_back(flight_of(w, body, dt));
    set_arm(w, w.scratch.swept_bodies.back());
    w.scratch.swept_bodies.back().covered = true;
  }
  return place;
}

#define PLUMB_FOR(Real)                                          \
  template void set_arm(const WorldData<Real>&, SweptBody&);     \
  template void insert_swept_aabb(WorldData<Real>&, SweptBody&); \
  template void restore_fat_aabb(WorldData<Real>&, int, Real);   \
  template int flight_place(WorldData<Real>&, int, double);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
