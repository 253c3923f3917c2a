#pragma once

#include <array>

#include "engine/collision/broad_phase/dynamic_tree.h"

namespace plumb {

/// Enlarges boxes of a tree in the given order. Delays each enlargement by 16 boxes and meanwhile prefetches
/// the leaf and the node above it: leaves are stored in the order of queries, not of bodies, so each would be
/// a cache miss. The tree is not up to date before finish(). Proxies must stay leaves until then.
template <class Real>
class PrefetchedEnlarging {
 public:
  explicit PrefetchedEnlarging(DynamicTree<Real>& tree) : tree_(tree) {}
  ~PrefetchedEnlarging() { finish(); }  // also if an exception was thrown
  PrefetchedEnlarging(const PrefetchedEnlarging&) = delete;
  PrefetchedEnlarging& operator=(const PrefetchedEnlarging&) = delete;

  void enlarge(int proxy, const Aabb<Real>& box) {
    if (count_ >= kDelay) take(count_ - kDelay);
    tree_.prefetch(proxy);
    if (count_ >= kDelay / 2) tree_.prefetch_parent(queue_[(count_ - kDelay / 2) % kDelay].proxy);
    queue_[count_ % kDelay] = {proxy, box};
    ++count_;
  }
  /// Enlarges the delayed boxes. Call it after the last box.
  void finish() {
    for (unsigned i = count_ < kDelay ? 0 : count_ - kDelay; i < count_; ++i) take(i);
    count_ = 0;
  }

 private:
  static constexpr unsigned kDelay = 16;
  struct Entry {
    int proxy;
    Aabb<Real> box;
  };
  void take(unsigned i) { tree_.enlarge(queue_[i % kDelay].proxy, queue_[i % kDelay].box); }

  DynamicTree<Real>& tree_;
  std::array<Entry, kDelay> queue_;
  unsigned count_ = 0;
};

}  // namespace plumb
