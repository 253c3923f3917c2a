#include "engine/world/state/contact_setup.h"

#include <algorithm>
#include <string>

#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/internal_edges.h"

namespace plumb {
namespace {

// Computes arms and effective masses. r x t = -(r . n) for t = (n.y, -n.x).
template <class Real>
void prepare_rows(const SolverBody<Real>& a, const SolverBody<Real>& b, const Vec2<Real>* arms_a,
                  Vec2<Real> a_to_b, ContactConstraint<Real>& c) {
  const Vec2<Real> n = c.normal, t{n.y, -n.x};
  const Real along_n = linear_response(a, b, c.locks, n, n, true),
             along_t = linear_response(a, b, c.locks, t, t, true);
  const auto coupling = [&](Real linear, Real la, Real lb, Real ma, Real mb) {
    return linear + a.inverse_inertia * la * ma + b.inverse_inertia * lb * mb;
  };
  const auto inverse = [](Real k) { return k > 0 ? 1 / k : Real(0); };
  const auto mobility = [&](Real linear, Real la, Real lb, Vec2<Real> arm_a) {
    const Real k = coupling(linear, la, lb, la, lb);
    return k > least_mobility(a, b, length_squared(arm_a), length_squared(arm_a - a_to_b)) ? k : Real(0);
  };
  const Vec2<Real> deeper = arms_a[c.count == 2 && c.separation[1] < c.separation[0] ? 1 : 0];
  c.arm_tangent_a = -dot(deeper, n), c.arm_tangent_b = -dot(deeper - a_to_b, n);
  for (int i = 0; i < c.count; ++i)
    c.arm_a[i] = cross(arms_a[i], n), c.arm_b[i] = cross(arms_a[i] - a_to_b, n);
  const Real compliance = driver_compliance(a, b, c, ContactRow::Normal);
  Real k[2] = {}, rigid_k_n = 0;  // the latter of the first point, without compliance
  for (int i = 0; i < c.count; ++i) {
    k[i] = mobility(along_n, c.arm_a[i], c.arm_b[i], arms_a[i]);
    if (i == 0) rigid_k_n = k[0];
    if (k[i] > 0) k[i] += compliance;
    c.mass[i] = inverse(k[i]);
  }
  if (c.count == 2) {
    c.k_pq = coupling(along_n, c.arm_a[0], c.arm_b[0], c.arm_a[1], c.arm_b[1]);
    const Real determinant = k[0] * k[1] - c.k_pq * c.k_pq;
    // Points that nearly coincide share their load.
    const bool apart = determinant > Real(1e-3) * k[0] * k[1];
    const Real d = apart ? 1 / determinant : Real(0);
    c.inverse_pp = apart ? d * k[1] : Real(0.5) * c.mass[0];
    c.inverse_qq = apart ? d * k[0] : Real(0.5) * c.mass[1];
    c.inverse_pq = -d * c.k_pq;
  } else {
    c.arm_a[1] = c.arm_b[1] = c.mass[1] = c.k_pq = c.inverse_pq = c.inverse_qq = 0;
    c.inverse_pp = c.mass[0];
  }
  update_friction_row(a, b, rigid_k_n, mobility(along_t, c.arm_tangent_a, c.arm_tangent_b, deeper), c);
}

// Returns kPinned if one body only rotates, as both its axes are locked, and the other may drive it.
template <class Real>
unsigned pin_of(const WorldData<Real>& w, const ContactRecord& contact, const ContactConstraint<Real>& c) {
  const auto is_pinned = [&](int body) {
    const BodyRecord<Real>& record = w.bodies[body];
    return w.is_dynamic(body) && record.lock_x && record.lock_y && !record.lock_rotation;
  };
  const auto drives = [&](int body) {
    return c.surface_speed != 0 || w.bodies[body].type == BodyType::Kinematic;
  };
  const bool driven = (is_pinned(contact.body_a) && drives(contact.body_b)) ||
                      (is_pinned(contact.body_b) && drives(contact.body_a));
  return driven ? kPinned : 0u;
}

// Calls a user's combine rule; throws if its result is not a valid coefficient.
// The caller has locked the world: a step, or setting a material.
double call_combine_rule(CombineFunction rule, double a, double b, const char* what, double maximum) {
  const double result = rule(a, b);
  if (result >= 0 && result <= maximum) return result;
  throw Error(Error::Kind::Value, "combine rule", what, shortest(result),
              "must be in [0, " + shortest(maximum) + "] for " + shortest(a) + " and " + shortest(b));
}

}  // namespace

template <class Real>
Real restitution_between(const WorldData<Real>& w, int shape_a, int shape_b) {
  const ShapeRecord<Real>&a = w.shapes[shape_a], &b = w.shapes[shape_b];
  return static_cast<Real>(
      w.restitution_rule == nullptr
          ? combine(w.settings.combine_restitution, a.restitution, b.restitution)
          : call_combine_rule(w.restitution_rule, a.restitution, b.restitution, "restitution", 1));
}

template <class Real>
void mix_materials(const WorldData<Real>& w, const ContactRecord& contact, ContactConstraint<Real>& c) {
  const ShapeRecord<Real>&a = w.shapes[contact.shape_a], &b = w.shapes[contact.shape_b];
  const ShapeForm<Real>&form_a = w.forms[contact.shape_a], &form_b = w.forms[contact.shape_b];
  c.friction =
      static_cast<Real>(w.friction_rule == nullptr
                            ? combine(w.settings.combine_friction, a.friction, b.friction)
                            : call_combine_rule(w.friction_rule, a.friction, b.friction, "friction", 1e9));
  c.restitution = restitution_between(w, contact.shape_a, contact.shape_b);
  const Real radius = std::max(form_a.radius, form_b.radius);
  c.rolling_arm = static_cast<Real>(std::max(a.rolling_resistance, b.rolling_resistance)) * radius;
  c.surface_speed = static_cast<Real>(a.surface_speed + b.surface_speed);
  c.depenetration_speed = Real(tuning::kDepenetrationSpeed) * std::min(form_a.extent, form_b.extent);
  c.tracking = tracking_of(contact, c);
  c.hardness = w.is_dynamic(contact.body_a) && w.is_dynamic(contact.body_b) ? ContactHardness::Soft
                                                                            : ContactHardness::Stiff;
}

template <class Real>
ContactManifold<Real> manifold_of(const WorldData<Real>& w, const ContactRecord& contact, Real margin) {
  const int a = contact.body_a, b = contact.body_b;
  const Rotation<Real> to_a = w.rotation[a].inverse();
  const Vec2<Real> a_to_b = (w.position[b] - w.position[a]).template as<Real>();
  const Rotation<Real> q = w.rotation[b];
  const Pose<Real> b_in_a{to_a * a_to_b, {to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s}};
  return collide_shapes(w, contact, b_in_a, margin);
}

template <class Real>
void prepare_contact(const WorldData<Real>& w, const ContactRecord& contact,
                     const ContactManifold<Real>& manifold, Rotation<Real> q, Vec2<Real> a_to_b,
                     ContactConstraint<Real>& c, Real (&impulse)[2]) {
  const Real old[2] = {c.normal_impulse[0], c.normal_impulse[1]};
  const Real expected[2] = {c.load_estimate[0], c.load_estimate[1]};
  const std::uint16_t features[2] = {c.features[0], c.features[1]};
  const int old_count = c.count;
  c.normal = q * manifold.normal;
  c.count = static_cast<std::uint8_t>(manifold.count);
  Vec2<Real> arms_a[2];
  bool kept = false;
  for (int i = 0; i < 2; ++i) {
    impulse[i] = c.load_estimate[i] = c.separation[i] = c.approach[i] = c.max_normal_impulse[i] = 0;
    c.features[i] = 0;
    if (i >= manifold.count) continue;
    const ContactManifoldPoint<Real>& from = manifold.points[i];
    for (int j = 0; j < old_count; ++j) {
      if (features[j] != from.feature) continue;
      impulse[i] = old[j], c.load_estimate[i] = expected[j];
      kept = true;
    }
    arms_a[i] = q * from.point;
    c.separation[i] = from.separation;
    c.features[i] = from.feature;
  }
  if (!kept) c.tangent_impulse = c.rolling_impulse = 0;
  c.locks = static_cast<std::uint8_t>(locks_of(w, contact.body_a, contact.body_b) | pin_of(w, contact, c));
  prepare_rows(w.motion[contact.body_a], w.motion[contact.body_b], arms_a, a_to_b, c);
  const Real smaller = std::min(w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent);
  // The masses of locked axes change as the normal turns.
  c.recycle_budget = contact.pre_solve || c.locks != 0 ? Real(-1) : Real(tuning::kRecycleDistance) * smaller;
}

template <class Real>
void prepare_contact(const WorldData<Real>& w, const ContactRecord& contact,
                     const ContactManifold<Real>& manifold, Rotation<Real> q, Vec2<Real> a_to_b,
                     ContactConstraint<Real>& c) {
  Real impulse[2];
  prepare_contact(w, contact, manifold, q, a_to_b, c, impulse);
  c.normal_impulse[0] = impulse[0], c.normal_impulse[1] = impulse[1];
}

template <class Real>
ContactConstraint<Real> constraint_between(const WorldData<Real>& w, const ContactRecord& contact) {
  const Real smaller = std::min(w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent);
  const ContactManifold<Real> manifold = manifold_of(w, contact, Real(tuning::kSpeculativeMargin) * smaller);
  ContactConstraint<Real> c;
  c.body_a = contact.body_a, c.body_b = contact.body_b, c.contact = kNone;
  mix_materials(w, contact, c);
  prepare_contact(w, contact, manifold, c);
  return c;
}

template <class Real>
bool may_touch_now(const WorldData<Real>& w, int shape_a, int shape_b) {
  const ContactRecord contact = contact_of(w, shape_a, shape_b);
  const Real smaller = std::min(w.forms[shape_a].extent, w.forms[shape_b].extent);
  const Real margin = Real(tuning::kSpeculativeMargin) * smaller;
  return !aabbs_apart(w, shape_a, shape_b, margin) && manifold_of(w, contact, margin).count > 0;
}

#define PLUMB_FOR(Real)                                                                                     \
  template Real restitution_between(const WorldData<Real>&, int, int);                                      \
  template void mix_materials(const WorldData<Real>&, const ContactRecord&, ContactConstraint<Real>&);      \
  template ContactManifold<Real> manifold_of(const WorldData<Real>&, const ContactRecord&, Real);           \
  template void prepare_contact(const WorldData<Real>&, const ContactRecord&, const ContactManifold<Real>&, \
                                Rotation<Real>, Vec2<Real>, ContactConstraint<Real>&);                      \
  template void prepare_contact(const WorldData<Real>&, const ContactRecord&, const ContactManifold<Real>&, \
                                Rotation<Real>, Vec2<Real>, ContactConstraint<Real>&, Real(&)[2]);          \
  template ContactConstraint<Real> constraint_between(const WorldData<Real>&, const ContactRecord&);        \
  template bool may_touch_now(const WorldData<Real>&, int, int);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
