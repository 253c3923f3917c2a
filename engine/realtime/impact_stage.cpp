#include "engine/realtime/impact_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/realtime/constants.h"
#include "engine/realtime/impact.h"

namespace plumb {

template <class Real>
struct ImpactStage<Real>::Call {
  std::vector<Contact<Real>>& contacts;
  std::span<const SolidShape<Real>> shapes;
  Bodies<Real>& bodies;
  const ContactSolver<Real>& solver;
  JointMethod<Real>* joints;
  Real h;
};

template <class Real>
void ImpactStage<Real>::index(const std::vector<Contact<Real>>& contacts, std::size_t bodies) {
  first_.assign(bodies + 1, 0);
  contact_of_.resize(2 * contacts.size());
  for (const Contact<Real>& contact : contacts) ++first_[contact.a + 1], ++first_[contact.b + 1];
  for (std::size_t body = 0; body < bodies; ++body) first_[body + 1] += first_[body];
  for (std::size_t i = contacts.size(); i-- > 0;)
    for (const int body : {contacts[i].a, contacts[i].b})
      contact_of_[--first_[body + 1]] = static_cast<int>(i);
  // Counting down left the start of each list one place too far right.
  for (std::size_t body = 0; body < bodies; ++body) first_[body] = first_[body + 1];
  first_[bodies] = static_cast<int>(contact_of_.size());
  version_.resize(contacts.size(), 0);
  jump_.resize(bodies);
}

template <class Real>
auto ImpactStage<Real>::allowance_of(const std::vector<Contact<Real>>& contacts) -> Allowance {
  const auto count = static_cast<std::int64_t>(contacts.size());
  return {constants::kImpactsAtLeast + constants::kImpactsPerContact * count,
          constants::kImpactsAtOnce + constants::kImpactsAtOnceEach * count};
}

template <class Real>
void ImpactStage<Real>::begin_step(const std::vector<Contact<Real>>& contacts) {
  const Allowance substep = allowance_of(contacts);
  allowance_ = {constants::kFullSubsteps * substep.impacts, constants::kFullSubsteps * substep.at_once};
}

/// Adds the contact's next impact at or after `from` to the events, if there is one in this substep.
template <class Real>
void ImpactStage<Real>::predict(Call& call, int index, Real from) {
  const Contact<Real>& contact = call.contacts[index];
  ++version_[index];
  if (!(contact.restitution > 0) || contact.count == 0) return;
  const Bodies<Real>& bodies = call.bodies;
  Contact<Real> now = contact;
  follow(now, call.shapes, pose_after(bodies, now.a, from, call.h), pose_after(bodies, now.b, from, call.h));
  const Twist<Real> twist_a = twist_after(bodies, now.a, from, call.h);
  const Twist<Real> twist_b = twist_after(bodies, now.b, from, call.h);
  const Real threshold = call.solver.impact_speed(now, bodies, call.h);
  const Real left = call.h - from;
  const Vec2<Real> pressing = bodies.acceleration[now.b].velocity - bodies.acceleration[now.a].velocity;
  const Real gain = std::abs(dot(pressing, now.normal)) * left;  // m/s that the approach may still gain

  Real earliest = 2 * call.h;
  for (int i = 0; i < now.count; ++i) {
    const ContactPoint<Real>& point = now.points[i];
    const Real speed = dot(relative_velocity(point, twist_a, twist_b), now.normal);
    if (!(-speed > threshold) || point.separation + left * (speed - gain) > 0) continue;
    Contact<Real> then = now;
    earliest = std::min(earliest, time_of_contact(then, i, call.shapes, bodies, from, call.h));
  }
  if (earliest > call.h) return;
  events_.push_back({earliest, index, version_[index]});
  std::push_heap(events_.begin(), events_.end(), [](const Event& x, const Event& y) {
    return x.time != y.time ? x.time > y.time : x.contact > y.contact;
  });
}

template <class Real>
bool ImpactStage<Real>::passes_on(const Call& call, const Contact<Real>& contact) const {
  return call.joints != nullptr && (call.joints->passes_on(contact.a) || call.joints->passes_on(contact.b));
}

template <class Real>
void ImpactStage<Real>::clear_jump(const Call& call, const Contact<Real>& contact) {
  if (passes_on(call, contact)) {
    std::fill(jump_.begin(), jump_.end(), Twist<Real>{});
  } else {
    jump_[contact.a] = jump_[contact.b] = {};
  }
}

/// Adds the velocity change by the impulse to both bodies and, through joints, to others.
template <class Real>
void ImpactStage<Real>::jump_by(const Contact<Real>& contact, const ContactPoint<Real>& point,
                                Vec2<Real> impulse) {
  jump_[contact.a].velocity -= contact.inverse_mass_a * impulse;
  jump_[contact.a].angular_velocity -= contact.inverse_inertia_a * cross(point.arm_a, impulse);
  jump_[contact.b].velocity += contact.inverse_mass_b * impulse;
  jump_[contact.b].angular_velocity += contact.inverse_inertia_b * cross(point.arm_b, impulse);
}

/// Collects the contact's points that touch at time `t`, with their response to impulses.
template <class Real>
Impact<Real> ImpactStage<Real>::pose(Call& call, const Contact<Real>& contact, Real t,
                                     const ContactPoint<Real>* (&touching)[2]) {
  const Bodies<Real>& bodies = call.bodies;
  const Vec2<Real> somewhere = bodies.pose[contact.a].position;
  const Real rounding = Real(1024) * std::numeric_limits<Real>::epsilon() *
                        (contact.reach + std::abs(somewhere.x) + std::abs(somewhere.y));
  Impact<Real> impact;
  impact.restitution = contact.restitution;
  impact.friction = contact.friction;
  for (int i = 0; i < contact.count; ++i)
    if (contact.points[i].separation <= rounding) touching[impact.points++] = &contact.points[i];

  const Twist<Real> twist_a = twist_after(bodies, contact.a, t, call.h);
  const Twist<Real> twist_b = twist_after(bodies, contact.b, t, call.h);
  const Vec2<Real> direction[2] = {contact.normal, perpendicular(contact.normal)};
  for (int j = 0; j < 2 * impact.points; ++j) {
    impact.velocity[j] = dot(relative_velocity(*touching[j / 2], twist_a, twist_b), direction[j % 2]);
    clear_jump(call, contact);
    jump_by(contact, *touching[j / 2], direction[j % 2]);
    if (passes_on(call, contact)) call.joints->pass_on(bodies, jump_);
    for (int i = 0; i < 2 * impact.points; ++i)
      impact.response[i][j] =
          dot(relative_velocity(*touching[i / 2], jump_[contact.a], jump_[contact.b]), direction[i % 2]);
  }
  return impact;
}

/// Resolves the contact's impact at time `t`. Returns true if there was one.
template <class Real>
bool ImpactStage<Real>::strike(Call& call, int index, Real t) {
  Bodies<Real>& bodies = call.bodies;
  Contact<Real> contact = call.contacts[index];
  follow(contact, call.shapes, pose_after(bodies, contact.a, t, call.h),
         pose_after(bodies, contact.b, t, call.h));
  const ContactPoint<Real>* touching[2] = {};
  const Impact<Real> impact = pose(call, contact, t, touching);
  if (impact.points == 0) return false;
  Real impulse[4];
  solve_impact(impact, impulse);

  clear_jump(call, contact);
  for (int j = 0; j < 2 * impact.points; ++j)
    jump_by(contact, *touching[j / 2],
            impulse[j] * (j % 2 == 0 ? contact.normal : perpendicular(contact.normal)));
  struck_.clear();
  if (passes_on(call, contact)) {
    call.joints->pass_on(bodies, jump_);
    for (int body = 0; body < static_cast<int>(jump_.size()); ++body)
      if (!(jump_[body].velocity == Vec2<Real>{}) || jump_[body].angular_velocity != 0)
        struck_.push_back(body);
  } else {
    for (const int body : {contact.a, contact.b})
      if (bodies.inverse_mass[body] > 0) struck_.push_back(body);
  }
  for (const int body : struck_) shift(bodies, body, t);
  call.contacts[index].bounced = true;
  return true;
}

/// Applies the velocity jump at time `t`: v += dv, x -= dv t.
template <class Real>
void ImpactStage<Real>::shift(Bodies<Real>& bodies, int body, Real t) const {
  const Twist<Real>& jump = jump_[body];
  bodies.twist[body].velocity += jump.velocity;
  bodies.twist[body].angular_velocity += jump.angular_velocity;
  bodies.pose[body].position -= t * jump.velocity;
  const Real turn = t * jump.angular_velocity;
  if (turn == 0) return;
  bodies.angle[body] -= turn;
  bodies.pose[body].rotation = rotation_of(bodies.angle[body]);
}

template <class Real>
int ImpactStage<Real>::resolve(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
                               Bodies<Real>& bodies, const ContactSolver<Real>& solver,
                               JointMethod<Real>* joints, Real h,
                               const std::function<bool(int, Real)>& found) {
  Call call{contacts, shapes, bodies, solver, joints, h};
  const auto later = [](const Event& x, const Event& y) {
    return x.time != y.time ? x.time > y.time : x.contact > y.contact;
  };
  events_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) predict(call, static_cast<int>(i), Real{0});

  const Allowance most = allowance_of(contacts);
  std::int64_t left = std::min(most.impacts, allowance_.impacts),
               left_at_once = std::min(most.at_once, allowance_.at_once);
  allowance_.impacts -= left, allowance_.at_once -= left_at_once;
  int impacts = 0;
  Real last = -1;
  while (!events_.empty() && left > 0 && left_at_once > 0) {
    std::pop_heap(events_.begin(), events_.end(), later);
    const Event event = events_.back();
    events_.pop_back();
    if (event.version != version_[event.contact] || !strike(call, event.contact, event.time)) continue;
    ++impacts, --left;
    if (!(event.time > last)) --left_at_once;
    last = event.time;
    bool more = false;
    for (const int body : struck_) more = found(body, event.time) || more;
    if (more) index(contacts, bodies.size());
    for (const int body : struck_) {
      for (int i = first_[body]; i < first_[body + 1]; ++i) {
        contacts[contact_of_[i]].placed = false;
        predict(call, contact_of_[i], event.time);
      }
    }
  }
  allowance_.impacts += left, allowance_.at_once += left_at_once;
  return impacts;
}

template class ImpactStage<float>;
template class ImpactStage<double>;

}  // namespace plumb
