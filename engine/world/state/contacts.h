#pragma once

#include <algorithm>

#include "engine/world/world_data.h"

/// Lifecycle of a contact. It is created when the fat AABBs of two shapes overlap, and destroyed when they
/// separate. It is in the constraint graph while it has points and a body is awake.
namespace plumb {

/// Returns true if bodies, filters, and joints between the bodies let the two shapes collide.
template <class Real>
bool may_collide(const WorldData<Real>& w, int shape_a, int shape_b);

/// Calls the user's filter for a pair that may collide; returns true if there is no filter. Only the calling
/// thread may call it.
template <class Real>
bool passes_user_filter(const WorldData<Real>& w, int shape_a, int shape_b) {
  return !w.filter || w.filter(std::min(shape_a, shape_b), std::max(shape_a, shape_b));
}
/// Returns true if the two shapes may collide; calls the user's filter too.
template <class Real>
bool may_create_contact(const WorldData<Real>& w, int shape_a, int shape_b) {
  return may_collide(w, shape_a, shape_b) && passes_user_filter(w, shape_a, shape_b);
}

/// Returns the categories to query for a shape's AABB, folded. A shape with a group queries all, because a
/// group may overrule the mask.
inline std::uint32_t effective_mask(const Filter& filter) {
  return filter.group != 0 ? 0xFFFFFFFFu : folded(filter.mask);
}
/// Returns true if a contact has points, or had points in the solver.
inline bool has_points(const ContactRecord& contact) {
  return contact.home == ContactHome::Graph || contact.home == ContactHome::Sleeping;
}

/// Returns true if the shape collides with nothing; such a shape has no proxy in the trees.
inline bool collides_with_nothing(const Filter& filter) { return effective_mask(filter) == 0; }

/// Returns a new record for a contact of two shapes, in the order that contacts require.
template <class Real>
ContactRecord contact_of(const WorldData<Real>& w, int shape_a, int shape_b);

template <class Real>
void create_contact(WorldData<Real>& w, int shape_a, int shape_b);

/// Removes a contact, and reports the end of touching.
template <class Real>
void destroy_contact(WorldData<Real>& w, int contact);

/// Moves a contact that has gained points from NonTouching to Graph, and wakes its bodies.
template <class Real>
void begin_contact(WorldData<Real>& w, int contact, const ContactConstraint<Real>& constraint);

/// Moves a contact that has lost its points from Graph to NonTouching.
template <class Real>
void end_contact(WorldData<Real>& w, int contact);

/// Moves a contact to Sleeping or SleepingNonTouching when none of its dynamic bodies is awake, and back.
template <class Real>
void sleep_contact(WorldData<Real>& w, int contact);
template <class Real>
void wake_contact(WorldData<Real>& w, int contact);

/// Returns the constraint of a contact that has points.
template <class Real>
ContactConstraint<Real>& constraint_of(WorldData<Real>& w, const ContactRecord& contact);

/// Stores the touching state of a contact, and emits the begin or end event.
template <class Real>
void set_touching(WorldData<Real>& w, int contact, bool touching);

/// Marks the bodies of a contact under load. Several threads may mark the same body at once.
template <class Real>
void mark_contact_load(WorldData<Real>& w, const ContactConstraint<Real>& c) {
  for (const int body : {c.body_a, c.body_b})
    __atomic_store_n(&w.scratch.narrow_phase.has_contact_load[body], char(1), __ATOMIC_RELAXED);
}

/// Invalidates the manifolds of a body that was teleported.
template <class Real>
void invalidate_manifolds(WorldData<Real>& w, int body);

/// Destroys all contacts of a body, or of one of its shapes, and wakes sleeping bodies that touched it.
template <class Real>
void destroy_contacts_of(WorldData<Real>& w, int body, int shape = kNone);

/// Destroys the contacts that a shape's new filter forbids, or that the user's filter must decide on again.
/// Wakes sleeping bodies that touch the shape.
template <class Real>
void destroy_forbidden_contacts(WorldData<Real>& w, int shape);

/// Wakes sleeping bodies that a new static shape touches. (Other bodies are awake when they move, and wake
/// the bodies that they touch in the next step.)
template <class Real>
void wake_touched(WorldData<Real>& w, int shape);

/// Calls visit(edge, record of contact or joint) along a body's list. `visit` may remove that item.
template <class Items, class Visit>
void for_each_edge(Items& items, int first, Visit&& visit) {
  for (int edge = first; edge != kNone;) {
    auto& item = items[edge / 2];
    const int next = item.next[edge & 1];
    visit(edge, item);
    edge = next;
  }
}

/// Returns true if `test` is true of any contact or joint of a body's list; stops at the first.
template <class Items, class Test>
bool any_edge(const Items& items, int first, Test&& test) {
  for (int edge = first; edge != kNone; edge = items[edge / 2].next[edge & 1])
    if (test(items[edge / 2])) return true;
  return false;
}

/// Returns true if `test` is true of any item between two bodies. Walks both bodies' lists in parallel, and
/// stops at the end of the shorter one.
template <class Items, class Test>
bool any_between(const Items& items, int edge_a, int edge_b, int body_a, int body_b, Test&& test) {
  while (edge_a != kNone && edge_b != kNone) {
    const auto &of_a = items[edge_a / 2], &of_b = items[edge_b / 2];
    if (((edge_a & 1) == 0 ? of_a.body_b : of_a.body_a) == body_b && test(of_a)) return true;
    if (((edge_b & 1) == 0 ? of_b.body_b : of_b.body_a) == body_a && test(of_b)) return true;
    edge_a = of_a.next[edge_a & 1], edge_b = of_b.next[edge_b & 1];
  }
  return false;
}

/// Adds item `index` to the lists of its body_a and body_b, or removes it from them. `head` is the member of
/// BodyRecord at which the lists start.
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
