#include "engine/world/continuous/swept_bodies.h"

#include <variant>

#include "engine/core/capacity.h"
#include "engine/world/continuous/rebound.h"
#include "engine/world/continuous/toi_events.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/shape_boxes.h"

namespace plumb {

template <class Real>
void set_arm(const WorldData<Real>& w, SweptBody& swept) {
  const BodyRecord<Real>& record = w.bodies[swept.body];
  if (record.type != BodyType::Dynamic || swept.delta_angle == 0 || record.lock_x || record.lock_y) return;
  for_each_edge(w.joints, record.first_joint, [&](int edge, const JointRecord& joint) {
    const bool is_a = (edge & 1) == 0;
    if (!joint.active || w.is_dynamic(is_a ? joint.body_b : joint.body_a)) return;
    const auto* hinge = std::get_if<RevoluteDefinition>(&w.joint_set.definition(joint.slot));
    if (hinge != nullptr)
      swept.arm = (is_a ? hinge->anchor_a : hinge->anchor_b) - record.centre.template as<double>();
  });
}

template <class Real>
void insert_swept_aabb(WorldData<Real>& w, SweptBody& swept) {
  const int body = swept.body;
  swept.has_swept_aabb = true;
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (w.shapes[shape].proxy == kNone) continue;
    DynamicTree<Real>& tree = w.tree_of(w.bodies[body].type);
    tree.enlarge(w.shapes[shape].proxy, merged(swept_aabb_of(w, swept), tree.box(w.shapes[shape].proxy)));
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
int swept_body_index(WorldData<Real>& w, int body, double dt) {
  int& index = w.scratch.continuous.swept_index_of[body];
  if (index == kNone) {
    index = static_cast<int>(w.scratch.continuous.swept_bodies.size());
    w.scratch.continuous.swept_bodies.push_back(swept_body_of(w, body, dt));
    set_arm(w, w.scratch.continuous.swept_bodies.back());
    w.scratch.continuous.swept_bodies.back().covered = true;
  }
  return index;
}

#define PLUMB_FOR(Real)                                          \
  template void set_arm(const WorldData<Real>&, SweptBody&);     \
  template void insert_swept_aabb(WorldData<Real>&, SweptBody&); \
  template void restore_fat_aabb(WorldData<Real>&, int, Real);   \
  template int swept_body_index(WorldData<Real>&, int, double);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
