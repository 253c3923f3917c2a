#pragma once

#include <array>

#include "engine/collide/dynamic_tree.h"

namespace plumb {

/// Enlarges boxes of a tree in the order in which they are given, each some boxes later. Leaves lie in the
/// order of queries: who goes from body to body would wait for each of a million, and for the node above it;
/// here they are asked for ahead. Until finish() the tree may lack the boxes given last. Proxies stay leaves
/// until then.
template <class Real>
class LateEnlarging {
 public:
  explicit LateEnlarging(DynamicTree<Real>& tree) : tree_(tree) {}
  ~LateEnlarging() { finish(); }  // also when what came between has thrown
  LateEnlarging(const LateEnlarging&) = delete;
  LateEnlarging& operator=(const LateEnlarging&) = delete;

  void enlarge(int proxy, const Aabb<Real>& box) {
    if (given_ >= kWait) take(given_ - kWait);
    tree_.ask_for(proxy);
    if (given_ >= kWait / 2) tree_.ask_for_above(waiting_[(given_ - kWait / 2) % kWait].proxy);
    waiting_[given_ % kWait] = {proxy, box};
    ++given_;
  }
  /// To be called after the last box.
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
