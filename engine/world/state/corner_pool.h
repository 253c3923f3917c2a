#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/core/capacity.h"
#include "engine/core/hash.h"
#include "engine/geometry/convex.h"
#include "engine/world/checksum.h"

namespace plumb {

/// Contiguous corners of all shapes. Shapes whose corners are bitwise equal share a run. Freed runs are
/// reused for runs of the same length. Results do not depend on the order of the hash table, because runs are
/// found by their contents.
template <class Real>
class CornerPool {
 public:
  /// Number of runs of each length.
  using Runs = std::array<std::size_t, kMaxCorners + 3>;

  /// Reserves memory for `more` runs, so that adding them, or removing any, does not allocate.
  void reserve_runs(const Runs& more) {
    std::size_t runs = 0, corners = 0, longest = 0;
    for (std::size_t length = 0; length < more.size(); ++length) {
      if (more[length] == 0) continue;
      runs += more[length], corners += more[length] * length, longest = length;
    }
    grow_table(runs);
    if (free_.size() <= longest) free_.resize(longest + 1);
    for (std::size_t length = 0; length <= longest; ++length) {
      if (more[length] > 0)
        ensure_capacity(free_[length], free_[length].size() + in_use_[length] + more[length]);
    }
    ensure_capacity(corners_, corners_.size() + corners);
  }

  /// Adds a use of a run of these corners, and returns its first index. If memory runs out, nothing changes.
  int add(std::span<const Corner<Real>> corners) {
    const int count = static_cast<int>(corners.size());
    reserve_run(corners.size());
    Run& found = table_[find(corners)];
    if (found.uses++ > 0) return found.first;
    std::vector<int>& free = free_[corners.size()];
    int first = static_cast<int>(corners_.size());
    if (free.empty()) {
      corners_.resize(corners_.size() + corners.size());
    } else {
      first = free.back();
      free.pop_back();
    }
    std::copy(corners.begin(), corners.end(), corners_.begin() + first);
    found.first = first, found.count = count;
    ++runs_, ++in_use_[corners.size()];
    return first;
  }

  /// Removes one use of a run.
  void remove(int first, int count) {
    std::size_t hole = find(run(first, count));
    if (--table_[hole].uses > 0) return;
    free_[static_cast<std::size_t>(count)].push_back(first);
    --runs_, --in_use_[static_cast<std::size_t>(count)];
    // Moves later runs back (Knuth, The Art of Computer Programming 3, 6.4, algorithm R).
    const std::size_t mask = table_.size() - 1;
    for (std::size_t at = (hole + 1) & mask; table_[at].uses > 0; at = (at + 1) & mask) {
      const std::size_t home = hash(run(table_[at].first, table_[at].count)) & mask;
      if (((at - home) & mask) < ((at - hole) & mask)) continue;
      table_[hole] = table_[at];
      hole = at;
    }
    table_[hole] = {};
  }

  /// Counts one use of a run after parts() were set. Returns false if an equal run begins elsewhere.
  bool count_use(int first, int count) {
    reserve_run(static_cast<std::size_t>(count));
    Run& found = table_[find(run(first, count))];
    if (found.uses == 0) {
      found.first = first, found.count = count;
      ++runs_, ++in_use_[static_cast<std::size_t>(count)];
    }
    ++found.uses;
    return found.first == first;
  }

  const Corner<Real>* data() const { return corners_.data(); }
  std::span<const Corner<Real>> run(int first, int count) const {
    return {corners_.data() + first, static_cast<std::size_t>(count)};
  }

  /// Corners, and first indices of free runs by their length. With the uses of the runs, this is the whole
  /// state.
  auto parts() { return std::tie(corners_, free_); }
  auto parts() const { return std::tie(corners_, free_); }

 private:
  struct Run {
    int first = 0, count = 0;
    int uses = 0;  ///< 0: an empty slot
  };

  void reserve_run(std::size_t length) {
    grow_table(1);
    if (free_.size() <= length) free_.resize(length + 1);
    ensure_capacity(free_[length], free_[length].size() + in_use_[length] + 1);
    ensure_capacity(corners_, corners_.size() + length);
  }

  // Mixes the upper bits into the lower ones, which choose the slot: coordinates with few digits hardly
  // change the lower bits of the checksum.
  static std::size_t hash(std::span<const Corner<Real>> corners) {
    return static_cast<std::size_t>(mixed_bits(checksum(std::as_bytes(corners))));
  }

  // Returns the slot of an equal run, or the empty slot where it belongs.
  std::size_t find(std::span<const Corner<Real>> corners) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t at = hash(corners) & mask;
    const auto is_other = [&](const Run& each) {
      return static_cast<std::size_t>(each.count) != corners.size() ||
             std::memcmp(corners_.data() + each.first, corners.data(), corners.size_bytes()) != 0;
    };
    while (table_[at].uses > 0 && is_other(table_[at])) at = (at + 1) & mask;
    return at;
  }

  // Grows the table for `more` runs, at most three quarters full.
  void grow_table(std::size_t more) {
    std::size_t size = std::max<std::size_t>(16, table_.size());
    while (4 * (runs_ + more) > 3 * size) size *= 2;
    if (size == table_.size()) return;
    const std::vector<Run> old = std::exchange(table_, std::vector<Run>(size));
    for (const Run& each : old) {
      if (each.uses > 0) table_[find(run(each.first, each.count))] = each;
    }
  }

  std::vector<Corner<Real>> corners_;
  std::vector<std::vector<int>> free_;
  std::vector<Run> table_;  // size: a power of two, or 0
  std::size_t runs_ = 0;    // runs in use
  Runs in_use_{};
};

}  // namespace plumb
