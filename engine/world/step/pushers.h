#pragma once

#include "engine/world/state/contacts.h"
#include "engine/world/world_data.h"

/// Dynamic bodies that press on others at the start of a step.
namespace plumb {

/// Entry of Scratch::pushers beside a body's index and kNone.
constexpr int kSeveralPushers = -2;

/// Adds a dynamic body that presses on `body`. Several threads may do so at once: the result depends on which
/// bodies press, not on their order.
template <class Real>
void add_pusher(WorldData<Real>& w, int body, int pusher, bool shared) {
  int& entry = w.scratch.narrow_phase.pushers[body];
  int known = __atomic_load_n(&entry, __ATOMIC_RELAXED);
  while (known != pusher && known != kSeveralPushers) {
    const int both = known == kNone ? pusher : kSeveralPushers;
    if (!shared) {
      entry = both;
      return;
    }
    if (__atomic_compare_exchange_n(&entry, &known, both, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) return;
  }
}

/// Marks the bodies of a contact that presses, at the start of a step. `shared` tells if other threads do the
/// same.
template <class Real>
void mark_pushers(WorldData<Real>& w, const ContactConstraint<Real>& c, bool shared) {
  if (!(c.normal_impulse[0] > 0 || c.normal_impulse[1] > 0)) return;
  mark_contact_load(w, c);
  if (is_dynamic(w.motion[c.body_a])) add_pusher(w, c.body_b, c.body_a, shared);
  if (is_dynamic(w.motion[c.body_b])) add_pusher(w, c.body_a, c.body_b, shared);
}

/// Returns true if `test` is true of any dynamic body that presses on a body. Reads only what does not change
/// while contacts are updated.
template <class Real, class Test>
bool any_pusher(const WorldData<Real>& w, int body, Test&& test) {
  if (w.scratch.narrow_phase.has_contact_load[body] == 0) return false;
  return any_edge(w.contacts, w.bodies[body].first_contact, [&](const ContactRecord& contact) {
    const int other = contact.body_a == body ? contact.body_b : contact.body_a;
    if (contact.home != ContactHome::Graph || !w.is_dynamic(other)) return false;
    const ContactConstraint<Real>& c = w.graph.at({contact.colour, contact.index});
    return (c.normal_impulse[0] > 0 || c.normal_impulse[1] > 0) && test(other);
  });
}

/// Returns true if another dynamic body than `partner` presses on a dynamic body.
template <class Real>
bool is_pressed_by_third(const WorldData<Real>& w, int body, int partner) {
  if (!w.is_dynamic(body)) return false;
  const int pusher = w.scratch.narrow_phase.pushers[body];
  return pusher != kNone && pusher != partner;
}

}  // namespace plumb
