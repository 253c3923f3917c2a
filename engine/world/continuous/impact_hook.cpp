#include "engine/world/continuous/impact_hook.h"

#include "engine/collision/distance/hull_distance.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/shape_boxes.h"

namespace plumb {
namespace {

// Moves a body to its state at a fraction of the step, for what the hook reads of it, and back to the step's
// end when it is destroyed: the hook may throw.
template <class Real>
class StateAt {
 public:
  StateAt(WorldData<Real>& w, const SweptBody* swept, double fraction) : w_(w) {
    if (swept == nullptr) return;
    body_ = swept->body, position_ = w.position[body_], rotation_ = w.rotation[body_];
    SolverBody<Real>& motion = w.motion[body_];
    angle_ = w.bodies[body_].angle, velocity_ = motion.velocity, spin_ = motion.angular_velocity;
    const Rotation<double> q = swept->rotation_at(fraction);
    w.position[body_] = swept->position_at(fraction);
    w.rotation[body_] = {static_cast<Real>(q.c), static_cast<Real>(q.s)};
    w.bodies[body_].angle += swept->delta_angle_before +
                             swept->elapsed_fraction(fraction) * swept->delta_angle -
                             static_cast<double>(motion.delta_angle);
    motion.velocity = swept->velocity_at(fraction).template as<Real>();
    motion.angular_velocity = static_cast<Real>(swept->angular_velocity);
    update_tight_aabbs();
  }
  ~StateAt() {
    if (body_ == kNone) return;
    w_.position[body_] = position_, w_.rotation[body_] = rotation_, w_.bodies[body_].angle = angle_;
    w_.motion[body_].velocity = velocity_, w_.motion[body_].angular_velocity = spin_;
    update_tight_aabbs();
  }
  StateAt(const StateAt&) = delete;
  StateAt& operator=(const StateAt&) = delete;

 private:
  void update_tight_aabbs() {
    for (int shape = w_.bodies[body_].first_shape; shape != kNone; shape = w_.shapes[shape].next)
      w_.tight_aabbs[shape] = tight_aabb(w_, shape);
  }

  WorldData<Real>& w_;
  int body_ = kNone;
  Vec2d position_{};
  Rotation<Real> rotation_{};
  double angle_ = 0;
  Vec2<Real> velocity_{};
  Real spin_ = 0;
};

template <class Real>
bool has_solver_contact(const WorldData<Real>& w, const ContactRecord& sought) {
  return any_between(w.contacts, w.bodies[sought.body_a].first_contact, w.bodies[sought.body_b].first_contact,
                     sought.body_a, sought.body_b, [&](const ContactRecord& contact) {
                       return contact.shape_a == sought.shape_a && contact.shape_b == sought.shape_b &&
                              contact.home == ContactHome::Graph;
                     });
}

// Returns the contact of two shapes at the bodies' present poses. A manifold may have no points where a chain
// gives them to a neighbouring segment; then the nearest points count.
template <class Real>
ContactConstraint<Real> contact_now(const WorldData<Real>& w, const ContactRecord& contact) {
  ContactConstraint<Real> c = constraint_between(w, contact);
  const int body_a = contact.body_a, body_b = contact.body_b;
  if (c.count == 0) {
    const auto rotation = [&](int body) -> Rotation<double> {
      return {static_cast<double>(w.rotation[body].c), static_cast<double>(w.rotation[body].s)};
    };
    const Convex<Real> a = w.convex(contact.shape_a), b = w.convex(contact.shape_b);
    const Rotation<double> to_a = rotation(body_a).inverse(), q = rotation(body_b);
    const HullDistance nearest = hull_distance(a, b,
                                               {to_a * (w.position[body_b] - w.position[body_a]),
                                                {to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s}},
                                               nullptr);
    const double separation =
        nearest.separation - static_cast<double>(a.radius) - static_cast<double>(b.radius);
    ContactManifold<Real> manifold;
    manifold.normal = nearest.normal.template as<Real>(), manifold.count = 1;
    manifold.points[0] = {
        (nearest.point_a + (static_cast<double>(a.radius) + 0.5 * separation) * nearest.normal)
            .template as<Real>(),
        static_cast<Real>(separation), 0};
    prepare_contact(w, contact, manifold, c);
  }
  const Vec2<Real> velocity = w.motion[body_b].velocity - w.motion[body_a].velocity;
  for (int i = 0; i < c.count; ++i)
    c.approach[i] = dot(c.normal, velocity) + c.arm_b[i] * w.motion[body_b].angular_velocity -
                    c.arm_a[i] * w.motion[body_a].angular_velocity;
  return c;
}

}  // namespace

template <class Real>
bool is_disabled_impact(WorldData<Real>& w, const SweptBody& a, int shape, const SweptBody* b, int other,
                        double fraction) {
  if (!w.pre_solve || !(w.shapes[shape].pre_solve || w.shapes[other].pre_solve)) return false;
  if (is_disabled_pair(w, shape, other)) return true;
  PairSet& enabled = w.enabled_pairs;
  if (enabled.size() > 0 && enabled.contains(shape, other)) return false;
  const ContactRecord contact = contact_of(w, shape, other);
  if (has_solver_contact(w, contact)) return false;
  const StateAt<Real> state_a(w, &a, fraction), state_b(w, b, fraction);
  const bool disabled = !w.pre_solve(contact, contact_now(w, contact));
  (disabled ? w.disabled_pairs : enabled).insert(shape, other);
  return disabled;
}

template bool is_disabled_impact(WorldData<float>&, const SweptBody&, int, const SweptBody*, int, double);
template bool is_disabled_impact(WorldData<double>&, const SweptBody&, int, const SweptBody*, int, double);

}  // namespace plumb
