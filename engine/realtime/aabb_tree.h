#pragma once

#include <utility>
#include <vector>

#include "engine/geometry/aabb.h"

namespace plumb {

/// A binary tree of boxes: each node's box surrounds its children's. The caller numbers the leaves. Insertion
/// follows the surface-area heuristic (Goldsmith and Salmon, 1987) and rotates nodes on the way back up
/// (Kopta et al., 2012), so that queries stay near logarithmic.
template <class Real>
class AabbTree {
 public:
  /// Reserves leaves 0 .. count - 1; none is in the tree yet.
  explicit AabbTree(int count = 0);

  /// Puts `leaf` into the tree with `box`, or moves it there.
  void place(int leaf, const Aabb<Real>& box);

  bool holds(int leaf) const { return nodes_[leaf].used; }
  const Aabb<Real>& box(int leaf) const { return nodes_[leaf].box; }

  /// Calls `visit(leaf)` for every leaf whose box overlaps `box`, in an order that depends on the tree's
  /// history.
  template <class Visit>
  void query(const Aabb<Real>& box, Visit&& visit) {
    stack_.clear();
    if (root_ != kNone) stack_.push_back(root_);
    while (!stack_.empty()) {
      const int index = stack_.back();
      stack_.pop_back();
      const Node& node = nodes_[index];
      if (!node.box.overlaps(box)) continue;
      if (index < leaf_count_) {
        visit(index);
      } else {
        stack_.push_back(node.children[0]);
        stack_.push_back(node.children[1]);
      }
    }
  }

  /// Returns the longest path from the root to a leaf, in nodes.
  int height() const;

  /// Returns true if every node's box surrounds its children's exactly and all links agree.
  bool valid() const;

 private:
  static constexpr int kNone = -1;

  // Nodes 0 .. leaf_count_ - 1 are leaves; the rest are inner ones, one fewer than leaves in use.
  struct Node {
    Aabb<Real> box{};
    int parent = kNone;
    int children[2] = {kNone, kNone};
    bool used = false;
  };

  int best_sibling(const Aabb<Real>& box) const;
  void insert(int leaf);
  void remove(int leaf);
  void refit_upwards(int index);
  void rotate(int index);
  void swap_subtrees(int a, int b);
  void replace_child(int parent, int from, int to);

  int leaf_count_;
  int root_ = kNone;
  std::vector<Node> nodes_;
  std::vector<int> free_;
  std::vector<int> stack_;
};

}  // namespace plumb
