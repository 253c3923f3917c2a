#include "engine/world/state/sleeping.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "engine/core/capacity.h"
#include "engine/core/union_find.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/quarantine.h"

namespace plumb {
namespace {

template <class Real>
BodyId id_of(const WorldData<Real>& w, int body) {
  return {static_cast<std::uint32_t>(body), w.bodies.generation(body)};
}

// Adds an event. Bodies may wake and sleep any number of times between two steps, so a long list is reduced
// to one event for each existing body.
template <class Real>
void add_event(WorldData<Real>& w, std::vector<BodyId>& events, int body) {
  if (events.size() >= 64 + 2 * static_cast<std::size_t>(w.bodies.size())) {
    std::vector<char>& seen = w.scratch.cannot_sleep;
    seen.assign(static_cast<std::size_t>(w.bodies.size()), 0);
    std::erase_if(events, [&](BodyId each) {
      return !w.bodies.holds(each.index, each.generation) || std::exchange(seen[each.index], 1) != 0;
    });
  }
  events.push_back(id_of(w, body));
}

// Calls visit(other body) for every body that a contact with points or a joint connects to `body`.
template <class Real, class Visit>
void for_each_constraint_edge(WorldData<Real>& w, int body, Visit&& visit) {
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, ContactRecord& contact) {
    if (has_points(contact)) visit((edge & 1) == 0 ? contact.body_b : contact.body_a);
  });
  for_each_edge(w.joints, w.bodies[body].first_joint,
                [&](int edge, JointRecord& joint) { visit((edge & 1) == 0 ? joint.body_b : joint.body_a); });
}

template <class Real>
bool is_awake_dynamic(const WorldData<Real>& w, int body) {
  return w.bodies[body].awake && w.is_dynamic(body);
}

// Returns true if a constraint has an awake dynamic body. Without one it stays asleep, even while its
// kinematic body is awake.
template <class Real, class Record>
bool is_solved(const WorldData<Real>& w, const Record& record) {
  return is_awake_dynamic(w, record.body_a) || is_awake_dynamic(w, record.body_b);
}

template <class Real>
void wake_constraints(WorldData<Real>& w, int body) {
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, ContactRecord& contact) {
    if (contact.home != ContactHome::Sleeping || is_solved(w, contact)) wake_contact(w, edge / 2);
  });
  for_each_edge(w.joints, w.bodies[body].first_joint, [&](int, JointRecord& joint) {
    if (joint.active || has_quarantined_body(w, joint) || !is_solved(w, joint)) return;
    w.joint_set.set_active(joint.slot, true);
    joint.active = true;
  });
}

template <class Real>
void sleep_constraints(WorldData<Real>& w, int body) {
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, ContactRecord& contact) {
    if (contact.home == ContactHome::NonTouching || !is_solved(w, contact)) sleep_contact(w, edge / 2);
  });
  for_each_edge(w.joints, w.bodies[body].first_joint, [&](int, JointRecord& joint) {
    if (!joint.active || is_solved(w, joint)) return;
    w.joint_set.set_active(joint.slot, false);
    joint.active = false;
  });
}

template <class Real>
bool may_fall_asleep(const WorldData<Real>& w, int body) {
  const BodyRecord<Real>& record = w.bodies[body];
  return record.may_sleep && record.sleep_time >= Real(tuning::kSleepTime);
}

// Returns true if the shapes of a contact lie too deep in each other to be at rest.
template <class Real>
bool is_deep(const ContactConstraint<Real>& c) {
  const Real depth = -(c.count == 2 ? std::min(c.separation[0], c.separation[1]) : c.separation[0]);
  return depth > Real(tuning::kSleepOverlap / tuning::kDepenetrationSpeed) * c.depenetration_speed;
}

// Reserves memory for the contacts of bodies that fall asleep.
template <class Real>
void reserve_sleeping(WorldData<Real>& w, const std::vector<int>& sleepers) {
  std::size_t contacts = 0;
  for (const int body : sleepers) {
    for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int, const ContactRecord& contact) {
      contacts += contact.home == ContactHome::Graph ? 1 : 0;
    });
  }
  ensure_capacity(w.sleeping_contacts, w.sleeping_contacts.size() + std::min(contacts, w.graph.size()));
  ensure_capacity(w.event_buffer().fell_asleep, w.event_buffer().fell_asleep.size() + sleepers.size());
}

}  // namespace

template <class Real>
void add_awake(WorldData<Real>& w, int body) {
  BodyRecord<Real>& record = w.bodies[body];
  assert(!record.awake && record.type != BodyType::Static);
  record.awake = true;
  w.topology_changed = true;
  record.sleep_time = 0;
  record.awake_index = static_cast<int>(w.awake.size());
  append(w.awake, body);
}

template <class Real>
void remove_awake(WorldData<Real>& w, int body) {
  BodyRecord<Real>& record = w.bodies[body];
  assert(record.awake && w.awake[record.awake_index] == body);
  record.awake = false;
  w.topology_changed = true;
  w.awake[record.awake_index] = w.awake.back();
  w.bodies[w.awake.back()].awake_index = record.awake_index;
  w.awake.pop_back();
  record.awake_index = kNone;
}

template <class Real>
void fall_asleep(WorldData<Real>& w, int body) {
  add_event(w, w.event_buffer().fell_asleep, body);
  remove_awake(w, body);
  // Islands on a kinematic body check that body's sleep timer, so set it.
  w.bodies[body].sleep_time = std::max(w.bodies[body].sleep_time, Real(tuning::kSleepTime));
  SolverBody<Real>& motion = w.motion[body];
  motion.velocity = {}, motion.angular_velocity = 0;
  motion.delta_position = {}, motion.delta_angle = 0;
}

template <class Real>
void wake_body(WorldData<Real>& w, int body) {
  const auto sleeps = [&](int i) { return !w.bodies[i].awake && w.bodies[i].type != BodyType::Static; };
  if (!sleeps(body)) return;
  std::vector<int>& queue = w.scratch.queue;
  const std::size_t first = queue.size();  // calls may be nested
  const auto wake = [&](int i) {
    if (!sleeps(i)) return;
    ensure_capacity(w.awake, w.awake.size() + 1), ensure_capacity(queue, queue.size() + 1);
    add_event(w, w.event_buffer().woke, i);
    add_awake(w, i);
    queue.push_back(i);
  };
  try {
    wake(body);
    for (std::size_t next = first; next < queue.size(); ++next) {
      const int current = queue[next];
      wake_constraints(w, current);
      if (w.is_dynamic(current)) for_each_constraint_edge(w, current, wake);
    }
  } catch (...) {
    // Keeps the whole island asleep, because an island must not be half awake. This needs no memory: the
    // lists contained these bodies before.
    for (std::size_t i = first; i < queue.size(); ++i) remove_awake(w, queue[i]);
    for (std::size_t i = first; i < queue.size(); ++i) sleep_constraints(w, queue[i]);
    queue.resize(first);
    throw;
  }
  queue.resize(first);
}

template <class Real>
void wake_neighbours(WorldData<Real>& w, int body) {
  wake_body(w, body);
  for_each_constraint_edge(w, body, [&](int other) { wake_body(w, other); });
}

template <class Real>
void sleep_islands(WorldData<Real>& w) {
  if (!w.settings.sleeping) return;
  if (std::none_of(w.awake.begin(), w.awake.end(), [&](int body) { return may_fall_asleep(w, body); }))
    return;
  UnionFind islands(w.scratch.islands.island_of, w.bodies.size());
  w.scratch.islands.islands_known = false;  // they are overwritten here
  std::vector<char>& cannot_sleep = w.scratch.cannot_sleep;
  cannot_sleep.assign(w.bodies.size(), 0);
  const auto connect = [&](int a, int b) {
    if (w.is_dynamic(a) && w.is_dynamic(b)) return islands.join(a, b);
    // Bodies on a moving kinematic body do not sleep.
    for (const auto& [platform, rider] : {std::pair{a, b}, std::pair{b, a}}) {
      if (w.bodies[platform].type == BodyType::Kinematic && !may_fall_asleep(w, platform))
        cannot_sleep[rider] = 1;
    }
  };
  w.graph.for_each([&](const ContactConstraint<Real>& c) {
    connect(c.body_a, c.body_b);
    if (is_deep(c)) cannot_sleep[c.body_a] = cannot_sleep[c.body_b] = 1;
  });
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (joint.active) connect(joint.body_a, joint.body_b);
  });
  for (const int body : w.awake) {
    if (cannot_sleep[body] || !may_fall_asleep(w, body)) cannot_sleep[islands.find(body)] = 1;
  }
  std::vector<int>& sleepers = w.scratch.queue;
  sleepers.clear();
  for (const int body : w.awake) {
    if (!cannot_sleep[islands.find(body)]) sleepers.push_back(body);
  }
  reserve_sleeping(w, sleepers);
  for (const int body : sleepers) fall_asleep(w, body);
  for (const int body : sleepers) sleep_constraints(w, body);
  sleepers.clear();
}

template <class Real>
void put_to_sleep(WorldData<Real>& w, int body) {
  assert(w.bodies.used(body));
  if (!w.bodies[body].awake) return;
  constexpr Real kListed = -1;
  std::vector<int> island;
  const auto add = [&](int i) {
    Real& sleep_time = w.bodies[i].sleep_time;
    if (!w.bodies[i].awake || sleep_time == kListed || (i != body && !w.is_dynamic(i))) return;
    island.push_back(i);
    sleep_time = kListed;
  };
  add(body);
  for (std::size_t next = 0; next < island.size(); ++next) {
    if (w.is_dynamic(island[next])) for_each_constraint_edge(w, island[next], add);
  }
  reserve_sleeping(w, island);
  for (const int i : island) fall_asleep(w, i);
  for (const int i : island) sleep_constraints(w, i);
}

#define PLUMB_FOR(Real)                                 \
  template void wake_body(WorldData<Real>&, int);       \
  template void wake_neighbours(WorldData<Real>&, int); \
  template void sleep_islands(WorldData<Real>&);        \
  template void put_to_sleep(WorldData<Real>&, int);    \
  template void fall_asleep(WorldData<Real>&, int);     \
  template void add_awake(WorldData<Real>&, int);       \
  template void remove_awake(WorldData<Real>&, int);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
