#pragma once

#include <vector>

#include "engine/world/continuous/common_motion.h"
#include "engine/world/continuous/swept_bodies.h"
#include "engine/world/state/contacts.h"
#include "engine/world/world_data.h"

/// Bodies that joints connect. Only for continuous.cpp.
namespace plumb {

/// Calls visit(body) for a body and all dynamic bodies connected to it by joints.
template <class Real, class Visit>
void for_each_in_mechanism(WorldData<Real>& w, int body, const Visit& visit) {
  std::vector<int>& queue = w.scratch.queue;
  std::vector<char>& seen = w.scratch.cannot_sleep;
  if (w.bodies[body].first_joint == kNone) return visit(body);
  queue.assign(1, body);
  seen.assign(w.bodies.size(), 0);
  seen[body] = 1;
  for (std::size_t next = 0; next < queue.size(); ++next) {
    visit(queue[next]);
    for_each_edge(w.joints, w.bodies[queue[next]].first_joint, [&](int edge, const JointRecord& joint) {
      const int other = (edge & 1) == 0 ? joint.body_b : joint.body_a;
      if (!joint.active || !w.is_dynamic(other) || seen[other]) return;
      seen[other] = 1;
      queue.push_back(other);
    });
  }
  queue.clear();
}

/// Calls visit(place) for the swept bodies of a body and of all dynamic bodies connected to it by joints.
template <class Real, class Visit>
void for_each_jointed(WorldData<Real>& w, int index, double dt, const Visit& visit) {
  for_each_in_mechanism(w, w.scratch.continuous.swept_bodies[index].body,
                        [&](int body) { visit(swept_body_index(w, body, dt)); });
}

/// Returns true if joints hold a body, or others that joints connect to it, to a body that is not dynamic.
template <class Real>
bool is_mechanism_held(WorldData<Real>& w, int body) {
  bool held = false;
  for_each_in_mechanism(w, body, [&](int link) { held = held || is_held_by_joint(w, link); });
  return held;
}

}  // namespace plumb
