#pragma once

#include <cstdint>
#include <vector>

#include "engine/collide/aabb_tree.h"

namespace plumb {

/// Two shapes by index, the smaller one first; ordered by it.
using PairKey = std::uint64_t;

constexpr PairKey pair_key(int a, int b) {
  const auto low = static_cast<std::uint32_t>(a < b ? a : b),
             high = static_cast<std::uint32_t>(a < b ? b : a);
  return static_cast<PairKey>(low) << 32 | high;
}
constexpr int first_of(PairKey key) { return static_cast<int>(key >> 32); }
constexpr int second_of(PairKey key) { return static_cast<int>(key & 0xFFFFFFFFu); }

/// Finds the pairs of shapes whose boxes overlap. A shape's stored box is larger than asked for, so that it
/// is looked at again only after it has moved out of it. Which pairs overlap depends on the stored boxes
/// alone, not on the tree, so that saving the boxes is enough.
template <class Real>
class BroadPhase {
 public:
  explicit BroadPhase(int shapes = 0) : tree_(shapes), moved_flag_(shapes, false) {}

  /// Says that `shape` stays inside `swept` until the next search. Its stored box is kept where it surrounds
  /// that and is not needlessly large; otherwise it becomes `swept` grown by `margin`. Returns whether it
  /// changed.
  bool place(int shape, const Aabb<Real>& swept, Real margin);

  /// Stores exactly this box (when a snapshot is read back).
  void put(int shape, const Aabb<Real>& box);

  /// Whether the shape has been placed at all.
  bool holds(int shape) const { return tree_.holds(shape); }
  const Aabb<Real>& box(int shape) const { return tree_.box(shape); }
  bool overlap(PairKey pair) const { return box(first_of(pair)).overlaps(box(second_of(pair))); }

  /// Appends each pair of a shape placed anew since the last search with one that its box overlaps, where
  /// `may_pair(shape, shape)`. Sorted, without repetition; pairs that were there before are among them.
  template <class MayPair>
  void search(MayPair&& may_pair, std::vector<PairKey>& out);

 private:
  AabbTree<Real> tree_;
  std::vector<int> moved_;
  std::vector<bool> moved_flag_;
};

template <class Real>
template <class MayPair>
void BroadPhase<Real>::search(MayPair&& may_pair, std::vector<PairKey>& out) {
  for (const int shape : moved_) {
    tree_.query(tree_.box(shape), [&](int other) {
      if (other == shape || (moved_flag_[other] && other < shape)) return;  // found from the other side
      if (may_pair(shape, other)) out.push_back(pair_key(shape, other));
    });
  }
  for (const int shape : moved_) moved_flag_[shape] = false;
  moved_.clear();
  std::sort(out.begin(), out.end());
}

}  // namespace plumb
