#include "engine/core/capacity.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_passes.h"
#include "engine/world/state/bodies.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/mass.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/sleeping.h"

#include <algorithm>
#include <cassert>

namespace plumb {
namespace {

// Scales the impulses of the contacts at a joint's bodies by `fraction`: what balanced a load together with
// the joint's. What pressed against the joint alone would throw the bodies apart when it is gone.
template <class Real>
void keep_balanced_impulses(WorldData<Real>& w, const JointRecord& record, Real fraction) {
  if (fraction == 1 || !enabled(Switch::BalancedBreaks)) return;
  for (const int body : {record.body_a, record.body_b}) {
    if (!w.is_dynamic(body)) continue;
    for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int, const ContactRecord& contact) {
      if (contact.home == ContactHome::Graph) scale_impulses(constraint_of(w, contact), fraction);
    });
  }
}

template <class Real>
void erase_joint(WorldData<Real>& w, int joint) {
  const JointRecord record = w.joints[joint];
  w.topology_changed = true;
  const Real balanced = static_cast<Real>(w.joint_set.warm_start_fraction(record.slot));
  w.joint_set.remove(record.slot);  // the only call that may run out of memory
  keep_balanced_impulses(w, record, balanced);
  unlink_edges(w, w.joints, joint, &BodyRecord<Real>::first_joint);
  if (!has_quarantined_body(w, record))
    --w.bodies[record.body_a].constraints, --w.bodies[record.body_b].constraints;
  std::erase(w.load_limited_joints, joint);
  w.joints.remove(joint);
}

// Reserves memory for the end events of the contacts between two bodies.
template <class Real>
void reserve_end_events(WorldData<Real>& w, int body_a, int body_b) {
  std::size_t contacts = 0;
  for_each_edge(w.contacts, w.bodies[body_a].first_contact, [&](int, const ContactRecord& contact) {
    contacts += contact.body_a == body_b || contact.body_b == body_b ? 1 : 0;
  });
  ensure_capacity(w.event_buffer().end, w.event_buffer().end.size() + contacts);
}

}  // namespace

template <class Real>
int add_joint(WorldData<Real>& w, int body_a, int body_b, const JointDefinition& definition) {
  assert(w.bodies.used(body_a) && w.bodies.used(body_b));
  // First do everything that may reject the definition or run out of memory.
  const bool limited = definition.break_force > 0 || definition.break_torque > 0 ||
                       definition.report_force > 0 || definition.report_torque > 0;
  w.joints.reserve_more(1);
  ensure_capacity(w.load_limited_joints, w.load_limited_joints.size() + (limited ? 1 : 0));
  if (!definition.collide) reserve_end_events(w, body_a, body_b);
  w.topology_changed = true;  // before the joints' lists grow, which may fail halfway
  const int slot =
      w.joint_set.add(definition.kind, body_a, body_b, w.bodies[body_a].centre, w.bodies[body_b].centre,
                      w.is_dynamic(body_a), w.is_dynamic(body_b), w.solver_bodies());
  w.joint_set.set_initial_angles(slot, w.bodies[body_a].angle, w.bodies[body_b].angle);
  JointRecord record;
  record.body_a = body_a, record.body_b = body_b;
  record.slot = slot;
  record.collide = definition.collide;
  record.active = w.joint_set.active(slot);
  record.break_force = definition.break_force, record.break_torque = definition.break_torque;
  record.report_force = definition.report_force, record.report_torque = definition.report_torque;
  record.user_data = definition.user_data;
  const int joint = w.joints.add(record);
  link_edges(w, w.joints, joint, &BodyRecord<Real>::first_joint);
  if (limited) w.load_limited_joints.push_back(joint);
  try {
    if (has_quarantined_body(w, record)) {
      w.joint_set.set_active(slot, false);
      w.joints[joint].active = false;
    } else {
      ++w.bodies[body_a].constraints, ++w.bodies[body_b].constraints;
    }
    wake_body(w, body_a), wake_body(w, body_b);
  } catch (...) {
    erase_joint(w, joint);
    throw;
  }
  if (definition.collide) return joint;
  for_each_edge(w.contacts, w.bodies[body_a].first_contact, [&](int edge, const ContactRecord& contact) {
    if (contact.body_a == body_b || contact.body_b == body_b) destroy_contact(w, edge / 2);
  });
  return joint;
}

template <class Real>
void remove_joint(WorldData<Real>& w, int joint) {
  assert(w.joints.used(joint));
  const JointRecord record = w.joints[joint];
  wake_body(w, record.body_a), wake_body(w, record.body_b);
  erase_joint(w, joint);
  if (record.collide) return;
  // Shapes that the joint kept from colliding need pairs again.
  const int body = w.bodies[record.body_a].type == BodyType::Static ? record.body_b : record.body_a;
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    add_to_move_buffer(w, shape);
  }
}

template <class Real>
void set_load_events(WorldData<Real>& w, int joint, double force, double torque) {
  JointRecord& record = w.joints[joint];
  const auto place = std::find(w.load_limited_joints.begin(), w.load_limited_joints.end(), joint);
  const bool limited = record.break_force > 0 || record.break_torque > 0 || force > 0 || torque > 0;
  if (limited && place == w.load_limited_joints.end()) append(w.load_limited_joints, joint);
  if (!limited && place != w.load_limited_joints.end()) w.load_limited_joints.erase(place);
  record.report_force = force, record.report_torque = torque;
}

template <class Real>
JointStiffness stiffness_of(const WorldData<Real>& w, int joint) {
  const JointRecord& record = w.joints[joint];
  // Mass changes may still be pending: reading does not apply them.
  const auto centre_of = [&w](int body) { return w.bodies[body].centre + centre_of_mass_shift(w, body); };
  const auto add = [&w](int body, Real& inverse_mass, Real& inverse_inertia) {
    if (own_type(w, body) != BodyType::Dynamic) return;
    const BodyRecord<Real>& of = w.bodies[body];
    const MassProperties mass =
        has_mass_change(w, body)
            ? current_mass(w, body)
            : MassProperties{static_cast<double>(of.mass), {}, static_cast<double>(of.inertia)};
    inverse_mass = inverse_mass_of(of, mass.mass);
    if (!of.lock_rotation && mass.inertia > 0) inverse_inertia = static_cast<Real>(1 / mass.inertia);
  };
  PairMobility<Real> bodies;
  add(record.body_a, bodies.m_a, bodies.i_a);
  add(record.body_b, bodies.m_b, bodies.i_b);
  return w.joint_set.stiffness(record.slot, centre_of(record.body_a), centre_of(record.body_b), bodies);
}

#define PLUMB_FOR(Real)                                                       \
  template int add_joint(WorldData<Real>&, int, int, const JointDefinition&); \
  template void remove_joint(WorldData<Real>&, int);                          \
  template JointStiffness stiffness_of(const WorldData<Real>&, int);          \
  template void set_load_events(WorldData<Real>&, int, double, double);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
