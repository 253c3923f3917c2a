#include <bit>

#include "engine/collide/dynamic_tree.h"

namespace plumb {
namespace {

/// Half the centre: it does not overflow, and neither do differences of two.
template <class Real>
Vec2<Real> half_center(const Aabb<Real>& box) {
  return {Real(0.25) * box.lower.x + Real(0.25) * box.upper.x,
          Real(0.25) * box.lower.y + Real(0.25) * box.upper.y};
}

template <class Real>
Aabb<Real> nothing() {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  return {{infinity, infinity}, {-infinity, -infinity}};
}

/// Which items go to the first of two children.
template <class Real>
class Splitter {
 public:
  using Node = TreeNode<Real>;
  static constexpr int kBins = 8;

  Splitter(Node* items, int count) : items_(items), count_(count) {
    Aabb<Real> centers = nothing<Real>();
    for (int i = 0; i < count; ++i) {
      const Vec2<Real> center = half_center(items[i].box);
      centers = merged(centers, {center, center});
    }
    const Vec2<Real> extent = centers.upper - centers.lower;
    along_ = extent.x >= extent.y ? &Vec2<Real>::x : &Vec2<Real>::y;
    start_ = centers.lower.*along_;
    extent_ = extent.*along_;
  }

  /// Whether all centres lie in one place.
  bool flat() const { return !(extent_ > 0); }

  /// Puts first what lies in the lower bins, at the border where the surface-area heuristic is least:
  /// (items below) (half perimeter below) + (items above) (half perimeter above), as in Wald 2007. Returns
  /// how many; neither side is empty.
  int by_bins() {
    scale_ = kBins / extent_;
    Aabb<Real> boxes[kBins];
    int counts[kBins] = {};
    std::fill(boxes, boxes + kBins, nothing<Real>());
    for (int i = 0; i < count_; ++i) {
      const int bin = bin_of(items_[i]);
      boxes[bin] = merged(boxes[bin], items_[i].box);
      ++counts[bin];
    }
    Real above[kBins];
    Aabb<Real> box = nothing<Real>();
    for (int bin = kBins - 1, sum = 0; bin > 0; --bin) {
      sum += counts[bin];
      box = merged(box, boxes[bin]);
      above[bin] = sum > 0 ? static_cast<Real>(sum) * box.half_perimeter() : 0;
    }
    box = nothing<Real>();
    int best = 0;
    Real best_cost = std::numeric_limits<Real>::infinity();
    for (int bin = 0, sum = 0; bin + 1 < kBins; ++bin) {
      sum += counts[bin];
      box = merged(box, boxes[bin]);
      if (sum == 0 || sum == count_) continue;
      const Real cost = static_cast<Real>(sum) * box.half_perimeter() + above[bin + 1];
      if (cost < best_cost) {
        best_cost = cost;
        best = bin;
      }
    }
    return partition([&](const Node& item) { return bin_of(item) <= best; });
  }

  /// Half of them each, in the order of their centres. The links tell equal ones apart.
  int by_count() {
    std::sort(items_, items_ + count_, [&](const Node& a, const Node& b) {
      const Real at_a = half_center(a.box).*along_, at_b = half_center(b.box).*along_;
      return at_a < at_b || (at_a == at_b && a.link < b.link);
    });
    return count_ / 2;
  }

 private:
  int bin_of(const Node& item) const {
    const Real place = (half_center(item.box).*along_ - start_) * scale_;
    return place < kBins ? static_cast<int>(place) : kBins - 1;
  }

  template <class Before>
  int partition(const Before& before) {
    int low = 0, high = count_;
    for (;;) {
      while (low < high && before(items_[low])) ++low;
      while (low < high && !before(items_[high - 1])) --high;
      if (low >= high) return low;
      std::swap(items_[low], items_[high - 1]);
    }
  }

  Node* items_;
  int count_;
  Real Vec2<Real>::*along_;
  Real start_, extent_, scale_ = 0;
};

}  // namespace

/// Takes the marked inner nodes apart (or all): their pairs become loose, what hangs below becomes an item.
template <class Real>
void DynamicTree<Real>::gather(bool everything) {
  loose_pairs_.clear();
  items_.clear();
  const auto take = [&](const Node& each) {
    if (!each.is_leaf() && (everything || each.tag != 0))
      loose_pairs_.push_back(each.link);
    else
      items_.push_back(each);
  };
  take(node(kRoot));
  for (std::size_t i = 0; i < loose_pairs_.size(); ++i)
    for (const Node& child : pairs_[loose_pairs_[i]].children) take(child);
}

template <class Real>
void DynamicTree<Real>::build(int slot, Node* items, int count, int budget) {
  if (count == 1) {
    put(slot, items[0]);
    return;
  }
  Splitter<Real> splitter(items, count);
  // Unequal halves cost height: when it is spent, halves are equal.
  const int half = count == 2 || splitter.flat() ? count / 2
                   : budget > 0                  ? splitter.by_bins()
                                                 : splitter.by_count();
  const int pair = loose_pairs_[next_loose_++];
  Node& here = node(slot);
  here.link = pair;
  here.tag = 0;
  adopt(slot);
  build(first(pair), items, half, budget - 1);
  build(first(pair) + 1, items + half, count - half, budget - 1);
  update(slot);
}

template <class Real>
int DynamicTree<Real>::build_gathered() {
  const int count = static_cast<int>(items_.size());
  next_loose_ = 0;
  build(kRoot, items_.data(), count, 2 * std::bit_width(static_cast<unsigned>(count)));
  return count;
}

template <class Real>
int DynamicTree<Real>::rebuild() {
  if (size_ == 0 || !node(kRoot).marked()) return 0;
  gather(false);
  return build_gathered();
}

template <class Real>
int DynamicTree<Real>::rebuild_all() {
  if (size_ < 2) return 0;
  gather(true);
  // Pairs 1, 2, ... in the order of building: each node's first child lies right behind its pair.
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
