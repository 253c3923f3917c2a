#pragma once

#include "engine/world/world_data.h"

/// The life of a contact: made when the stored boxes of two shapes overlap, in the constraint graph while it
/// has points, parked while its bodies sleep, gone when the boxes part.
namespace plumb {

/// Whether the two shapes are to collide at all: bodies, filters, joints between the bodies.
template <class Real>
bool may_collide(const WorldData<Real>& w, int shape_a, int shape_b);

/// The categories that a shape's boxes are to be looked for in: a group may overrule its mask.
inline std::uint32_t seen_by(const Filter& filter) { return filter.group != 0 ? 0xFFFFFFFFu : filter.mask; }
/// What nothing can meet has no box in the trees, and costs no more than a body without shapes.
inline bool meets_nothing(const Filter& filter) { return seen_by(filter) == 0; }

/// What a contact of two shapes is, in the order that it has them in.
template <class Real>
ContactRecord contact_of(const WorldData<Real>& w, int shape_a, int shape_b);

template <class Real>
void create_contact(WorldData<Real>& w, int shape_a, int shape_b);

/// Reports the end of touching.
template <class Real>
void destroy_contact(WorldData<Real>& w, int contact);

/// From Near to Graph: it has points now. Bodies that sleep are woken.
template <class Real>
void begin_contact(WorldData<Real>& w, int contact, const ContactConstraint<Real>& constraint);

/// From Graph to Near.
template <class Real>
void end_contact(WorldData<Real>& w, int contact);

/// To Parked or Idle when none of its bodies that give way is awake, and back.
template <class Real>
void park_contact(WorldData<Real>& w, int contact);
template <class Real>
void unpark_contact(WorldData<Real>& w, int contact);

/// The constraint of a contact that has points.
template <class Real>
ContactConstraint<Real>& constraint_of(WorldData<Real>& w, const ContactRecord& contact);

/// Notes whether the contact touches as events tell it.
template <class Real>
void set_touching(WorldData<Real>& w, int contact, bool touching);

/// The manifolds of a body that was put somewhere else are to be made anew.
template <class Real>
void forget_manifolds(WorldData<Real>& w, int body);

/// Destroys all contacts of a body, or of one shape of it; what rested on it wakes up.
template <class Real>
void destroy_contacts_of(WorldData<Real>& w, int body, int shape = kNone);

/// After a shape got another filter: destroys its contacts that this forbids. What touches it wakes up.
template <class Real>
void destroy_forbidden_contacts(WorldData<Real>& w, int shape);

/// Wakes what sleeps where a static shape has come to be, and would be pressed by it. (A body that moves is
/// awake, and wakes what it meets in the next step.)
template <class Real>
void wake_touched(WorldData<Real>& w, int shape);

/// Calls visit(edge, record of contact or joint) along a body's list; the visited one may be removed.
template <class Items, class Visit>
void for_each_edge(Items& items, int first, Visit&& visit) {
  for (int edge = first; edge != kNone;) {
    auto& item = items[edge / 2];
    const int next = item.next[edge & 1];
    visit(edge, item);
    edge = next;
  }
}

/// Whether there is an item between two bodies for which `holds` does: looks along both bodies' lists at
/// once, as far as the shorter one goes.
template <class Items, class Test>
bool any_between(const Items& items, int edge_a, int edge_b, int body_a, int body_b, Test&& holds) {
  while (edge_a != kNone && edge_b != kNone) {
    const auto &of_a = items[edge_a / 2], &of_b = items[edge_b / 2];
    if (((edge_a & 1) == 0 ? of_a.body_b : of_a.body_a) == body_b && holds(of_a)) return true;
    if (((edge_b & 1) == 0 ? of_b.body_b : of_b.body_a) == body_a && holds(of_b)) return true;
    edge_a = of_a.next[edge_a & 1], edge_b = of_b.next[edge_b & 1];
  }
  return false;
}

/// Puts item `index` with body_a and body_b into both bodies' lists that start at `head` (a member of
/// BodyRecord), or takes it out.
template <class Real, class Items>
void link_edges(WorldData<Real>& w, Items& items, int index, int BodyRecord<Real>::*head);
template <class Real, class Items>
void unlink_edges(WorldData<Real>& w, Items& items, int index, int BodyRecord<Real>::*head);

template <class Real, class Items>
void link_edges(WorldData<Real>& w, Items& items, int index, int BodyRecord<Real>::*head) {
  for (int side = 0; side < 2; ++side) {
    auto& item = items[index];
    BodyRecord<Real>& body = w.bodies[side == 0 ? item.body_a : item.body_b];
    item.previous[side] = kNone;
    item.next[side] = body.*head;
    if (body.*head != kNone) items[body.*head / 2].previous[body.*head & 1] = 2 * index + side;
    body.*head = 2 * index + side;
  }
}

template <class Real, class Items>
void unlink_edges(WorldData<Real>& w, Items& items, int index, int BodyRecord<Real>::*head) {
  for (int side = 0; side < 2; ++side) {
    auto& item = items[index];
    BodyRecord<Real>& body = w.bodies[side == 0 ? item.body_a : item.body_b];
    const int before = item.previous[side], after = item.next[side];
    if (before != kNone) items[before / 2].next[before & 1] = after;
    if (after != kNone) items[after / 2].previous[after & 1] = before;
    if (body.*head == 2 * index + side) body.*head = after;
  }
}

}  // namespace plumb
