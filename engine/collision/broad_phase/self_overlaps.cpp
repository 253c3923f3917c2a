#include "engine/collision/broad_phase/dynamic_tree.h"

namespace plumb {

template <class Real>
bool DynamicTree<Real>::mark_self_overlaps(std::vector<char>& meets, int most) const {
  meets.assign(slots_.size(), 0);
  // Two subtrees whose leaves may overlap.
  struct Both {
    int a, b;
  };
  Both stack[kStack];
  int left = most;
  // The paths from the root to any two leaves diverge at one pair of siblings.
  for (const Pair& pair : pairs_) {
    const auto& [one, two] = pair.children;
    // The root's pair and free pairs have no siblings.
    if (two.parent == kNone || !OverlapTest<Real>(one.box, kAll)(two)) continue;
    const int place = first(static_cast<int>(&pair - pairs_.data()));
    stack[0] = {place, place + 1};
    for (int waiting = 1; waiting > 0;) {
      auto [a, b] = stack[--waiting];
      if (--left < 0) return false;
      if (node(a).is_leaf() && node(b).is_leaf()) {
        meets[node(a).proxy()] = meets[node(b).proxy()] = 1;
        continue;
      }
      if (node(a).is_leaf()) std::swap(a, b);
      if (waiting + 2 > kStack) return false;
      const OverlapTest<Real> meets_b(node(b).box, kAll);
      const int below = first(node(a).link);
      for (const int child : {below, below + 1})
        if (meets_b(node(child))) stack[waiting++] = {b, child};
    }
  }
  return true;
}

template bool DynamicTree<float>::mark_self_overlaps(std::vector<char>&, int) const;
template bool DynamicTree<double>::mark_self_overlaps(std::vector<char>&, int) const;

}  // namespace plumb
