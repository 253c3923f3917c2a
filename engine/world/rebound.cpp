#include "engine/world/rebound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/solve/contact_rows.h"
#include "engine/world/constants.h"
#include "engine/world/contact_reading.h"
#include "engine/world/contacts.h"
#include "engine/world/free_motion.h"
#include "engine/world/narrow_phase.h"

namespace plumb {
namespace {

// Nothing but its own weight acts on it.
template <class Real>
bool is_free(const WorldData<Real>& w, int body) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.type != BodyType::Dynamic) return true;
  if (!record.awake || record.first_joint != kNone || record.lock_x || record.lock_y) return false;
  if (record.constraints == 0) return true;
  bool presses = false;
  for_each_edge(w.contacts, record.first_contact, [&](int, const ContactRecord& contact) {
    if (contact.home != ContactHome::Graph) return;
    const ContactConstraint<Real>& c = w.graph.at({contact.colour, contact.index});
    for (int i = 0; i < c.count; ++i)
      presses = presses || c.normal_impulse[i] > 0 || c.peak_impulse[i] > 0 || !(c.separation[i] > 0);
  });
  return !presses;
}

// When they are as near as at the fraction of the step at which their straight ways bring them together; n
// from a to b. With a constant acceleration that is a little sooner or later.
double meeting_time(const Flight& a, const Flight* b, Vec2d n, double fraction, double dt) {
  const auto between = [&](Vec2d of_a, Vec2d of_b) { return dot(n, of_b - of_a); };
  const Vec2d still{};
  const double there = between(a.start_at(fraction), b ? b->start_at(fraction) : still);
  const double earliest = std::max(a.time, b ? b->time : 0.0);
  double t = fraction * dt;
  for (int i = 0; i < tuning::kMeetingSteps; ++i) {
    const double rate = between(a.velocity_at(t), b ? b->velocity_at(t) : still);
    if (!(rate < 0)) return std::max(fraction * dt, earliest);
    t -= (between(a.position_at(t), b ? b->position_at(t) : still) - there) / rate;
  }
  return std::clamp(t, earliest, std::max(dt, earliest));
}

// With constant acceleration the way is (v0 + v1) dt / 2. What rounding alone makes of it is none.
template <class Real>
void note_motion(const WorldData<Real>& w, Flight& flight, double dt) {
  if (flight.known) return;
  flight.known = true;
  const BodyMotion<Real>& motion = w.motion[flight.body];
  const Vec2d end = motion.velocity.template as<double>(), gain = 2 * (end - (1 / dt) * flight.way);
  const double rounding =
      8 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * (std::abs(end.x) + std::abs(end.y));
  const bool steady = std::abs(gain.x) + std::abs(gain.y) <= rounding;
  flight.position = flight.start;
  flight.acceleration = steady ? Vec2d{} : (1 / dt) * gain;
  flight.velocity = steady ? end : end - gain;
  flight.angular_velocity = static_cast<double>(motion.angular_velocity);
}

// What is written to a body while its impact is looked at, to be put back when there is none.
template <class Real>
struct Kept {
  Kept(WorldData<Real>& world, const Flight* flight)
      : w(world), body(flight == nullptr ? kNone : flight->body) {
    if (body == kNone) return;
    position = w.position[body], rotation = w.rotation[body];
    velocity = w.motion[body].velocity, spin = w.motion[body].angular_velocity;
  }
  void restore() {
    if (body == kNone) return;
    w.position[body] = position, w.rotation[body] = rotation;
    w.motion[body].velocity = velocity, w.motion[body].angular_velocity = spin;
  }
  WorldData<Real>& w;
  int body;
  Vec2d position{};
  Rotation<Real> rotation{};
  Vec2<Real> velocity{};
  Real spin = 0;
};

template <class Real>
void place(WorldData<Real>& w, const Flight& flight, double fraction) {
  const Rotation<double> q = flight.rotation_at(fraction);
  w.position[flight.body] = flight.start_at(fraction);
  w.rotation[flight.body] = {static_cast<Real>(q.c), static_cast<Real>(q.s)};
}

template <class Real>
void set_velocity(WorldData<Real>& w, const Flight& flight, double t) {
  w.motion[flight.body].velocity = flight.velocity_at(t).template as<Real>();
  w.motion[flight.body].angular_velocity = static_cast<Real>(flight.angular_velocity);
}

// Newton's law at the points that touch, then friction. False when they do not approach fast enough.
template <class Real>
bool throw_back(WorldData<Real>& w, ContactConstraint<Real>& c, Real dt) {
  ContactPair<Real> pair(w.motion.data(), c);
  const Real nearest = c.count == 2 ? std::min(c.separation[0], c.separation[1]) : c.separation[0];
  const Real smaller = c.push_speed / Real(tuning::kPushSpeed);
  const Real threshold = bounce_threshold(w, static_cast<double>(dt));
  bool strikes[2] = {}, fast = false;
  Real wanted[2] = {};
  for (int i = 0; i < c.count; ++i) {
    c.normal_impulse[i] = c.peak_impulse[i] = 0;
    c.approach[i] = pair.normal_rate(i);
    strikes[i] =
        c.approach[i] < 0 && c.separation[i] <= nearest + Real(2 * tuning::kImpactTolerance) * smaller;
    fast = fast || (strikes[i] && c.approach[i] < -threshold);
    wanted[i] = -c.restitution * c.approach[i];
  }
  if (!fast) return false;
  c.tangent_impulse = c.rolling_impulse = 0;
  // Twice: what rounding leaves of the one goes with the other, so that no energy trickles away.
  pair.press(wanted, strikes[0], strikes[1]);
  pair.press(wanted, strikes[0], strikes[1]);
  pair.rub_and_roll();
  c.watched = true;
  pair.note_peaks();
  return true;
}

// Tells that the shapes have met; they are apart again at the end of the step.
template <class Real>
void report(WorldData<Real>& w, const ContactRecord& contact, const ContactConstraint<Real>& c) {
  const ContactReading reading = reading_of(w, contact, c);
  const auto touches = [&](const ContactRecord& record) {
    return record.touching && record.shape_a == contact.shape_a && record.shape_b == contact.shape_b;
  };
  if (!any_between(w.contacts, w.bodies[contact.body_a].first_contact, w.bodies[contact.body_b].first_contact,
                   contact.body_a, contact.body_b, touches)) {
    w.log().begin.push_back({reading.shape_a, reading.shape_b});
    w.log().end.push_back({reading.shape_a, reading.shape_b});
  }
  const Real least = c.push_speed * Real(tuning::kHitSpeed / tuning::kPushSpeed);
  const int hardest = c.count == 2 && c.approach[1] < c.approach[0] ? 1 : 0;
  if (!contact.hit_events || c.approach[hardest] > -least) return;
  w.log().hits.push_back({reading.shape_a, reading.shape_b, reading.points[hardest], reading.normal,
                          -static_cast<double>(c.approach[hardest])});
}

}  // namespace

template <class Real>
Flight flight_of(const WorldData<Real>& w, int body) {
  const BodyMotion<Real>& motion = w.motion[body];
  Flight flight;
  flight.body = body;
  flight.way = motion.moved.template as<double>();
  flight.start = flight.first = w.position[body] - flight.way;
  flight.turn = static_cast<double>(motion.turned);
  const Rotation<double> q{static_cast<double>(w.rotation[body].c), static_cast<double>(w.rotation[body].s)};
  const Rotation<double> back = rotation_of(-flight.turn);
  flight.rotation = {q.c * back.c - q.s * back.s, q.s * back.c + q.c * back.s};
  return flight;
}

template <class Real>
bool may_rebound(const WorldData<Real>& w, int shape, int other) {
  const ShapeRecord<Real>&a = w.shapes[shape], &b = w.shapes[other];
  if (a.pre_solve || b.pre_solve || !(restitution_between(w, shape, other) > 0)) return false;
  return is_free(w, a.body) && is_free(w, b.body);
}

template <class Real>
bool rebound(WorldData<Real>& w, Flight& a, int shape, Flight* b, int other, double fraction, double dt) {
  Kept<Real> kept_a(w, &a), kept_b(w, b);
  note_motion(w, a, dt);
  place(w, a, fraction);
  if (b) note_motion(w, *b, dt), place(w, *b, fraction);
  const ContactRecord contact = contact_of(w, shape, other);
  ContactConstraint<Real> c = constraint_between(w, contact);
  bool thrown = c.count > 0;
  double t = 0;
  if (thrown) {
    const double sign = contact.body_a == a.body ? 1 : -1;
    t = meeting_time(a, b, sign * c.normal.template as<double>(), fraction, dt);
    set_velocity(w, a, t);
    if (b) set_velocity(w, *b, t);
    thrown = throw_back(w, c, static_cast<Real>(dt));
  }
  if (thrown) report(w, contact, c);
  const auto go_on = [&](Flight* flight, Kept<Real>& kept) {
    if (flight == nullptr || !thrown || !w.gives_way(flight->body)) return kept.restore();
    const BodyMotion<Real>& motion = w.motion[flight->body];
    flight->go_on(fraction, t, motion.velocity.template as<double>(),
                  static_cast<double>(motion.angular_velocity), dt);
  };
  go_on(&a, kept_a);
  go_on(b, kept_b);
  return thrown;
}

template <class Real>
void land(WorldData<Real>& w, const Flight& flight, double dt) {
  BodyMotion<Real>& motion = w.motion[flight.body];
  const double turned = flight.turned_before + flight.turn;
  w.bodies[flight.body].angle += turned - static_cast<double>(motion.turned);
  place(w, flight, 1);
  motion.moved = (w.position[flight.body] - flight.first).template as<Real>();
  motion.turned = static_cast<Real>(turned);
  if (flight.impacts == 0) return;
  motion.velocity = flight.velocity_at(dt).template as<Real>();
  motion.angular_velocity = static_cast<Real>(flight.angular_velocity);
}

#define PLUMB_FOR(Real)                                                                \
  template Flight flight_of(const WorldData<Real>&, int);                              \
  template bool may_rebound(const WorldData<Real>&, int, int);                         \
  template bool rebound(WorldData<Real>&, Flight&, int, Flight*, int, double, double); \
  template void land(WorldData<Real>&, const Flight&, double);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
