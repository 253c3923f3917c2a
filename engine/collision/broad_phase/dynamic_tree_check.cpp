#include <algorithm>
#include <cstdint>
#include <limits>

#include "engine/collision/broad_phase/dynamic_tree.h"
#include "engine/encoding/encoding.h"

// Functions that visit every node: measures, the check of all links, and snapshots, which use that check.

namespace plumb {

namespace {

/// Returns true if `free` lists each unused number once, and nothing else.
bool lists_all_unused(const std::vector<int>& free, std::vector<bool>& used) {
  for (const int each : free) {
    if (each < 0 || static_cast<std::size_t>(each) >= used.size() || used[each]) return false;
    used[each] = true;
  }
  return std::find(used.begin(), used.end(), false) == used.end();
}

/// Returns true if a count read from a snapshot is plausible: no real count reaches a quarter of the range,
/// and doubling it cannot overflow.
bool is_count(std::int64_t count) {
  return count >= 0 && count <= std::numeric_limits<std::int64_t>::max() / 4;
}

}  // namespace

PLUMB_REAL_MEMBERS(TreeNode, box, category, link, tag, parent)
PLUMB_REAL_MEMBERS(TreePair, children)

template <class Real>
int DynamicTree<Real>::height() const {
  if (size_ == 0) return 0;
  int highest = 1;
  const auto measure = [&](const Node& leaf) {
    int depth = 1;
    for (int up = leaf.parent; up != kNone; up = node(up).parent) ++depth;
    highest = std::max(highest, depth);
    return true;
  };
  if (!node(kRoot).is_leaf())
    traverse_stackless(
        node(kRoot).link, [](const Node&) { return true; }, measure);
  return highest;
}

template <class Real>
double DynamicTree<Real>::cost() const {
  if (size_ < 2) return 0;
  double sum = 0;
  const auto add = [&](const Node& each) {
    if (!each.is_leaf()) sum += static_cast<double>(each.box.half_perimeter());
    return true;
  };
  add(node(kRoot));
  traverse_stackless(node(kRoot).link, add, [](const Node&) { return true; });
  return sum / static_cast<double>(node(kRoot).box.half_perimeter());
}

/// Returns true if an inner node agrees with its children, and they link back to it.
template <class Real>
bool DynamicTree<Real>::is_valid_inner(int slot) const {
  const Node& here = node(slot);
  if (here.link <= 0 || here.link >= static_cast<int>(pairs_.size())) return false;
  const auto& [a, b] = pairs_[here.link].children;
  const Aabb<Real> box = merged(a.box, b.box);
  const bool exact = here.box.lower == box.lower && here.box.upper == box.upper;
  const bool clean = here.tag == 0 && !a.marked() && !b.marked();
  return a.parent == slot && b.parent == slot && here.category == (a.category | b.category) &&
         (clean ? exact : here.tag == 1 && here.box.contains(box));
}

template <class Real>
bool DynamicTree<Real>::is_valid_leaf(int slot) const {
  const Node& here = node(slot);
  if (here.proxy() >= static_cast<int>(slots_.size()) || slots_[here.proxy()] != slot) return false;
  const Aabb<Real>& box = boxes_[here.proxy()];
  return box.lower == here.box.lower && box.upper == here.box.upper && here.box.lower.x <= here.box.upper.x &&
         here.box.lower.y <= here.box.upper.y;
}

template <class Real>
bool DynamicTree<Real>::valid() const {
  const std::size_t pairs = pairs_.size(), size = static_cast<std::size_t>(size_);
  if (size_ < 0 || size > slots_.size() || size > pairs || boxes_.size() != slots_.size()) return false;
  if (!is_count(enlargements_) || !is_count(marks_)) return false;
  std::vector<bool> pair_used(pairs, false), proxy_used(slots_.size(), false);
  if (pairs > 0) pair_used[0] = true;
  std::size_t leaves = 0;
  std::vector<int> open;
  if (size > 0) {
    if (node(kRoot).parent != kNone) return false;
    open.push_back(kRoot);
  }
  while (!open.empty()) {
    const int slot = open.back();
    open.pop_back();
    const Node& here = node(slot);
    if (here.is_leaf()) {
      if (!is_valid_leaf(slot)) return false;
      proxy_used[here.proxy()] = true;
      ++leaves;
      continue;
    }
    // No pair is visited twice: the loop ends whatever the links are.
    if (!is_valid_inner(slot) || pair_used[here.link]) return false;
    pair_used[here.link] = true;
    open.push_back(first(here.link));
    open.push_back(first(here.link) + 1);
  }
  return leaves == size && lists_all_unused(free_pairs_, pair_used) &&
         lists_all_unused(free_proxies_, proxy_used) &&
         std::all_of(free_proxies_.begin(), free_proxies_.end(),
                     [&](int each) { return slots_[each] == kNone; });
}

template <class Real>
void DynamicTree<Real>::save(std::vector<std::byte>& out) const {
  Encoder encoder(out);
  encoder.put(std::int32_t{size_});
  encoder.put(enlargements_), encoder.put(marks_), encoder.put(mean_at_build_);
  encoder.put(pairs_), encoder.put(slots_), encoder.put(free_pairs_), encoder.put(free_proxies_);
}

template <class Real>
void DynamicTree<Real>::restore(std::span<const std::byte>& in) {
  Decoder decoder(in, "snapshot");
  DynamicTree copy;
  constexpr char kTree[] = "tree of boxes";
  copy.size_ = decoder.get<std::int32_t>(kTree);
  decoder.get(copy.enlargements_, kTree), decoder.get(copy.marks_, kTree),
      decoder.get(copy.mean_at_build_, kTree);
  decoder.get(copy.pairs_, "nodes of a tree of boxes");
  decoder.get(copy.slots_, "leaves of a tree of boxes");
  decoder.get(copy.free_pairs_, "free nodes of a tree of boxes");
  decoder.get(copy.free_proxies_, "free leaves of a tree of boxes");
  for (const int slot : copy.slots_) {
    const bool known = slot >= 0 && slot >> 1 < static_cast<int>(copy.pairs_.size());
    copy.boxes_.push_back(known ? copy.node(slot).box : Aabb<Real>{});
  }
  decoder.require(copy.valid(), kTree, "is damaged");
  // Copies instead of swapping, so that this tree keeps its capacity and later steps allocate nothing.
  size_ = copy.size_;
  enlargements_ = copy.enlargements_;
  marks_ = copy.marks_;
  mean_at_build_ = copy.mean_at_build_;
  pairs_.assign(copy.pairs_.begin(), copy.pairs_.end());
  slots_.assign(copy.slots_.begin(), copy.slots_.end());
  boxes_.assign(copy.boxes_.begin(), copy.boxes_.end());
  free_pairs_.assign(copy.free_pairs_.begin(), copy.free_pairs_.end());
  free_proxies_.assign(copy.free_proxies_.begin(), copy.free_proxies_.end());
  in = decoder.rest();
}

template int DynamicTree<float>::height() const;
template int DynamicTree<double>::height() const;
template double DynamicTree<float>::cost() const;
template double DynamicTree<double>::cost() const;
template bool DynamicTree<float>::valid() const;
template bool DynamicTree<double>::valid() const;
template void DynamicTree<float>::save(std::vector<std::byte>&) const;
template void DynamicTree<double>::save(std::vector<std::byte>&) const;
template void DynamicTree<float>::restore(std::span<const std::byte>&);
template void DynamicTree<double>::restore(std::span<const std::byte>&);

}  // namespace plumb
