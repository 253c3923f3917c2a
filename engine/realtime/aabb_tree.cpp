#include "engine/realtime/aabb_tree.h"

#include <algorithm>

namespace plumb {

template <class Real>
AabbTree<Real>::AabbTree(int count) : leaf_count_(count), nodes_(count > 0 ? 2 * count - 1 : 0) {
  for (int i = static_cast<int>(nodes_.size()) - 1; i >= count; --i) free_.push_back(i);
  stack_.reserve(64);
}

template <class Real>
void AabbTree<Real>::place(int leaf, const Aabb<Real>& box) {
  if (nodes_[leaf].used) remove(leaf);
  nodes_[leaf].box = box;
  nodes_[leaf].used = true;
  insert(leaf);
}

/// Descends to the node whose pairing with `box` costs least: the half perimeter added to it and to all nodes
/// above.
template <class Real>
int AabbTree<Real>::best_sibling(const Aabb<Real>& box) const {
  int index = root_;
  while (index >= leaf_count_) {
    const Node& node = nodes_[index];
    const Real joined = merged(node.box, box).half_perimeter();
    const Real inherited = joined - node.box.half_perimeter();
    Real cost[2];
    for (int i = 0; i < 2; ++i) {
      const Node& child = nodes_[node.children[i]];
      const Real with_box = merged(child.box, box).half_perimeter();
      const bool is_leaf = node.children[i] < leaf_count_;
      cost[i] = inherited + with_box - (is_leaf ? Real{0} : child.box.half_perimeter());
    }
    if (joined < cost[0] && joined < cost[1]) break;
    index = node.children[cost[0] < cost[1] ? 0 : 1];
  }
  return index;
}

template <class Real>
void AabbTree<Real>::insert(int leaf) {
  if (root_ == kNone) {
    root_ = leaf;
    nodes_[leaf].parent = kNone;
    return;
  }
  const int sibling = best_sibling(nodes_[leaf].box);
  const int parent = free_.back();
  free_.pop_back();
  Node& node = nodes_[parent];
  node.used = true;
  node.parent = nodes_[sibling].parent;
  node.children[0] = sibling;
  node.children[1] = leaf;
  if (node.parent == kNone) {
    root_ = parent;
  } else {
    replace_child(node.parent, sibling, parent);
  }
  nodes_[sibling].parent = nodes_[leaf].parent = parent;
  refit_upwards(parent);
}

template <class Real>
void AabbTree<Real>::remove(int leaf) {
  const int parent = nodes_[leaf].parent;
  nodes_[leaf].parent = kNone;
  if (parent == kNone) {
    root_ = kNone;
    return;
  }
  const Node node = nodes_[parent];
  const int sibling = node.children[node.children[0] == leaf ? 1 : 0];
  nodes_[sibling].parent = node.parent;
  if (node.parent == kNone) {
    root_ = sibling;
  } else {
    replace_child(node.parent, parent, sibling);
    refit_upwards(node.parent);
  }
  nodes_[parent] = {};
  free_.push_back(parent);
}

template <class Real>
void AabbTree<Real>::refit_upwards(int index) {
  for (; index != kNone; index = nodes_[index].parent) {
    Node& node = nodes_[index];
    node.box = merged(nodes_[node.children[0]].box, nodes_[node.children[1]].box);
    rotate(index);
  }
}

/// Swaps a child with a child of its sibling if that shrinks the sibling; picks the swap that shrinks it
/// most.
template <class Real>
void AabbTree<Real>::rotate(int index) {
  int best_child = kNone, best_grandchild = kNone;
  Real best_gain = 0;
  for (int i = 0; i < 2; ++i) {
    const int child = nodes_[index].children[i], other = nodes_[index].children[1 - i];
    if (other < leaf_count_) continue;
    for (int j = 0; j < 2; ++j) {
      const int grandchild = nodes_[other].children[j], stays = nodes_[other].children[1 - j];
      const Real gain =
          nodes_[other].box.half_perimeter() - merged(nodes_[child].box, nodes_[stays].box).half_perimeter();
      if (gain > best_gain) best_gain = gain, best_child = child, best_grandchild = grandchild;
    }
  }
  if (best_child != kNone) swap_subtrees(best_child, best_grandchild);
}

template <class Real>
void AabbTree<Real>::swap_subtrees(int a, int b) {
  const int parent_a = nodes_[a].parent, parent_b = nodes_[b].parent;
  replace_child(parent_a, a, b);
  replace_child(parent_b, b, a);
  nodes_[a].parent = parent_b;
  nodes_[b].parent = parent_a;
  Node& lower = nodes_[parent_b];
  lower.box = merged(nodes_[lower.children[0]].box, nodes_[lower.children[1]].box);
}

template <class Real>
void AabbTree<Real>::replace_child(int parent, int from, int to) {
  int(&children)[2] = nodes_[parent].children;
  children[children[0] == from ? 0 : 1] = to;
}

template <class Real>
int AabbTree<Real>::height() const {
  int highest = 0;
  for (int leaf = 0; leaf < leaf_count_; ++leaf) {
    if (!nodes_[leaf].used) continue;
    int height = 0;
    for (int index = leaf; index != kNone; index = nodes_[index].parent) ++height;
    highest = std::max(highest, height);
  }
  return highest;
}

template <class Real>
bool AabbTree<Real>::valid() const {
  for (int index = 0; index < static_cast<int>(nodes_.size()); ++index) {
    const Node& node = nodes_[index];
    if (!node.used) continue;
    if ((node.parent == kNone) != (index == root_)) return false;
    if (index < leaf_count_) continue;
    for (int child : node.children)
      if (nodes_[child].parent != index || !nodes_[child].used) return false;
    const Aabb<Real> box = merged(nodes_[node.children[0]].box, nodes_[node.children[1]].box);
    if (!(box.lower == node.box.lower && box.upper == node.box.upper)) return false;
  }
  return true;
}

template class AabbTree<float>;
template class AabbTree<double>;

}  // namespace plumb
