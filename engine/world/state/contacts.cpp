#include "engine/world/state/contacts.h"

#include <cassert>

#include "engine/world/state/contact_setup.h"
#include "engine/world/state/sleeping.h"

namespace plumb {
namespace {

template <class Real>
void count_constraint(WorldData<Real>& w, const ContactRecord& contact, int by) {
  w.bodies[contact.body_a].constraints += by;
  w.bodies[contact.body_b].constraints += by;
}

template <class Real>
void enter_nontouching(WorldData<Real>& w, int contact) {
  append(w.nontouching_contacts, contact);
  ContactRecord& record = w.contacts[contact];
  record.home = ContactHome::NonTouching;
  record.index = static_cast<int>(w.nontouching_contacts.size()) - 1;
}

// Swap-removes: the last nontouching contact takes the freed place.
template <class Real>
void remove_nontouching(WorldData<Real>& w, int index) {
  assert(index >= 0 && index < static_cast<int>(w.nontouching_contacts.size()));
  if (index + 1 < static_cast<int>(w.nontouching_contacts.size())) {
    w.nontouching_contacts[index] = w.nontouching_contacts.back();
    w.contacts[w.nontouching_contacts[index]].index = index;
  }
  w.nontouching_contacts.pop_back();
}

template <class Real>
void leave_nontouching(WorldData<Real>& w, int contact) {
  assert(w.contacts[contact].home == ContactHome::NonTouching);
  remove_nontouching(w, w.contacts[contact].index);
}

template <class Real>
void enter_graph(WorldData<Real>& w, int contact, const ContactConstraint<Real>& constraint) {
  ContactRecord& record = w.contacts[contact];
  w.topology_changed = true;
  const auto place = w.graph.add(constraint, w.is_dynamic(record.body_a), w.is_dynamic(record.body_b));
  record.home = ContactHome::Graph;
  record.colour = static_cast<std::int8_t>(place.colour);
  record.index = place.index;
}

template <class Real>
void leave_graph(WorldData<Real>& w, int contact) {
  w.topology_changed = true;
  const ContactRecord& record = w.contacts[contact];
  assert(record.home == ContactHome::Graph);
  const int follower =
      w.graph.remove({record.colour, record.index}, w.is_dynamic(record.body_a), w.is_dynamic(record.body_b));
  if (follower != -1) w.contacts[follower].index = record.index;
}

template <class Real>
void leave_sleeping(WorldData<Real>& w, int index) {
  assert(index >= 0 && index < static_cast<int>(w.sleeping_contacts.size()));
  if (index + 1 < static_cast<int>(w.sleeping_contacts.size())) {
    w.sleeping_contacts[index] = w.sleeping_contacts.back();
    w.contacts[w.sleeping_contacts[index].contact].index = index;
  }
  w.sleeping_contacts.pop_back();
}

template <class Real>
bool joined_without_collision(const WorldData<Real>& w, int body_a, int body_b) {
  return any_between(w.joints, w.bodies[body_a].first_joint, w.bodies[body_b].first_joint, body_a, body_b,
                     [](const JointRecord& joint) { return !joint.collide; });
}

}  // namespace

template <class Real>
bool may_collide(const WorldData<Real>& w, int shape_a, int shape_b) {
  const ShapeRecord<Real>&a = w.shapes[shape_a], &b = w.shapes[shape_b];
  if (a.body == b.body || (!w.is_dynamic(a.body) && !w.is_dynamic(b.body))) return false;
  const ShapeForm<Real>&form_a = w.forms[shape_a], &form_b = w.forms[shape_b];
  if (form_a.sensor || form_b.sensor || (form_a.chain && form_b.chain)) return false;
  return may_touch(a.filter, b.filter) && !joined_without_collision(w, a.body, b.body);
}

template <class Real>
ContactRecord contact_of(const WorldData<Real>& w, int shape_a, int shape_b) {
  assert(w.shapes.used(shape_a) && w.shapes.used(shape_b) &&
         w.shapes[shape_a].body != w.shapes[shape_b].body);
  // A chain's segment must be shape a, because the manifold functions expect it there.
  if (w.forms[shape_b].chain || (!w.forms[shape_a].chain && shape_b < shape_a)) std::swap(shape_a, shape_b);
  const ShapeRecord<Real>&a = w.shapes[shape_a], &b = w.shapes[shape_b];
  ContactRecord record;
  record.shape_a = shape_a, record.shape_b = shape_b;
  record.body_a = a.body, record.body_b = b.body;
  record.pre_solve = a.pre_solve || b.pre_solve;
  record.hit_events = a.hit_events || b.hit_events;
  return record;
}

template <class Real>
void create_contact(WorldData<Real>& w, int shape_a, int shape_b) {
  const ContactRecord record = contact_of(w, shape_a, shape_b);
  w.contacts.reserve_more(1);
  ensure_capacity(w.nontouching_contacts, w.nontouching_contacts.size() + 1);
  w.pairs.insert(record.shape_a, record.shape_b);
  const int contact = w.contacts.add(record);
  link_edges(w, w.contacts, contact, &BodyRecord<Real>::first_contact);
  if (w.bodies[record.body_a].awake || w.bodies[record.body_b].awake) {
    enter_nontouching(w, contact);
  } else {
    w.contacts[contact].home = ContactHome::SleepingNonTouching;
  }
}

template <class Real>
void destroy_contact(WorldData<Real>& w, int contact) {
  assert(w.contacts.used(contact));
  set_touching(w, contact, false);
  const ContactRecord record = w.contacts[contact];
  switch (record.home) {
    case ContactHome::NonTouching:
      leave_nontouching(w, contact);
      break;
    case ContactHome::Graph:
      leave_graph(w, contact);
      break;
    case ContactHome::Sleeping:
      leave_sleeping(w, record.index);
      break;
    case ContactHome::SleepingNonTouching:
      break;
  }
  if (record.home == ContactHome::Graph || record.home == ContactHome::Sleeping)
    count_constraint(w, record, -1);
  unlink_edges(w, w.contacts, contact, &BodyRecord<Real>::first_contact);
  w.pairs.erase(record.shape_a, record.shape_b);
  w.contacts.remove(contact);
}

template <class Real>
void begin_contact(WorldData<Real>& w, int contact, const ContactConstraint<Real>& constraint) {
  assert(w.contacts[contact].home == ContactHome::NonTouching);
  const int index = w.contacts[contact].index;
  enter_graph(w, contact, constraint);
  remove_nontouching(w, index);
  const ContactRecord record = w.contacts[contact];
  count_constraint(w, record, 1);
  try {
    wake_body(w, record.body_a);
    wake_body(w, record.body_b);
  } catch (...) {
    leave_graph(w, contact);
    enter_nontouching(w, contact);  // its capacity suffices: the contact was there before
    count_constraint(w, record, -1);
    throw;
  }
}

template <class Real>
void end_contact(WorldData<Real>& w, int contact) {
  assert(w.contacts[contact].home == ContactHome::Graph);
  ensure_capacity(w.nontouching_contacts, w.nontouching_contacts.size() + 1);
  set_touching(w, contact, false);
  leave_graph(w, contact);
  enter_nontouching(w, contact);
  count_constraint(w, w.contacts[contact], -1);
}

template <class Real>
void sleep_contact(WorldData<Real>& w, int contact) {
  ContactRecord& record = w.contacts[contact];
  if (record.home == ContactHome::NonTouching) {
    // An awake kinematic body may touch a sleeping one.
    if (w.bodies[record.body_a].awake || w.bodies[record.body_b].awake) return;
    leave_nontouching(w, contact);
    record.home = ContactHome::SleepingNonTouching;
  } else if (record.home == ContactHome::Graph) {
    append(w.sleeping_contacts, w.graph.at({record.colour, record.index}));
    leave_graph(w, contact);
    record.home = ContactHome::Sleeping;
    record.index = static_cast<int>(w.sleeping_contacts.size()) - 1;
  }
}

template <class Real>
void wake_contact(WorldData<Real>& w, int contact) {
  const ContactRecord& record = w.contacts[contact];
  if (record.home == ContactHome::SleepingNonTouching) {
    enter_nontouching(w, contact);
  } else if (record.home == ContactHome::Sleeping) {
    const int index = record.index;
    if (w.stepping) append(w.scratch.narrow_phase.woken_contacts, contact);
    const ContactConstraint<Real> constraint = w.sleeping_contacts[index];
    enter_graph(w, contact, constraint);
    leave_sleeping(w, index);
  }
}

template <class Real>
ContactConstraint<Real>& constraint_of(WorldData<Real>& w, const ContactRecord& contact) {
  assert(contact.home == ContactHome::Sleeping || contact.home == ContactHome::Graph);
  return contact.home == ContactHome::Sleeping ? w.sleeping_contacts[contact.index]
                                               : w.graph.at({contact.colour, contact.index});
}

template <class Real>
void set_touching(WorldData<Real>& w, int contact, bool touching) {
  ContactRecord& record = w.contacts[contact];
  if (record.touching == touching) return;
  const auto id = [&](int shape) {
    return ShapeId{static_cast<std::uint32_t>(shape), w.shapes.generation(shape)};
  };
  (touching ? w.event_buffer().begin : w.event_buffer().end)
      .push_back({id(record.shape_a), id(record.shape_b)});
  record.touching = touching;
}

template <class Real>
void invalidate_manifolds(WorldData<Real>& w, int body) {
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int, ContactRecord& contact) {
    if (contact.home == ContactHome::Graph || contact.home == ContactHome::Sleeping) {
      constraint_of(w, contact).recycle_budget = -1;
    }
  });
}

template <class Real>
void destroy_contacts_of(WorldData<Real>& w, int body, int shape) {
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, const ContactRecord& contact) {
    if (shape != kNone && contact.shape_a != shape && contact.shape_b != shape) return;
    const int other = (edge & 1) == 0 ? contact.body_b : contact.body_a;
    if (contact.home == ContactHome::Sleeping) wake_body(w, other);
    destroy_contact(w, edge / 2);
  });
}

template <class Real>
void destroy_forbidden_contacts(WorldData<Real>& w, int shape) {
  for_each_edge(
      w.contacts, w.bodies[w.shapes[shape].body].first_contact, [&](int edge, const ContactRecord& contact) {
        if (contact.shape_a != shape && contact.shape_b != shape) return;
        const int other = (edge & 1) == 0 ? contact.body_b : contact.body_a;
        if (contact.home == ContactHome::Sleeping) wake_body(w, other);
        if (!may_touch(w.shapes[contact.shape_a].filter, w.shapes[contact.shape_b].filter) || w.filter)
          destroy_contact(w, edge / 2);
      });
}

template <class Real>
void wake_touched(WorldData<Real>& w, int shape) {
  const ShapeRecord<Real>& record = w.shapes[shape];
  if (record.proxy == kNone || w.bodies[record.body].type != BodyType::Static) return;
  const Aabb<Real>& box = w.static_tree.box(record.proxy);
  w.dynamic_tree.query(box, effective_mask(record.filter), [&](int other, int) {
    const int body = w.shapes[other].body;
    if (!w.bodies[body].awake && may_collide(w, shape, other) && may_touch_now(w, shape, other))
      wake_body(w, body);
    return true;
  });
}

#define PLUMB_FOR(Real)                                                                    \
  template bool may_collide(const WorldData<Real>&, int, int);                             \
  template ContactRecord contact_of(const WorldData<Real>&, int, int);                     \
  template void create_contact(WorldData<Real>&, int, int);                                \
  template void destroy_contact(WorldData<Real>&, int);                                    \
  template void begin_contact(WorldData<Real>&, int, const ContactConstraint<Real>&);      \
  template void end_contact(WorldData<Real>&, int);                                        \
  template void sleep_contact(WorldData<Real>&, int);                                      \
  template void wake_contact(WorldData<Real>&, int);                                       \
  template ContactConstraint<Real>& constraint_of(WorldData<Real>&, const ContactRecord&); \
  template void set_touching(WorldData<Real>&, int, bool);                                 \
  template void invalidate_manifolds(WorldData<Real>&, int);                               \
  template void destroy_contacts_of(WorldData<Real>&, int, int);                           \
  template void destroy_forbidden_contacts(WorldData<Real>&, int);                         \
  template void wake_touched(WorldData<Real>&, int);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
