#include "engine/world/solvers/restitution.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/union_find.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_rows.h"
#include "engine/world/contact_solver/impact_propagation.h"
#include "engine/world/contact_solver/impact_round.h"
#include "engine/world/contact_solver/locked_axes.h"
#include "engine/world/islands/hinge_trees.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

// Largest offset of a circle from its body's centre of mass, as a fraction of its radius. A circle with a
// larger offset rotates about that centre, so its normal is not along the line between the bodies.
constexpr double kCentred = 1e-5;

template <class Real>
bool is_centred_circle(const WorldData<Real>& w, int shape) {
  const ShapeForm<Real>& form = w.forms[shape];
  if (form.count != 1 || form.chain) return false;
  const Vec2<Real> centre = w.corners.data()[form.corner].point;
  return std::max(std::abs(centre.x), std::abs(centre.y)) <= Real(kCentred) * form.radius;
}

// Prepares the contact of two separated circles for the time at which they touch: its normal is then the line
// between their centres.
template <class Real>
void predict_circle_normal(const WorldData<Real>& w, const ContactRecord& contact,
                           RestitutionContact<Real>& bounce) {
  ContactConstraint<Real>& c = *bounce.contact;
  if (!enabled(Switch::DiscNormals)) return;
  if (c.count != 1 || !(c.separation[0] > 0) || c.normal_impulse[0] > 0) return;
  if (!is_centred_circle(w, contact.shape_a) || !is_centred_circle(w, contact.shape_b)) return;
  const Real radius_a = w.forms[contact.shape_a].radius, radius_b = w.forms[contact.shape_b].radius;
  bounce.radius_sum = radius_a + radius_b;
  bounce.centre_offset = (w.position[contact.body_b] - w.position[contact.body_a]).template as<Real>();
  // The future contact point, in the middle of the present gap.
  const SolverBody<Real>&a = w.motion[contact.body_a], &b = w.motion[contact.body_b];
  c.arm_tangent_a = -radius_a, c.arm_tangent_b = radius_b;
  const Vec2<Real> t{c.normal.y, -c.normal.x};
  const Real inverse = linear_response(a, b, c.locks, t, t, true) + a.inverse_inertia * radius_a * radius_a +
                       b.inverse_inertia * radius_b * radius_b;
  const bool blocked = !(inverse > least_mobility(a, b, radius_a * radius_a, radius_b * radius_b));
  const Real k_n = c.mass[0] > 0 ? 1 / c.mass[0] - driver_compliance(a, b, c, ContactRow::Normal) : Real(0);
  update_friction_row(a, b, k_n, blocked ? Real(0) : inverse, c);
}

// Collects the joints and the groups of bodies that they connect.
template <class Real>
void collect_joints(WorldData<Real>& w) {
  ImpactScratch<Real>& scratch = w.scratch.solver.impacts;
  scratch.group.clear(), scratch.joints.clear();
  if (w.joint_set.active_count() <= w.scratch.islands.trees.hinge_count) return;
  UnionFind groups(scratch.group, w.bodies.size());
  w.joints.for_each([&](int, const JointRecord& joint) {
    const bool a = w.is_dynamic(joint.body_a), b = w.is_dynamic(joint.body_b);
    if (!joint.active || !(a || b) || in_hinge_tree(w, a ? joint.body_a : joint.body_b)) return;
    scratch.joints.push_back({.a = joint.body_a, .b = joint.body_b, .slot = joint.slot});
    if (a && b) groups.join(joint.body_a, joint.body_b);
  });
  for (int body = 0; body < w.bodies.size(); ++body) scratch.group[body] = groups.find(body);
  scratch.first_joint.assign(scratch.group.size(), -1);
  for (int i = static_cast<int>(scratch.joints.size()) - 1; i >= 0; --i) {
    ImpactJoint& joint = scratch.joints[i];
    int& first = scratch.first_joint[scratch.group[w.is_dynamic(joint.a) ? joint.a : joint.b]];
    joint.next = first, first = i;
  }
}

// Fills in the rows of a joint: rigid rows and reached limits.
template <class Real>
void append_joint_rows(void* world, ImpactJoint& joint) {
  WorldData<Real>& w = *static_cast<WorldData<Real>*>(world);
  ImpactScratch<Real>& scratch = w.scratch.solver.impacts;
  std::vector<JointSolverRow<Real>>& rows = w.scratch.solver.joint_rows;
  joint.first_row = static_cast<int>(scratch.rows.size());
  rows.clear();
  const unsigned locks = locks_of(w, joint.a, joint.b);
  w.joint_set.solver_rows(joint.slot, w.solver_bodies(), rows);
  for (const JointSolverRow<Real>& from : rows) {
    const bool limit = from.role == RowRole::Limit;
    if (from.role != RowRole::Rigid && !(limit && from.row.residual <= 0)) continue;
    BoundedRow row;
    row.linear_a = free_of_a(from.row.linear_a.template as<double>(), locks);
    row.linear_b = free_of_b(from.row.linear_b.template as<double>(), locks);
    row.angular_a = from.row.angular_a, row.angular_b = from.row.angular_b;
    row.upper = std::numeric_limits<double>::infinity();
    row.lower = limit ? 0 : -row.upper;
    scratch.rows.push_back(row);
  }
  joint.rows = static_cast<int>(scratch.rows.size()) - joint.first_row;
  joint.arm = w.joint_set.anchor_arm(joint.slot, w.solver_bodies()).template as<double>();
}

// Returns true if any touching contact has no restitution. Its bodies may not be free after an impact.
template <class Real>
bool any_without_restitution(WorldData<Real>& w) {
  bool any = false;
  w.graph.for_each([&](const ContactConstraint<Real>& c) { any = any || !(c.restitution > 0); });
  return any;
}

// Moves a body after its impact such that its contacts under load stay as closed as without the impact. The
// solver stops a loaded point for the whole substep, including the time before the impact. Suppose that a
// heavy ball pushes a light one against a third ball. If the change of velocity displaced the light ball from
// the time of impact on, it would separate from the third ball and collide again. Keeps the
// displacement along the contact's tangent.
template <class Real>
void keep_closed(WorldData<Real>& w, int body, Real h) {
  ImpactScratch<Real>& scratch = w.scratch.solver.impacts;
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int, const ContactRecord& record) {
    if (record.home != ContactHome::Graph) return;
    ContactConstraint<Real>& c = constraint_of(w, record);
    if (c.restitution > 0) return;
    const ContactPair<Real> pair(w.motion.data(), c);
    const int body_count = static_cast<int>(scratch.displacement.size());
    const auto displacement = [&](int of) {
      return of < body_count ? scratch.displacement[of] : Vec2<Real>{};
    };
    const auto delta_angle = [&](int of) { return of < body_count ? scratch.delta_angle[of] : Real(0); };
    Real opened = 0;
    for (int i = 0; i < c.count; ++i) {
      const Real opens = dot(c.normal, displacement(c.body_b) - displacement(c.body_a)) +
                         c.arm_b[i] * delta_angle(c.body_b) - c.arm_a[i] * delta_angle(c.body_a);
      const bool presses = pair.separation(i) - opens + h * pair.normal_velocity(i) < 0;
      if (presses) opened = std::max(opened, opens);
    }
    if (!(opened > 0)) return;
    const Vec2<Real> back =
        body == c.body_a ? opened * free_of_a(c.normal, c.locks) : -opened * free_of_b(c.normal, c.locks);
    displace(scratch, w.motion[body], w.rotation[body], body, back, Real(0));
  });
}

// Keeps the contacts of displaced bodies closed. Contacts of bodies with joints are left to their islands.
template <class Real>
void keep_closed(WorldData<Real>& w, Real h) {
  if (!enabled(Switch::KeptClosed)) return;
  ImpactScratch<Real>& scratch = w.scratch.solver.impacts;
  const std::size_t count = scratch.has_other_contacts ? scratch.displaced.size() : 0;
  for (std::size_t i = 0; i < count; ++i)
    if (w.bodies[scratch.displaced[i]].first_joint == kNone) keep_closed(w, scratch.displaced[i], h);
}

// Has the joints' rows computed anew, at the present poses.
template <class Real>
void begin_joint_rows(WorldData<Real>& w) {
  ImpactScratch<Real>& scratch = w.scratch.solver.impacts;
  scratch.rows.clear();
  for (ImpactJoint& joint : scratch.joints) joint.rows_ready = false;
  scratch.append_rows = append_joint_rows<Real>, scratch.world = &w;
}

// Begins the impacts of a substep; reuses data of the last substep that have not changed.
template <class Real>
void prepare_impacts(WorldData<Real>& w) {
  ImpactScratch<Real>& scratch = w.scratch.solver.impacts;
  if (!scratch.linked) {
    link_contacts(w.motion.data(), w.scratch.solver.restitution_contacts, scratch);
    scratch.has_other_contacts = any_without_restitution(w);
    scratch.linked = true;
  }
  begin_joint_rows(w);
}

}  // namespace

template <class Real>
bool propagate_impacts(WorldData<Real>& w, const ContactStep<Real>& step) {
  const SolverBodies<Real> bodies = w.solver_bodies();
  ImpactScratch<Real>& scratch = w.scratch.solver.impacts;
  if (!find_impacts(bodies.motion, w.scratch.solver.restitution_contacts, scratch)) return false;
  prepare_impacts(w);
  propagate_impacts(bodies.motion, w.rotation.data(), w.scratch.solver.restitution_contacts, step, scratch);
  keep_closed(w, step.h);
  return true;
}

template <class Real>
void add_impact_loads(WorldData<Real>& w, const JointStep<Real>& step) {
  for (const ImpactJoint& joint : w.scratch.solver.impacts.joints)
    if (joint.impulse != Vec2d{} || joint.moment != 0)
      w.joint_set.add_impulse(joint.slot, joint.impulse.template as<Real>(), static_cast<Real>(joint.moment),
                              step);
}

template void add_impact_loads(WorldData<float>&, const JointStep<float>&);
template void add_impact_loads(WorldData<double>&, const JointStep<double>&);
template bool propagate_impacts(WorldData<float>&, const ContactStep<float>&);
template bool propagate_impacts(WorldData<double>&, const ContactStep<double>&);

template <class Real>
void collect_restitution_contacts(WorldData<Real>& w) {
  w.scratch.solver.restitution_contacts.clear();
  w.scratch.solver.impacts.linked = false;
  for (const int id : w.scratch.narrow_phase.bounce_candidates) {
    const ContactRecord& contact = w.contacts[id];
    if (contact.home != ContactHome::Graph) continue;
    RestitutionContact<Real> bounce{.contact = &constraint_of(w, contact)};
    predict_circle_normal(w, contact, bounce);
    if (bounce.contact->restitution > 0 || bounce.radius_sum > 0)
      w.scratch.solver.restitution_contacts.push_back(bounce);
  }
  w.scratch.solver.impacts.group.clear(), w.scratch.solver.impacts.joints.clear();
  if (!w.scratch.solver.restitution_contacts.empty()) collect_joints(w);
}

template <class Real>
void stop_joint_rates(WorldData<Real>& w) {
  ImpactScratch<Real>& scratch = w.scratch.solver.impacts;
  if (scratch.joints.empty()) return;
  begin_joint_rows(w);
  scratch.visited.assign(scratch.group.size(), 0);
  for (const RestitutionContact<Real>& bounce : w.scratch.solver.restitution_contacts) {
    for (const int body : {bounce.contact->body_a, bounce.contact->body_b}) {
      if (!w.is_dynamic(body) || scratch.visited[scratch.group[body]]) continue;
      scratch.visited[scratch.group[body]] = 1;
      stop_joint_rates(w.motion.data(), w.rotation.data(), scratch.group[body], scratch);
    }
  }
  std::fill(scratch.visited.begin(), scratch.visited.end(), char(0));
}

template void stop_joint_rates(WorldData<float>&);
template void stop_joint_rates(WorldData<double>&);
template void collect_restitution_contacts(WorldData<float>&);
template void collect_restitution_contacts(WorldData<double>&);

}  // namespace plumb
