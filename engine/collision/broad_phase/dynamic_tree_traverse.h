#pragma once

// The templates of DynamicTree that take visitors; included by dynamic_tree.h.

#include <algorithm>
#include <utility>

#include "engine/collision/broad_phase/dynamic_tree.h"

namespace plumb {

template <class Real>
template <class Enter, class Leaf>
bool DynamicTree<Real>::traverse_stackless(int top, const Enter& enter, const Leaf& leaf) const {
  int slot = first(top);
  for (;;) {
    const Node& here = node(slot);
    if (enter(here)) {
      if (!here.is_leaf()) {
        slot = first(here.link);
        continue;
      }
      if (!leaf(here)) return false;
    }
    while ((slot & 1) != 0) {
      if (slot >> 1 == top) return true;
      slot = node(slot).parent;
    }
    ++slot;
  }
}

template <class Real>
template <class Visit>
void DynamicTree<Real>::query(const Aabb<Real>& box, std::uint32_t mask, Visit&& visit) const {
  const OverlapTest<Real> meets(box, mask);
  const auto visit_leaf = [&](const Node& leaf) -> bool { return visit(int{leaf.tag}, leaf.proxy()); };
  if (size_ == 0 || !meets(node(kRoot))) return;
  if (node(kRoot).is_leaf()) {
    visit_leaf(node(kRoot));
    return;
  }
  int stack[kStack];
  int waiting = 0;
  for (int pair = node(kRoot).link;;) {
    int next = kNone;
    for (const Node& child : pairs_[pair].children) {
      if (!meets(child)) continue;
      if (child.is_leaf()) {
        if (!visit_leaf(child)) return;
      } else if (next == kNone) {
        next = child.link;
      } else if (waiting < kStack) {
        stack[waiting++] = child.link;
      } else if (!traverse_stackless(child.link, meets, visit_leaf)) {
        return;
      }
    }
    if (next == kNone) {
      if (waiting == 0) return;
      next = stack[--waiting];
    }
    pair = next;
  }
}

template <class Real>
template <class Bound, class Reaches, class Leaf>
void DynamicTree<Real>::traverse_nearest_first(const Bound& bound, const Reaches& reaches,
                                               const Leaf& leaf) const {
  struct Waiting {
    int pair;
    Real bound;
  };
  if (size_ == 0 || !reaches(bound(node(kRoot)))) return;
  if (node(kRoot).is_leaf()) {
    leaf(node(kRoot));
    return;
  }
  const auto enter = [&](const Node& child) { return reaches(bound(child)); };
  Waiting stack[kStack];
  int waiting = 0;
  for (int pair = node(kRoot).link;;) {
    const Node* near = &pairs_[pair].children[0];
    const Node* far = &pairs_[pair].children[1];
    Real near_bound = bound(*near), far_bound = bound(*far);
    if (far_bound < near_bound) {
      std::swap(near, far);
      std::swap(near_bound, far_bound);
    }
    int next = kNone;
    if (reaches(near_bound)) {
      if (!near->is_leaf())
        next = near->link;
      else if (!leaf(*near))
        return;
    }
    if (reaches(far_bound)) {
      if (far->is_leaf()) {
        if (!leaf(*far)) return;
      } else if (next == kNone) {
        next = far->link;
      } else if (waiting < kStack) {
        stack[waiting++] = {far->link, far_bound};
      } else if (!traverse_stackless(far->link, enter, leaf)) {
        return;
      }
    }
    while (next == kNone) {
      if (waiting == 0) return;
      const Waiting& last = stack[--waiting];
      if (reaches(last.bound)) next = last.pair;
    }
    pair = next;
  }
}

template <class Real>
template <class Visit>
void DynamicTree<Real>::ray_cast(Vec2<Real> origin, Vec2<Real> translation, Vec2<Real> half_extent,
                                 std::uint32_t mask, Visit&& visit) const {
  const SweepTest<Real> enters_at(origin, translation, half_extent, mask);
  Real max_fraction = 1;
  traverse_nearest_first(
      enters_at, [&](Real fraction) { return fraction <= max_fraction; },
      [&](const Node& leaf) {
        max_fraction = std::min(max_fraction, static_cast<Real>(visit(int{leaf.tag}, max_fraction)));
        return max_fraction > 0;
      });
}

template <class Real>
template <class Visit>
void DynamicTree<Real>::nearest(Vec2<Real> point, std::uint32_t mask, Real max_distance,
                                Visit&& visit) const {
  using Test = DistanceTest<Real>;
  if (!(max_distance >= 0)) return;
  Real limit = Test::limit(max_distance);
  traverse_nearest_first(
      Test(point, mask), [&](Real square) { return square <= limit && square < Test::kMiss; },
      [&](const Node& leaf) {
        max_distance = std::min(max_distance, static_cast<Real>(visit(int{leaf.tag}, max_distance)));
        limit = Test::limit(max_distance);
        return max_distance >= 0;
      });
}

}  // namespace plumb
