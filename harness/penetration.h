#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/separation.h"

namespace plumb::harness {

/// Finds the deepest penetration among the shapes that may touch, by sort and sweep along x (Baraff 1992).
/// The order is kept from sample to sample, so that a sample costs little more than one pass over the shapes.
class PenetrationMeter {
 public:
  explicit PenetrationMeter(const Scene& scene);

  /// Returns true if any two shapes may touch at all.
  bool possible() const { return possible_; }

  /// Returns the depth of the deepest penetration, m, >= 0.
  double deepest(std::span<const BodyState> states);

 private:
  struct Entry {
    std::size_t body;
    bool moves;
    const Shape* shape;
    PlacedShape placed{};
    double low = 0, high = 0;  // m, along x
  };

  bool pair_may_touch(const Entry& a, const Entry& b) const;
  void place(std::span<const BodyState> states);

  std::vector<Entry> entries_;
  std::set<std::pair<std::size_t, std::size_t>> jointed_;  // bodies whose joint keeps them from touching
  bool possible_ = false;
};

}  // namespace plumb::harness
