#pragma once

#include <cstdint>
#include <vector>

#include "engine/realtime/aabb_tree.h"

namespace plumb {

/// Two shapes by index, the smaller index in the upper half; keys sort by it.
using PairKey = std::uint64_t;

constexpr PairKey pair_key(int a, int b) {
  const auto low = static_cast<std::uint32_t>(a < b ? a : b),
             high = static_cast<std::uint32_t>(a < b ? b : a);
  return static_cast<PairKey>(low) << 32 | high;
}
constexpr int first_of(PairKey key) { return static_cast<int>(key >> 32); }
constexpr int second_of(PairKey key) { return static_cast<int>(key & 0xFFFFFFFFu); }

/// Finds the pairs of shapes whose boxes overlap. Stores fat AABBs, so that a shape is queried again only
/// after it has left its stored box. The pairs found depend on the stored boxes alone, not on the tree, so
/// that saving the boxes suffices.
template <class Real>
class BroadPhase {
 public:
  explicit BroadPhase(int shapes = 0) : tree_(shapes), moved_flag_(shapes, false) {}

  /// Declares that `shape` stays inside `swept` until the next search. Keeps its stored box if that contains
  /// `swept` and is not needlessly large; otherwise stores `swept` grown by `margin`. Returns true if the box
  /// changed.
  bool place(int shape, const Aabb<Real>& swept, Real margin);

  /// Stores exactly this box (when a snapshot is restored).
  void put(int shape, const Aabb<Real>& box);

  /// Returns true if the shape has been placed.
  bool holds(int shape) const { return tree_.holds(shape); }
  const Aabb<Real>& box(int shape) const { return tree_.box(shape); }
  bool overlap(PairKey pair) const { return box(first_of(pair)).overlaps(box(second_of(pair))); }

  /// Appends each overlapping pair of a shape placed since the last search with any other, if
  /// `may_pair(shape, shape)`. Sorted, without repetition; includes pairs found earlier.
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
      if (other == shape || (moved_flag_[other] && other < shape)) return;  // found from the other shape
      if (may_pair(shape, other)) out.push_back(pair_key(shape, other));
    });
  }
  for (const int shape : moved_) moved_flag_[shape] = false;
  moved_.clear();
  std::sort(out.begin(), out.end());
}

}  // namespace plumb
