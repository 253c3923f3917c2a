#pragma once

#include "engine/world/state/contacts.h"
#include "engine/world/world_data.h"

/// Dynamic bodies that press on others at the start of a step.
namespace plumb {

/// Entries of Scratch::pushers beside a body's index and kNone: nobody has asked yet, or there are several.
constexpr int kUnknownPusher = -2, kSeveralPushers = -3;

/// Returns true if `test` is true of any dynamic body that presses on a body. Reads only what does not change
/// while contacts are updated.
template <class Real, class Test>
bool any_pusher(const WorldData<Real>& w, int body, Test&& test) {
  if (w.scratch.has_contact_load[body] == 0) return false;
  return any_edge(w.contacts, w.bodies[body].first_contact, [&](const ContactRecord& contact) {
    const int other = contact.body_a == body ? contact.body_b : contact.body_a;
    if (contact.home != ContactHome::Graph || !w.is_dynamic(other)) return false;
    const ContactConstraint<Real>& c = w.graph.at({contact.colour, contact.index});
    return (c.normal_impulse[0] > 0 || c.normal_impulse[1] > 0) && test(other);
  });
}

/// Returns the only dynamic body that presses on a body, kNone or kSeveralPushers, and keeps it for the step:
/// in a crowd many pairs ask. Several threads may find the same at once.
template <class Real>
int pusher_of(WorldData<Real>& w, int body) {
  int& known = w.scratch.pushers[body];
  if (const int pusher = __atomic_load_n(&known, __ATOMIC_RELAXED); pusher != kUnknownPusher) return pusher;
  int first = kNone;
  const bool several = any_pusher(w, body, [&](int other) {
    if (first == kNone) first = other;
    return other != first;
  });
  const int pusher = several ? kSeveralPushers : first;
  __atomic_store_n(&known, pusher, __ATOMIC_RELAXED);
  return pusher;
}

/// Returns true if another dynamic body than `partner` presses on a dynamic body.
template <class Real>
bool is_pressed_by_third(WorldData<Real>& w, int body, int partner) {
  if (!w.is_dynamic(body)) return false;
  const int pusher = pusher_of(w, body);
  return pusher != kNone && pusher != partner;
}

}  // namespace plumb
