#include "engine/realtime/contact_solver.h"

#include <algorithm>
#include <cmath>

#include "engine/realtime/constants.h"

namespace plumb {
namespace {

/// The velocities of a contact's two bodies during an iteration.
template <class Real>
struct Pair {
  Twist<Real> a, b;
};

template <class Real>
void push(const Contact<Real>& contact, const ContactPoint<Real>& point, Vec2<Real> impulse,
          Pair<Real>& pair) {
  pair.a.velocity -= contact.inverse_mass_a * impulse;
  pair.a.angular_velocity -= contact.inverse_inertia_a * cross(point.arm_a, impulse);
  pair.b.velocity += contact.inverse_mass_b * impulse;
  pair.b.angular_velocity += contact.inverse_inertia_b * cross(point.arm_b, impulse);
}

template <class Real>
Vec2<Real> along(const Contact<Real>& contact, ContactImpulse<Real> impulse) {
  return impulse.normal * contact.normal + impulse.friction * perpendicular(contact.normal);
}

/// Runs one iteration: friction, then the normal, which matters more and is therefore solved last. `changing`
/// selects the impulse to change. `before` gives the impulses of earlier passes of this substep, so that the
/// laws hold for the sum.
template <class Real, class Changing, class Before>
void sweep(std::vector<Contact<Real>>& contacts, const std::vector<int>& active, Bodies<Real>& bodies,
           bool friction, Changing changing, Before before) {
  for (const int index : active) {
    Contact<Real>& contact = contacts[index];
    Pair<Real> pair{bodies.twist[contact.a], bodies.twist[contact.b]};
    if (friction && contact.friction > 0) {
      const Vec2<Real> tangent = perpendicular(contact.normal);
      for (int i = 0; i < contact.count; ++i) {
        ContactPoint<Real>& point = contact.points[i];
        if (!point.in_pass) continue;
        ContactImpulse<Real>& impulse = changing(point);
        const ContactImpulse<Real> earlier = before(point);
        // |P_t| <= mu P_n, and P_t -= v_t / (J M^-1 J^T). After subtraction P_n may be below 0 by rounding,
        // and std::clamp needs ordered bounds.
        const Real limit = contact.friction * (impulse.normal + earlier.normal);
        const Real speed = dot(relative_velocity(point, pair.a, pair.b), tangent);
        const Real wanted = impulse.friction + earlier.friction - point.tangent_mass * speed;
        const Real total = std::min(std::max(wanted, -limit), limit);
        const Real change = (total - earlier.friction) - impulse.friction;
        impulse.friction += change;
        push(contact, point, change * tangent, pair);
      }
    }
    for (int i = 0; i < contact.count; ++i) {
      ContactPoint<Real>& point = contact.points[i];
      if (!point.in_pass) continue;
      ContactImpulse<Real>& impulse = changing(point);
      // P_n >= 0, and P_n -= (v_n - bound) / (J M^-1 J^T)
      const Real speed = dot(relative_velocity(point, pair.a, pair.b), contact.normal);
      const Real wanted = impulse.normal - point.normal_mass * (speed - point.lower_bound);
      const Real change = std::max(wanted, -before(point).normal) - impulse.normal;
      impulse.normal += change;
      push(contact, point, change * contact.normal, pair);
    }
    bodies.twist[contact.a] = pair.a;
    bodies.twist[contact.b] = pair.b;
  }
}

template <class Real>
void warm_start(const Contact<Real>& contact, const ContactPoint<Real>& point, ContactImpulse<Real> guess,
                Bodies<Real>& bodies) {
  Pair<Real> pair{bodies.twist[contact.a], bodies.twist[contact.b]};
  push(contact, point, along(contact, guess), pair);
  bodies.twist[contact.a] = pair.a;
  bodies.twist[contact.b] = pair.b;
}

/// Returns the normal velocity that just closes the gap within the substep. Between shapes that pressed on
/// each other already, a gap is an error of this method. It closes gently, so that rest does not turn into
/// small falls.
template <class Real>
Real bound_of(const ContactPoint<Real>& point, bool pressed, Real h) {
  if (point.separation <= 0) return 0;
  return (pressed ? Real(constants::kGapClosing) : Real{1}) * -point.separation / h;
}

template <class Real>
void forget_impulses(Contact<Real>& contact) {
  for (ContactPoint<Real>& point : contact.points) point.hold = point.relax = {};
}

}  // namespace

template <class Real>
Real ContactSolver<Real>::impact_speed(const Contact<Real>& contact, const Bodies<Real>& bodies,
                                       Real h) const {
  const Vec2<Real> pressing =
      bodies.acceleration[contact.b].velocity - bodies.acceleration[contact.a].velocity;
  const Real kick = std::max(settings_.gravity, std::abs(dot(pressing, contact.normal))) * h;
  return std::max(settings_.restitution_threshold, Real(constants::kRestingKicks) * kick);
}

/// Returns true if the pair touches in this substep with a speed above that of resting bodies.
template <class Real>
bool ContactSolver<Real>::meets(const Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const {
  const Real threshold = impact_speed(contact, bodies, h);
  for (int i = 0; i < contact.count; ++i) {
    const ContactPoint<Real>& point = contact.points[i];
    const Real speed =
        dot(relative_velocity(point, bodies.twist[contact.a], bodies.twist[contact.b]), contact.normal);
    if (-speed > threshold && point.separation + h * speed < 0) return true;
  }
  return false;
}

/// Returns true if an impact with restitution is due or was just missed. The impact stage resolves it, now or
/// in the next substep: the passes would remove the velocity that is to bounce.
template <class Real>
bool ContactSolver<Real>::bounces(const Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const {
  if (!settings_.two_passes || !(contact.restitution > 0)) return false;
  for (const ContactPoint<Real>& point : contact.points)
    if (point.hold.normal + point.relax.normal > 0) return false;  // it rests
  const Real threshold = impact_speed(contact, bodies, h);
  for (int i = 0; i < contact.count; ++i) {
    const Vec2<Real> relative =
        relative_velocity(contact.points[i], bodies.twist[contact.a], bodies.twist[contact.b]);
    if (-dot(relative, contact.normal) > threshold) return true;
  }
  return false;
}

namespace {

/// Sets normal and arms of round shapes to those at their time of contact, and the separation to the
/// displacement left along that normal. Returns false if they pass each other.
template <class Real>
bool look_ahead(Contact<Real>& contact, std::span<const SolidShape<Real>> shapes, const Bodies<Real>& bodies,
                Real h) {
  Contact<Real> then = contact;
  const Real t = time_of_contact(then, 0, shapes, bodies, Real{0}, h);
  contact.placed = false;
  if (t > h) return false;
  const Vec2<Real> relative =
      relative_velocity(then.points[0], bodies.twist[contact.a], bodies.twist[contact.b]);
  contact = then;
  contact.points[0].separation = -dot(relative, then.normal) * t;
  contact.placed = false;
  return true;
}

}  // namespace

template <class Real>
void ContactSolver<Real>::begin_hold(std::vector<Contact<Real>>& contacts,
                                     std::span<const SolidShape<Real>> shapes, Bodies<Real>& bodies, Real h) {
  active_.clear();
  for (std::size_t index = 0; index < contacts.size(); ++index) {
    Contact<Real>& contact = contacts[index];
    if (contact.impact) forget_impulses(contact);  // impulses of an impact do not warm-start
    contact.impact = false;
    if (contact.count == 0 || contact.bounced) continue;
    if (!contact.placed) follow(contact, shapes, bodies.pose[contact.a], bodies.pose[contact.b]);
    if (bounces(contact, bodies, h)) {
      forget_impulses(contact);
      continue;
    }
    contact.impact = meets(contact, bodies, h);
    if (contact.impact && !contact.two_boxes && contact.points[0].separation > 0 &&
        !look_ahead(contact, shapes, bodies, h)) {
      forget_impulses(contact);
      contact.impact = false;
      continue;
    }
    weigh(contact);
    if (admit(contact, bodies, h)) active_.push_back(static_cast<int>(index));
  }
  for (const int index : active_)
    for (const ContactPoint<Real>& point : contacts[index].points)
      if (point.in_pass) warm_start(contacts[index], point, point.hold, bodies);
}

/// Selects the contact's points of the hold pass, with their bounds and initial impulses. At rest both passes
/// of a substep, and those of the next, have the same impulse: half the weight each.
template <class Real>
bool ContactSolver<Real>::admit(Contact<Real>& contact, const Bodies<Real>& bodies, Real h) const {
  bool any = false;
  for (ContactPoint<Real>& point : contact.points) point.in_pass = false;
  for (int i = 0; i < contact.count; ++i) {
    ContactPoint<Real>& point = contact.points[i];
    const Vec2<Real> relative = relative_velocity(point, bodies.twist[contact.a], bodies.twist[contact.b]);
    const Real approach = Real(constants::kApproachReserve) * h * std::sqrt(length_squared(relative));
    point.in_pass = point.separation < Real(constants::kContactMargin) * contact.reach + approach;
    const bool pressed = point.hold.normal + point.relax.normal > 0;
    point.lower_bound = bound_of(point, pressed, h);
    if (settings_.two_passes) point.hold = point.relax;
    if (!point.in_pass || !(point.hold.normal > 0)) point.hold = {};
    any = any || point.in_pass;
  }
  return any;
}

template <class Real>
void ContactSolver<Real>::sweep_hold(std::vector<Contact<Real>>& contacts, Bodies<Real>& bodies) {
  sweep(
      contacts, active_, bodies, settings_.friction,
      [](ContactPoint<Real>& point) -> ContactImpulse<Real>& { return point.hold; },
      [](const ContactPoint<Real>&) { return ContactImpulse<Real>{}; });
}

template <class Real>
void ContactSolver<Real>::begin_relax(std::vector<Contact<Real>>& contacts,
                                      std::span<const SolidShape<Real>> shapes, Bodies<Real>& bodies,
                                      Real h) {
  active_.clear();
  for (std::size_t index = 0; index < contacts.size(); ++index) {
    Contact<Real>& contact = contacts[index];
    if (contact.count == 0) continue;
    // After an impact in this substep, round shapes separate along the normal of the impact.
    if (contact.two_boxes || !contact.impact) {
      follow(contact, shapes, bodies.pose[contact.a], bodies.pose[contact.b]);
      weigh(contact);
    }
    if (contact.bounced) forget_impulses(contact);
    contact.bounced = false;
    const bool leave = bounces(contact, bodies, h);
    bool active = false;
    for (int i = 0; i < contact.count; ++i) {
      ContactPoint<Real>& point = contact.points[i];
      point.in_pass = !leave && (point.hold.normal > 0 || point.separation <= 0);
      active = active || point.in_pass;
      point.relax = point.in_pass && !contact.impact ? point.hold : ContactImpulse<Real>{};
      point.lower_bound = 0;
    }
    if (active) active_.push_back(static_cast<int>(index));
  }
  for (const int index : active_)
    for (int i = 0; i < contacts[index].count; ++i)
      if (contacts[index].points[i].in_pass)
        warm_start(contacts[index], contacts[index].points[i], contacts[index].points[i].relax, bodies);
}

template <class Real>
void ContactSolver<Real>::sweep_relax(std::vector<Contact<Real>>& contacts, Bodies<Real>& bodies) {
  sweep(
      contacts, active_, bodies, settings_.friction,
      [](ContactPoint<Real>& point) -> ContactImpulse<Real>& { return point.relax; },
      [](const ContactPoint<Real>& point) { return point.hold; });
}

template <class Real>
void ContactSolver<Real>::begin_collide(std::vector<Contact<Real>>& contacts,
                                        std::span<const SolidShape<Real>> shapes, Bodies<Real>& bodies,
                                        Real h, bool restitution) {
  for (Contact<Real>& contact : contacts) contact.placed = false;
  begin_hold(contacts, shapes, bodies, h);
  for (const int index : active_) {
    Contact<Real>& contact = contacts[index];
    if (!restitution || !contact.impact || !(contact.restitution > 0)) continue;
    for (int i = 0; i < contact.count; ++i) {
      ContactPoint<Real>& point = contact.points[i];
      const Real speed =
          dot(relative_velocity(point, bodies.twist[contact.a], bodies.twist[contact.b]), contact.normal);
      if (point.separation + h * speed < 0)
        point.lower_bound = std::max(point.lower_bound, -contact.restitution * speed);
    }
  }
}

template <class Real>
bool ContactSolver<Real>::push_out(std::vector<Contact<Real>>& contacts,
                                   std::span<const SolidShape<Real>> shapes, Bodies<Real>& bodies,
                                   Real h) const {
  bool pushed = false;
  for (const int index : active_) {
    Contact<Real>& contact = contacts[index];
    if (contact.impact) continue;  // separated, or about to separate
    follow(contact, shapes, bodies.pose[contact.a], bodies.pose[contact.b]);
    const Real most = Real(constants::kPushSpeed) * contact.reach * h;
    for (int i = 0; i < contact.count; ++i) {
      const ContactPoint<Real>& point = contact.points[i];
      if (!point.in_pass || !(point.separation < 0)) continue;
      const Real way = std::min(Real(constants::kPushOut) * -point.separation, most);
      const Vec2<Real> push = (way * point.normal_mass) * contact.normal;
      bodies.move(contact.a, -push, -cross(point.arm_a, push));
      bodies.move(contact.b, push, cross(point.arm_b, push));
      pushed = true;
    }
  }
  for (Contact<Real>& contact : contacts) contact.placed = false;
  return pushed;
}

template class ContactSolver<float>;
template class ContactSolver<double>;

}  // namespace plumb
