#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/collision/broad_phase/dynamic_tree_nodes.h"
#include "engine/geometry/aabb.h"

namespace plumb {

/// Dynamic tree: a binary tree of boxes that move, the index of the broad phase. Each leaf has categories,
/// each inner node the union of those below it, and a query with a mask skips subtrees without any of them.
/// The tree changes in two ways: leaf by leaf (insert, remove, move), by the surface-area heuristic
/// (Goldsmith and Salmon 1987) with rotations on the way up (Kopta et al. 2012); and in bulk, by enlarging
/// boxes in place and rebuilding all nodes above enlarged ones. Queries are correct at any time between.
///
/// Boxes have lower <= upper; a point is a box. A proxy names a leaf from insert() to remove(); other proxies
/// must not be used. The same calls give the same tree, bit for bit, and visits in the same order. Queries
/// may run concurrently with other queries.
template <class Real>
class DynamicTree {
 public:
  /// Mask of all categories: skips only leaves without a category.
  static constexpr std::uint32_t kAll = 0xffffffff;

  /// Returns the proxy: the one removed last, or the next new one.
  int insert(const Aabb<Real>& box, std::uint32_t category, int user);
  void remove(int proxy);
  /// Removes the leaf and inserts it again at the best place for `box`.
  void move(int proxy, const Aabb<Real>& box);
  /// Sets the leaf's box to `box`, grows the boxes above in place until they contain it, and marks them for
  /// rebuild(). Cheaper than move() by an order of magnitude for small moves. A box that does not overlap the
  /// leaf's old one is moved.
  void enlarge(int proxy, const Aabb<Real>& box);
  /// Prefetches a leaf and (once that is loaded) the node above it.
  void prefetch(int proxy) const { __builtin_prefetch(&node(slots_[proxy])); }
  void prefetch_parent(int proxy) const {
    const int above = node(slots_[proxy]).parent;
    if (above != kNone) __builtin_prefetch(&node(above));
  }

  /// Returns true if the proxy names a leaf.
  bool holds(int proxy) const {
    return proxy >= 0 && proxy < static_cast<int>(slots_.size()) && slots_[proxy] != kNone;
  }
  const Aabb<Real>& box(int proxy) const { return boxes_[proxy]; }
  int user(int proxy) const { return node(slots_[proxy]).tag; }
  std::uint32_t category(int proxy) const { return node(slots_[proxy]).category; }

  /// Rebuilds the marked part of the tree from the root down to unmarked leaves and subtrees, split at the
  /// middle of the centres; its boxes are exact again. Waits until as many boxes were enlarged as nodes are
  /// marked: the tree is then at most a few per cent worse, and several steps share the cost. If most of the
  /// tree is marked, first refits the boxes in place. That suffices if they are hardly larger than after the
  /// last build, as when all bodies move together. Returns how many leaves and subtrees were arranged.
  int rebuild();
  /// Rebuilds the whole tree at once and lays the nodes out in the order of a query. For use after loading
  /// many boxes.
  int rebuild_all();

  /// Calls visit(int user, int proxy) -> bool for each leaf whose box overlaps `box` (touching counts) and
  /// whose category shares a bit with `mask`, until it returns false.
  template <class Visit>
  void query(const Aabb<Real>& box, std::uint32_t mask, Visit&& visit) const;

  /// Makes a self-overlap pass: sets meets[proxy] to 1 for each leaf whose box overlaps another leaf's, and
  /// to 0 for the others. With few overlaps this costs a fraction of a query per leaf. Returns false, with
  /// marks missing, when it takes more than `most` comparisons of boxes.
  bool mark_self_overlaps(std::vector<char>& meets, int most) const;

  /// Sweeps a box of `half_extent` (zero for a ray) from `origin` by `translation`, m. Calls visit(int user,
  /// Real max_fraction) -> Real for leaves hit at a fraction of at most max_fraction of the translation,
  /// nearer subtrees first; max_fraction starts at 1 and becomes visit's result if that is less. Stops at 0.
  /// A leaf that is hit in exact arithmetic is never missed.
  template <class Visit>
  void ray_cast(Vec2<Real> origin, Vec2<Real> translation, Vec2<Real> half_extent, std::uint32_t mask,
                Visit&& visit) const;

  /// Calls visit(int user, Real max_distance) -> Real for leaves whose boxes are within max_distance of
  /// `point`, m, nearer subtrees first; max_distance becomes visit's result if that is less. Stops below 0.
  template <class Visit>
  void nearest(Vec2<Real> point, std::uint32_t mask, Real max_distance, Visit&& visit) const;

  /// Leaves in the tree.
  int size() const { return size_; }
  /// Returns an upper bound of all proxies, exclusive.
  int proxies() const { return static_cast<int>(slots_.size()); }
  /// Returns the longest path from the root to a leaf, in nodes; visits every node.
  int height() const;
  /// Returns the bounding box of all leaves; {0, 0} to {0, 0} if there are none.
  Aabb<Real> bounds() const { return size_ > 0 ? node(kRoot).box : Aabb<Real>{}; }
  /// Returns the sum of the half perimeters of all inner boxes over the root's: the mean number of inner
  /// nodes that a small query visits.
  double cost() const;
  /// Returns true if every link, box, category and mark is consistent; visits every node.
  bool valid() const;
  /// Removes all leaves; proxies start from 0 again. Capacity is kept.
  void clear();
  /// Reserves capacity for `leaves` leaves, so that inserting and rebuilding them allocates nothing.
  void reserve(int leaves);
  /// Reserves capacity for `more` leaves, with some over for those that follow.
  void reserve_more(std::size_t more);

  /// Appends the complete state, including free lists: everything that affects what the tree does later.
  void save(std::vector<std::byte>& out) const;
  /// Restores the state from the front of `in`; later calls give the same bits as in the saved tree. Throws
  /// Error (Value) and leaves the tree as it was when the bytes are damaged.
  void restore(std::span<const std::byte>& in);

 private:
  using Node = TreeNode<Real>;
  using Pair = TreePair<Real>;

  // A leaf or subtree to arrange: half its centre, and its index in `gathered_`.
  struct Item {
    Vec2<Real> center;
    int place;
  };

  static constexpr int kNone = -1;
  static constexpr int kRoot = 0;
  // Stack size of a traversal; never needs more than the height. Higher trees are traversed without a stack,
  // along the parents.
  static constexpr int kStack = 128;

  static int first(int pair) { return 2 * pair; }
  const Node& node(int slot) const { return pairs_[slot >> 1].children[slot & 1]; }
  Node& node(int slot) { return pairs_[slot >> 1].children[slot & 1]; }

  // Moves a node to another slot and updates the links that lead back to it.
  void put(int slot, Node content);
  void swap_nodes(int a, int b);
  void update_links(int slot);
  int new_pair();
  void free_pair(int pair);
  bool update(int slot);

  int best_sibling(const Aabb<Real>& box, std::uint32_t ties) const;
  void insert_leaf(const Node& leaf);
  Node remove_leaf(int proxy);
  bool rotate(int slot);

  bool refit();
  void gather(bool everything);
  void order_loose_pairs();
  void build(int slot, Item* items, int count, int budget);
  int build_gathered();

  // Visits the nodes below `pair` for which enter(node) returns true, along the parents, without a stack.
  // Returns false when leaf(node) stopped it.
  template <class Enter, class Leaf>
  bool traverse_stackless(int pair, const Enter& enter, const Leaf& leaf) const;
  // Traverses by branch and bound: visits the node with the smaller bound(node) first, while reaches(bound)
  // holds.
  template <class Bound, class Reaches, class Leaf>
  void traverse_nearest_first(const Bound& bound, const Reaches& reaches, const Leaf& leaf) const;

  bool is_valid_inner(int slot) const;
  bool is_valid_leaf(int slot) const;

  std::vector<Pair> pairs_;  // pair 0 holds the root and an unused node
  std::vector<int> slots_;   // proxy -> slot of its leaf
  // Proxy -> copy of its leaf's box. Leaves lie in the order of queries: a loop over a million proxies would
  // have a cache miss for each.
  std::vector<Aabb<Real>> boxes_;
  std::vector<int> free_pairs_, free_proxies_;
  int size_ = 0;
  std::int64_t enlargements_ = 0, marks_ = 0;  // since the last rebuild
  double mean_at_build_ = 0;                   // mean half perimeter of inner nodes when most were built

  // Scratch of rebuild().
  std::vector<int> loose_pairs_;
  std::vector<char> is_loose_;  // by pair
  std::vector<Node> gathered_;
  std::vector<Item> items_;
  int next_loose_ = 0;
  double built_ = 0;  // half perimeters of the part being built
};

}  // namespace plumb

#include "engine/collision/broad_phase/dynamic_tree_traverse.h"
