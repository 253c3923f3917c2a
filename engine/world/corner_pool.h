#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/geometry/convex.h"
#include "engine/scene/room.h"
#include "engine/world/checksum.h"

namespace plumb {

/// The corners of all shapes side by side; shapes whose corners are equal, bit by bit, share a run of them.
/// Runs that nobody uses any more are used again for runs of the same length. No order of a hash table
/// reaches a result: runs are found by what they hold.
template <class Real>
class CornerPool {
 public:
  /// Where a run of these corners begins.
  int add(std::span<const Corner<Real>> corners) {
    make_table();
    Run& found = table_[find(corners)];
    if (found.uses++ > 0) return found.first;
    const int count = static_cast<int>(corners.size());
    std::vector<int>& free = free_of(count);
    int first = static_cast<int>(corners_.size());
    if (free.empty()) {
      make_room(corners_, first + count);
    } else {
      first = free.back();
      free.pop_back();
    }
    std::copy(corners.begin(), corners.end(), corners_.begin() + first);
    found.first = first, found.count = count;
    ++runs_;
    return first;
  }

  /// Ends one use of a run.
  void remove(int first, int count) {
    std::size_t hole = find(run(first, count));
    if (--table_[hole].uses > 0) return;
    free_of(count).push_back(first);
    --runs_;
    // Later runs move back (Knuth, The Art of Computer Programming 3, 6.4, algorithm R).
    const std::size_t mask = table_.size() - 1;
    for (std::size_t at = (hole + 1) & mask; table_[at].uses > 0; at = (at + 1) & mask) {
      const std::size_t home = hash(run(table_[at].first, table_[at].count)) & mask;
      if (((at - home) & mask) < ((at - hole) & mask)) continue;
      table_[hole] = table_[at];
      hole = at;
    }
    table_[hole] = {};
  }

  /// After parts() were set: counts one use of a run. False when an equal run begins somewhere else.
  bool count_use(int first, int count) {
    make_table();
    Run& found = table_[find(run(first, count))];
    if (found.uses == 0) found.first = first, found.count = count, ++runs_;
    ++found.uses;
    return found.first == first;
  }

  const Corner<Real>* data() const { return corners_.data(); }
  std::span<const Corner<Real>> run(int first, int count) const {
    return {corners_.data() + first, static_cast<std::size_t>(count)};
  }

  /// Corners, and where free runs begin, by their length: with the uses of the runs, all that there is.
  auto parts() { return std::tie(corners_, free_); }
  auto parts() const { return std::tie(corners_, free_); }

 private:
  struct Run {
    int first = 0, count = 0;
    int uses = 0;  ///< 0: an empty place
  };

  std::vector<int>& free_of(int count) {
    const std::size_t length = static_cast<std::size_t>(count);
    if (free_.size() <= length) free_.resize(length + 1);
    return free_[length];
  }

  static std::size_t hash(std::span<const Corner<Real>> corners) {
    return static_cast<std::size_t>(checksum(std::as_bytes(corners)));
  }

  // The place of an equal run, or the empty one where it belongs.
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

  // Room for one more run in a table that is three quarters full at most.
  void make_table() {
    if (4 * (runs_ + 1) <= 3 * table_.size()) return;
    const std::vector<Run> old =
        std::exchange(table_, std::vector<Run>(std::max<std::size_t>(16, 2 * table_.size())));
    for (const Run& each : old) {
      if (each.uses > 0) table_[find(run(each.first, each.count))] = each;
    }
  }

  std::vector<Corner<Real>> corners_;
  std::vector<std::vector<int>> free_;
  std::vector<Run> table_;  // a power of two, or none
  std::size_t runs_ = 0;    // in use
};

}  // namespace plumb
