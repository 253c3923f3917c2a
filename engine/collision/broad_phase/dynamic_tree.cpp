#include "engine/collision/broad_phase/dynamic_tree.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "engine/core/capacity.h"

namespace plumb {
namespace {

template <class Real>
Real merged_half_perimeter(const Aabb<Real>& a, const Aabb<Real>& b) {
  return merged(a, b).half_perimeter();
}

/// Returns four times the squared distance between the centres.
template <class Real>
Real distance_squared(const Aabb<Real>& a, const Aabb<Real>& b) {
  return length_squared((a.lower + a.upper) - (b.lower + b.upper));
}

}  // namespace

template <class Real>
int DynamicTree<Real>::insert(const Aabb<Real>& box, std::uint32_t category, int user) {
  reserve_more(1);
  int proxy = static_cast<int>(slots_.size());
  if (free_proxies_.empty()) {
    slots_.push_back(kNone);
    boxes_.push_back(box);
  } else {
    proxy = free_proxies_.back();
    free_proxies_.pop_back();
    boxes_[proxy] = box;
  }
  insert_leaf({box, category, ~proxy, user, kNone});
  return proxy;
}

template <class Real>
void DynamicTree<Real>::remove(int proxy) {
  assert(slots_[proxy] != kNone);
  remove_leaf(proxy);
  slots_[proxy] = kNone;
  free_proxies_.push_back(proxy);
}

template <class Real>
void DynamicTree<Real>::move(int proxy, const Aabb<Real>& box) {
  assert(slots_[proxy] != kNone);
  const Aabb<Real> wanted = box;  // a copy: `box` may be another leaf's, which moves when this one is removed
  Node leaf = remove_leaf(proxy);
  leaf.box = boxes_[proxy] = wanted;
  insert_leaf(leaf);
}

template <class Real>
void DynamicTree<Real>::enlarge(int proxy, const Aabb<Real>& box) {
  assert(slots_[proxy] != kNone);
  Node& leaf = node(slots_[proxy]);
  if (!leaf.box.overlaps(box)) {
    move(proxy, box);
    return;
  }
  leaf.box = boxes_[proxy] = box;
  ++enlargements_;
  for (int slot = leaf.parent; slot != kNone;) {
    Node& above = node(slot);
    if (above.tag == 0) {
      above.tag = 1;
      ++marks_;
    } else if (above.box.contains(box)) {
      // All nodes above a marked node are marked, and contain it.
      return;
    }
    above.box = merged(above.box, box);
    slot = above.parent;
  }
}

template <class Real>
void DynamicTree<Real>::clear() {
  pairs_.clear();
  slots_.clear();
  boxes_.clear();
  free_pairs_.clear();
  free_proxies_.clear();
  size_ = 0;
  enlargements_ = marks_ = 0;
  mean_at_build_ = 0;
}

template <class Real>
void DynamicTree<Real>::reserve(int leaves) {
  const std::size_t count = static_cast<std::size_t>(std::max(leaves, 0)) + 1;  // pair 0 holds the root alone
  pairs_.reserve(count);
  slots_.reserve(count);
  boxes_.reserve(count);
  free_pairs_.reserve(count);
  free_proxies_.reserve(count);
  loose_pairs_.reserve(count);
  is_loose_.reserve(count);
  gathered_.reserve(count);
  items_.reserve(count);
}

template <class Real>
void DynamicTree<Real>::reserve_more(std::size_t more) {
  const std::size_t proxies = slots_.size() + more - std::min(more, free_proxies_.size());
  ensure_capacity(slots_, proxies), ensure_capacity(boxes_, proxies), ensure_capacity(free_proxies_, proxies);
  const std::size_t pairs =
      pairs_.size() + 1 + more - std::min(more, free_pairs_.size());  // pair 0 holds the root alone
  ensure_capacity(pairs_, pairs), ensure_capacity(free_pairs_, pairs);
}

/// Updates the links of a node's children, or of its proxy, to its slot.
template <class Real>
void DynamicTree<Real>::update_links(int slot) {
  const Node& here = node(slot);
  if (here.is_leaf())
    slots_[here.proxy()] = slot;
  else
    for (Node& child : pairs_[here.link].children) child.parent = slot;
}

template <class Real>
void DynamicTree<Real>::put(int slot, Node content) {
  Node& here = node(slot);
  content.parent = here.parent;
  here = content;
  update_links(slot);
}

template <class Real>
void DynamicTree<Real>::swap_nodes(int a, int b) {
  const Node was = node(a);
  put(a, node(b));
  put(b, was);
}

template <class Real>
int DynamicTree<Real>::new_pair() {
  if (free_pairs_.empty()) {
    append(pairs_, Pair{});
    ensure_capacity(free_pairs_, pairs_.size());  // so that removing a leaf allocates nothing
    return static_cast<int>(pairs_.size()) - 1;
  }
  const int pair = free_pairs_.back();
  free_pairs_.pop_back();
  return pair;
}

template <class Real>
void DynamicTree<Real>::free_pair(int pair) {
  pairs_[pair] = Pair{};
  free_pairs_.push_back(pair);
}

/// Updates an inner node's box, categories and mark from its children's. Returns true if any of them changed.
template <class Real>
bool DynamicTree<Real>::update(int slot) {
  Node& here = node(slot);
  const auto& [a, b] = pairs_[here.link].children;
  const Aabb<Real> box = merged(a.box, b.box);
  const std::uint32_t category = a.category | b.category;
  const int tag = here.tag | static_cast<int>(a.marked()) | static_cast<int>(b.marked());
  const bool same = here.box.lower == box.lower && here.box.upper == box.upper && here.category == category &&
                    here.tag == tag;
  here.box = box;
  here.category = category;
  here.tag = tag;
  return !same;
}

/// Finds the node that is cheapest to pair with a leaf of `box`: the cost is the half perimeter of the new
/// parent plus the growth of the nodes above it. Descends one path, as long as a node below may still be
/// cheaper (branch and bound after Bittner, Hapala and Havran 2013, without backtracking).
template <class Real>
int DynamicTree<Real>::best_sibling(const Aabb<Real>& box, std::uint32_t ties) const {
  const Real least = box.half_perimeter();
  int best = kRoot, slot = kRoot;
  Real direct = merged_half_perimeter(node(kRoot).box, box);
  Real best_cost = direct, inherited = 0;
  while (!node(slot).is_leaf()) {
    const Node& here = node(slot);
    inherited += direct - here.box.half_perimeter();
    const auto& children = pairs_[here.link].children;
    Real merged_size[2], cost[2], bound[2];
    for (int i = 0; i < 2; ++i) {
      const Aabb<Real>& other = children[i].box;
      merged_size[i] = merged_half_perimeter(other, box);
      cost[i] = inherited + merged_size[i];
      bound[i] =
          children[i].is_leaf() ? cost[i] : inherited + (merged_size[i] - other.half_perimeter()) + least;
    }
    int next = bound[1] < bound[0] ? 1 : 0;
    if (bound[0] == bound[1]) {
      const Real to_first = distance_squared(children[0].box, box);
      const Real to_second = distance_squared(children[1].box, box);
      // Equal boxes would grow a chain: a pseudo-random side keeps the height logarithmic.
      ties = ties * 1664525u + 1013904223u;
      next = to_first == to_second ? static_cast<int>(ties >> 31) : static_cast<int>(to_second < to_first);
    }
    const int other = 1 - next;
    if (cost[other] < best_cost && cost[other] < cost[next]) {
      best_cost = cost[other];
      best = first(here.link) + other;
    } else if (cost[next] <= best_cost) {
      best_cost = cost[next];
      best = first(here.link) + next;
    }
    if (bound[next] > best_cost) break;
    slot = first(here.link) + next;
    direct = merged_size[next];
  }
  return best;
}

template <class Real>
void DynamicTree<Real>::insert_leaf(const Node& leaf) {
  if (pairs_.empty()) pairs_.emplace_back();
  if (size_++ == 0) {
    put(kRoot, leaf);
    return;
  }
  const int top = best_sibling(leaf.box, static_cast<std::uint32_t>(leaf.proxy()) * 2654435769u);
  const int pair = new_pair();
  put(first(pair), node(top));
  put(first(pair) + 1, leaf);
  Node& parent = node(top);
  parent.link = pair;
  parent.tag = 0;
  update_links(top);
  // A rotation involves three levels of boxes: once three in a row are unchanged, none above can rotate.
  for (int slot = top, unchanged = 0; slot != kNone && unchanged < 3; slot = node(slot).parent) {
    unchanged = update(slot) ? 0 : unchanged + 1;
    if (rotate(slot)) unchanged = 0;
  }
}

template <class Real>
typename DynamicTree<Real>::Node DynamicTree<Real>::remove_leaf(int proxy) {
  const int slot = slots_[proxy];
  const Node leaf = node(slot);
  --size_;
  if (slot == kRoot) {
    node(kRoot) = Node{};
    return leaf;
  }
  put(leaf.parent, node(slot ^ 1));
  free_pair(slot >> 1);
  for (int up = node(leaf.parent).parent; up != kNone && update(up); up = node(up).parent) {
  }
  return leaf;
}

/// Exchanges a child with a child of its sibling if that shrinks the sibling; picks the exchange that saves
/// most.
template <class Real>
bool DynamicTree<Real>::rotate(int slot) {
  const int pair = first(node(slot).link);
  Real most_saved = 0;
  int lower = kNone, upper = kNone;
  for (const int here : {pair, pair + 1}) {
    const Node& sibling = node(here ^ 1);
    if (sibling.is_leaf()) continue;
    const Real before = sibling.box.half_perimeter();
    const auto& [a, b] = pairs_[sibling.link].children;
    const Real saved_by_a = before - merged_half_perimeter(node(here).box, b.box);
    const Real saved_by_b = before - merged_half_perimeter(node(here).box, a.box);
    const Real saved = std::max(saved_by_a, saved_by_b);
    if (!(saved > most_saved)) continue;
    most_saved = saved;
    upper = here;
    lower = first(sibling.link) + (saved_by_a >= saved_by_b ? 0 : 1);
  }
  if (upper == kNone) return false;
  swap_nodes(upper, lower);
  update(upper ^ 1);
  if (node(upper ^ 1).marked()) node(slot).tag = 1;
  return true;
}

template class DynamicTree<float>;
template class DynamicTree<double>;

}  // namespace plumb
