#include <algorithm>
#include <bit>

#include "engine/collision/broad_phase/dynamic_tree.h"

namespace plumb {
namespace {

/// Refitted boxes are kept while their mean half perimeter is below this multiple of that after the last
/// build; above it they would cost queries more than a rebuild saves.
constexpr double kMaxRefitGrowth = 1.1;
/// Pairs (1 MB in float) that fit into a cache, so that their order in memory does not matter.
constexpr std::size_t kCachedPairs = 1 << 14;
/// Prefetch distance, in nodes: nodes are scattered in memory.
constexpr int kAhead = 16;

/// Returns half of the box's centre: halves, and differences of two halves, do not overflow. Returns 0
/// instead of NaN (for infinite sides), so that all items can be sorted.
template <class Real>
Vec2<Real> half_center(const Aabb<Real>& box) {
  const auto half_middle = [](Real lower, Real upper) {
    const Real middle = Real(0.25) * lower + Real(0.25) * upper;
    return middle == middle ? middle : Real(0);
  };
  return {half_middle(box.lower.x, box.upper.x), half_middle(box.lower.y, box.upper.y)};
}

/// Moves the items below `middle` to the front and returns their number. Does not branch on an item's
/// position, which no processor can predict.
template <class Item, class Coordinate, class Real>
int partition(Item* items, int count, const Coordinate& coordinate, Real middle) {
  int low = 0;
  for (int i = 0; i < count; ++i) {
    const Item item = items[i];
    items[i] = items[low];
    items[low] = item;
    low += static_cast<int>(coordinate(item.center) < middle);
  }
  return low;
}

/// Sorts the items by their centres (equal ones by slot) and returns half of their number.
template <class Item, class Coordinate>
int halve(Item* items, int count, const Coordinate& coordinate) {
  std::sort(items, items + count, [&](const Item& a, const Item& b) {
    const auto at_a = coordinate(a.center), at_b = coordinate(b.center);
    return at_a < at_b || (at_a == at_b && a.place < b.place);
  });
  return count / 2;
}

/// Splits the items at the middle of their centres along the longer side. Returns how many belong to the
/// first child; neither side is empty. Unequal parts cost height: once `budget` is spent, parts are equal.
template <class Item>
int split(Item* items, int count, int budget) {
  if (count == 2) return 1;
  auto lower = items[0].center, upper = lower;
  for (int i = 1; i < count; ++i) {
    const auto center = items[i].center;
    lower = {std::min(lower.x, center.x), std::min(lower.y, center.y)};
    upper = {std::max(upper.x, center.x), std::max(upper.y, center.y)};
  }
  const auto divide = [&](const auto& coordinate) {
    using Real = decltype(lower.x);
    if (!(coordinate(lower) < coordinate(upper))) return count / 2;
    const Real middle = Real(0.5) * coordinate(lower) + Real(0.5) * coordinate(upper);
    const int low = budget > 0 ? partition(items, count, coordinate, middle) : 0;
    return low > 0 && low < count ? low : halve(items, count, coordinate);
  };
  using Center = decltype(lower);
  if (upper.x - lower.x >= upper.y - lower.y) return divide([](const Center& center) { return center.x; });
  return divide([](const Center& center) { return center.y; });
}

}  // namespace

/// Refits the boxes of the marked inner nodes, from below. Returns false when that is not enough.
template <class Real>
bool DynamicTree<Real>::refit() {
  if (2 * marks_ < size_ || !(mean_at_build_ > 0)) return false;
  std::vector<int>& marked = loose_pairs_;  // slots, parents first, in memory order
  marked.clear();
  marked.reserve(pairs_.capacity());
  // Visits the marked nodes depth first, the first child first, along the parents.
  for (int slot = kRoot; slot != kNone;) {
    if (node(slot).marked()) {
      marked.push_back(slot);
      slot = first(node(slot).link);
      continue;
    }
    while ((slot & 1) != 0) slot = node(slot).parent;
    slot = slot == kRoot ? kNone : slot + 1;
  }
  double sum = 0;
  for (std::size_t i = marked.size(); i-- > 0;) {
    update(marked[i]);
    sum += static_cast<double>(node(marked[i]).box.half_perimeter());
  }
  if (!(sum <= kMaxRefitGrowth * mean_at_build_ * static_cast<double>(marked.size()))) return false;
  for (const int slot : marked) node(slot).tag = 0;
  enlargements_ = marks_ = 0;
  return true;
}

/// Sorts the loose pairs. Most pairs are loose, so marking them in a list of all pairs takes a tenth of the
/// time of sorting.
template <class Real>
void DynamicTree<Real>::order_loose_pairs() {
  is_loose_.reserve(pairs_.capacity());
  is_loose_.assign(pairs_.size(), 0);
  for (const int pair : loose_pairs_) is_loose_[pair] = 1;
  std::size_t next = 0;
  for (std::size_t pair = 0; pair < pairs_.size(); ++pair)
    if (is_loose_[pair] != 0) loose_pairs_[next++] = static_cast<int>(pair);
}

/// Dissolves the marked inner nodes (or all): their pairs become loose, and the subtrees below are held.
template <class Real>
void DynamicTree<Real>::gather(bool everything) {
  loose_pairs_.clear();
  gathered_.clear();
  // Capacity for the whole tree at once: the marked part varies from step to step.
  loose_pairs_.reserve(pairs_.capacity());
  gathered_.reserve(pairs_.capacity());
  items_.reserve(pairs_.capacity());
  const auto take = [&](const Node& each) {
    if (!each.is_leaf() && (everything || each.tag != 0))
      loose_pairs_.push_back(each.link);
    else
      gathered_.push_back(each);
  };
  take(node(kRoot));
  for (std::size_t i = 0; i < loose_pairs_.size(); ++i) {
    if (i + kAhead < loose_pairs_.size()) __builtin_prefetch(&pairs_[loose_pairs_[i + kAhead]]);
    for (const Node& child : pairs_[loose_pairs_[i]].children) take(child);
  }
  // If the nodes do not fit into a cache, store them in the order in which they are built: that of a query.
  if (loose_pairs_.size() > kCachedPairs) order_loose_pairs();
}

template <class Real>
void DynamicTree<Real>::build(int slot, Item* items, int count, int budget) {
  if (kAhead / 2 < count && count <= kAhead)
    for (int i = 0; i < count; ++i) __builtin_prefetch(&gathered_[items[i].place]);
  if (count == 1) {
    put(slot, gathered_[items[0].place]);
    return;
  }
  const int half = split(items, count, budget);
  const int pair = loose_pairs_[next_loose_++];
  Node& here = node(slot);
  here.link = pair;
  here.tag = 0;
  update_links(slot);
  build(first(pair), items, half, budget - 1);
  build(first(pair) + 1, items + half, count - half, budget - 1);
  update(slot);
  built_ += static_cast<double>(node(slot).box.half_perimeter());
}

template <class Real>
int DynamicTree<Real>::build_gathered() {
  const int count = static_cast<int>(gathered_.size());
  items_.resize(gathered_.size());
  for (int i = 0; i < count; ++i) items_[i] = {half_center(gathered_[i].box), i};
  next_loose_ = 0;
  built_ = 0;
  enlargements_ = marks_ = 0;
  build(kRoot, items_.data(), count, 2 * std::bit_width(static_cast<unsigned>(count)));
  if (2 * next_loose_ >= size_) mean_at_build_ = built_ / next_loose_;
  return count;
}

template <class Real>
int DynamicTree<Real>::rebuild() {
  if (size_ == 0 || !node(kRoot).marked() || enlargements_ < marks_) return 0;
  if (refit()) return 0;
  gather(false);
  return build_gathered();
}

template <class Real>
int DynamicTree<Real>::rebuild_all() {
  if (size_ < 2) return 0;
  gather(true);
  // Numbers pairs 1, 2, ... in the order of building: each node's first child then lies right behind its
  // pair.
  free_pairs_.clear();
  pairs_.resize(static_cast<std::size_t>(size_));
  for (int i = 0; i + 1 < size_; ++i) loose_pairs_[i] = i + 1;
  return build_gathered();
}

template int DynamicTree<float>::rebuild();
template int DynamicTree<double>::rebuild();
template int DynamicTree<float>::rebuild_all();
template int DynamicTree<double>::rebuild_all();

}  // namespace plumb
