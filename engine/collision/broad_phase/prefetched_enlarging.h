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
    if (given_ >= kWait) take(given_ - kWait);
    tree_.ask_for(proxy);
    if (given_ >= kWait / 2) tree_.ask_for_above(waiting_[(given_ - kWait / 2) % kWait].proxy);
    waiting_[given_ % kWait] = {proxy, box};
    ++given_;
  }
  /// Enlarges the delayed boxes. Call it after the last box.
  void finish() {
    for (unsigned i = given_ < kWait ? 0 : given_ - kWait; i < given_; ++i) take(i);
    given_ = 0;
  }

 private:
  static constexpr unsigned kWait = 16;
  struct Given {
    int proxy;
    Aabb<Real> box;
  };
  void take(unsigned i) { tree_.enlarge(waiting_[i % kWait].proxy, waiting_[i % kWait].box); }

  DynamicTree<Real>& tree_;
  std::array<Given, kWait> waiting_;
  unsigned given_ = 0;
};

}  // namespace plumb
