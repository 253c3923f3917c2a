#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/collide/dynamic_tree_nodes.h"
#include "engine/geometry/aabb.h"

namespace plumb {

/// A binary tree of boxes that move: the broad phase's index. Each box (a leaf) belongs to categories, each
/// inner node knows the categories below it, and a query with a mask passes over subtrees that have none of
/// them. The tree changes in two ways: leaf by leaf (insert, remove, move), by the surface-area heuristic
/// (Goldsmith and Salmon 1987) with rotations on the way up (Kopta et al. 2012); and in bulk, by enlarging
/// boxes where they are and rebuilding from above what was enlarged. Queries are right at any time between.
///
/// Boxes have lower <= upper; a point is a box. A proxy names a leaf from insert() to remove(),
/// whatever moves in between; naming any other is outside the contract. The same calls give the same tree,
/// bit for bit, and visits in the same order. Queries may run at the same time as other queries.
template <class Real>
class DynamicTree {
 public:
  /// Every category: the mask that passes over nothing but leaves without a category.
  static constexpr std::uint32_t kAll = 0xffffffff;

  /// Returns the proxy: the one removed last, or the next new one.
  int insert(const Aabb<Real>& box, std::uint32_t category, int user);
  void remove(int proxy);
  /// The leaf is taken out and put back in where `box` belongs.
  void move(int proxy, const Aabb<Real>& box);
  /// Gives the leaf `box`, and grows the boxes above it in place until they contain it; marks them for
  /// rebuild(). Cheaper than move() by an order of magnitude, for boxes that move a little: a box that does
  /// not overlap the leaf's old one is moved.
  void enlarge(int proxy, const Aabb<Real>& box);
  void set_category(int proxy, std::uint32_t category);
  /// Has a leaf brought into the cache, and (when that is there) the node above it. Changes nothing.
  void ask_for(int proxy) const { __builtin_prefetch(&node(slots_[proxy])); }
  void ask_for_above(int proxy) const {
    const int above = node(slots_[proxy]).parent;
    if (above != kNone) __builtin_prefetch(&node(above));
  }

  /// Whether the proxy names a leaf.
  bool holds(int proxy) const {
    return proxy >= 0 && proxy < static_cast<int>(slots_.size()) && slots_[proxy] != kNone;
  }
  const Aabb<Real>& box(int proxy) const { return boxes_[proxy]; }
  int user(int proxy) const { return node(slots_[proxy]).tag; }
  std::uint32_t category(int proxy) const { return node(slots_[proxy]).category; }

  /// To be called after the enlarging of each step. Builds the marked part of the tree anew, from the root
  /// down to leaves and subtrees without a mark, split at the middle of the centres; its boxes are exact
  /// again. Puts that off until as many boxes were enlarged as nodes are marked: by then the tree is at most
  /// a few per cent worse, and the cost is shared by several steps. Where most of the tree is marked and its
  /// boxes, made exact where they are, are hardly larger than after the last building (what moves together
  /// keeps its neighbours), that is all. Returns how many leaves and subtrees were arranged.
  int rebuild();
  /// The same for the whole tree and at once; lays the nodes out in the order of a query. For use after
  /// loading many boxes.
  int rebuild_all();

  /// Calls visit(int user, int proxy) -> bool for each leaf whose box overlaps `box` (touching counts) and
  /// whose category shares a bit with `mask`, until it returns false.
  template <class Visit>
  void query(const Aabb<Real>& box, std::uint32_t mask, Visit&& visit) const;

  /// Which leaves meet others, all in one go: `meets`, by proxy, becomes 1 where the box of a leaf overlaps
  /// another leaf's, and 0 elsewhere. Where few meet this costs a fraction of a query for each. False, with
  /// marks missing, when it takes more than `most` comparisons of boxes: where many meet.
  bool mark_meetings(std::vector<char>& meets, int most) const;

  /// Sweeps a box of `half_extent` (zero for a ray) from `origin` by `translation`, m. Calls
  /// visit(int user, Real max_fraction) -> Real for leaves that the sweep meets at a fraction of at most
  /// max_fraction of the translation, nearer subtrees first; max_fraction starts at 1 and becomes what visit
  /// returns if that is less. Stops at 0. A leaf that exact arithmetic says is met is never missed.
  template <class Visit>
  void ray_cast(Vec2<Real> origin, Vec2<Real> translation, Vec2<Real> half_extent, std::uint32_t mask,
                Visit&& visit) const;

  /// Calls visit(int user, Real max_distance) -> Real for leaves whose boxes are within max_distance of
  /// `point`, m, nearer subtrees first; max_distance becomes what visit returns if that is less. Stops below
  /// 0.
  template <class Visit>
  void nearest(Vec2<Real> point, std::uint32_t mask, Real max_distance, Visit&& visit) const;

  /// Leaves in the tree.
  int size() const { return size_; }
  /// All proxies are below this.
  int proxies() const { return static_cast<int>(slots_.size()); }
  /// The longest way from the root to a leaf, in nodes; looks at every node.
  int height() const;
  /// Around all leaves; {0, 0} to {0, 0} when there are none.
  Aabb<Real> bounds() const { return size_ > 0 ? node(kRoot).box : Aabb<Real>{}; }
  /// Half the perimeter of all inner boxes over the root's: how many inner nodes a small query meets.
  double cost() const;
  /// Whether every link, box, category and mark is as it should be; looks at every node.
  bool valid() const;
  /// Removes all leaves; proxies start from 0 again. Room is kept.
  void clear();
  /// Makes room for `leaves` leaves, so that inserting and rebuilding them allocates nothing.
  void reserve(int leaves);
  /// Makes room for `more` leaves, likewise, with some over for those that follow.
  void make_room(std::size_t more);

  /// Appends all that decides what the tree does next, its free places included.
  void save(std::vector<std::byte>& out) const;
  /// Takes it from the front of `in`; what follows gives the same bits as in the tree that was saved. Throws
  /// Error (Value) and leaves the tree as it was when the bytes are damaged.
  void restore(std::span<const std::byte>& in);

 private:
  using Node = TreeNode<Real>;
  using Pair = TreePair<Real>;

  // A leaf or subtree to arrange: half its centre, and which one it is.
  struct Item {
    Vec2<Real> center;
    int place;
  };

  static constexpr int kNone = -1;
  static constexpr int kRoot = 0;
  // Ways down that a traversal may still have to take: never more than the height. Trees that are higher go
  // on without a stack, along the parents.
  static constexpr int kStack = 128;

  static int first(int pair) { return 2 * pair; }
  const Node& node(int slot) const { return pairs_[slot >> 1].children[slot & 1]; }
  Node& node(int slot) { return pairs_[slot >> 1].children[slot & 1]; }

  // Moves what is at a node to another slot, with the links that lead back to it.
  void put(int slot, Node content);
  void exchange(int a, int b);
  void adopt(int slot);
  int new_pair();
  void free_pair(int pair);
  bool update(int slot);

  int best_sibling(const Aabb<Real>& box, std::uint32_t ties) const;
  void insert_leaf(const Node& leaf);
  Node take_leaf(int proxy);
  bool rotate(int slot);

  bool refit();
  void gather(bool everything);
  void order_loose_pairs();
  void build(int slot, Item* items, int count, int budget);
  int build_gathered();

  // Goes to the nodes below `pair` that enter(node) lets in, along the parents, without a stack; false when
  // leaf(node) stopped it.
  template <class Enter, class Leaf>
  bool walk(int pair, const Enter& enter, const Leaf& leaf) const;
  // Branch and bound: of two nodes the one with the smaller bound(node) first, as long as reaches(bound)
  // holds.
  template <class Bound, class Reaches, class Leaf>
  void descend(const Bound& bound, const Reaches& reaches, const Leaf& leaf) const;

  bool inner_is_sound(int slot) const;
  bool leaf_is_sound(int slot) const;

  std::vector<Pair> pairs_;  // pair 0 holds the root and an unused node
  std::vector<int> slots_;   // proxy -> slot of its leaf
  // Proxy -> its leaf's box again. Leaves lie in the order of queries: who looks at a million proxies, one
  // after the other, would wait for each.
  std::vector<Aabb<Real>> boxes_;
  std::vector<int> free_pairs_, free_proxies_;
  int size_ = 0;
  std::int64_t enlargements_ = 0, marks_ = 0;  // since the last rebuild
  double usual_ = 0;                           // mean half perimeter of inner nodes when most were built

  // Scratch of rebuild().
  std::vector<int> loose_pairs_;
  std::vector<char> is_loose_;  // by pair
  std::vector<Node> held_;
  std::vector<Item> items_;
  int next_loose_ = 0;
  double built_ = 0;  // half perimeters of what is being built
};

}  // namespace plumb

#include "engine/collide/dynamic_tree_traverse.h"
