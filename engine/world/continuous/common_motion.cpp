#include "engine/world/continuous/common_motion.h"

#include "engine/world/state/contacts.h"

namespace plumb {

template <class Real>
bool is_held_by_joint(const WorldData<Real>& w, int body) {
  return any_edge(w.joints, w.bodies[body].first_joint, [&](const JointRecord& joint) {
    return joint.active && !(w.is_dynamic(joint.body_a) && w.is_dynamic(joint.body_b));
  });
}

template <class Real>
bool may_move_together(const WorldData<Real>& w, const std::vector<int>& indices) {
  for (const int index : indices) {
    const SweptBody& swept = w.scratch.continuous.swept_bodies[index];
    if (!w.is_dynamic(swept.body) || (swept.changed && swept.group == kNone)) return false;
    if (is_held_by_joint(w, swept.body)) return false;
  }
  return true;
}

template <class Real>
void move_together(WorldData<Real>& w, const std::vector<int>& indices, double fraction) {
  std::vector<SweptBody>& swept_bodies = w.scratch.continuous.swept_bodies;
  double mass = 0;
  Vec2d centre{}, displacement{};  // m, of the common centre of mass
  const Vec2d origin = swept_bodies[indices.front()].position_at(fraction);
  BodyLocks locks;
  for (const int index : indices) {
    const SweptBody& swept = swept_bodies[index];
    const BodyRecord<Real>& record = w.bodies[swept.body];
    const double own = static_cast<double>(record.mass);
    const Vec2d start = swept.position_at(fraction);
    mass += own, centre += own * (start - origin), displacement += own * (swept.position_at(1) - start);
    locks.x = locks.x || record.lock_x, locks.y = locks.y || record.lock_y;
    locks.rotation = locks.rotation || record.lock_rotation;
  }
  centre = origin + (1 / mass) * centre, displacement = (1 / mass) * displacement;
  double inertia = 0, momentum = 0;  // kg m^2; kg m^2 rad, angular momentum times the time left
  for (const int index : indices) {
    const SweptBody& swept = swept_bodies[index];
    const BodyRecord<Real>& record = w.bodies[swept.body];
    const double own = static_cast<double>(record.mass), own_inertia = static_cast<double>(record.inertia);
    const Vec2d start = swept.position_at(fraction), arm = start - centre;
    inertia += own_inertia + own * dot(arm, arm);
    momentum += own_inertia * (1 - swept.elapsed_fraction(fraction)) * swept.delta_angle +
                own * cross(arm, swept.position_at(1) - start - displacement);
  }
  SweptBody common;
  common.from = fraction, common.start = centre, common.displacement = displacement;
  if (locks.x) common.displacement.x = 0;
  if (locks.y) common.displacement.y = 0;
  // A body with a locked axis cannot move on an arc.
  if (inertia > 0 && !locks.x && !locks.y && !locks.rotation) common.delta_angle = momentum / inertia;
  for (const int index : indices) {
    swept_bodies[index].continue_pushed(common, fraction, {});
    swept_bodies[index].group = indices.front();
  }
}

#define PLUMB_FOR(Real)                                                             \
  template bool is_held_by_joint(const WorldData<Real>&, int);                      \
  template bool may_move_together(const WorldData<Real>&, const std::vector<int>&); \
  template void move_together(WorldData<Real>&, const std::vector<int>&, double);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
