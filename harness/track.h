#pragma once

#include <cstddef>
#include <memory>
#include <optional>

namespace plumb::harness {

/// Poses of every body at some of a run's samples, with error bounds, for comparing engines. Stored in memory
/// that a forked child shares with its parent.
class Track {
 public:
  struct Point {
    double x = 0, y = 0;     ///< m
    double angle = 0;        ///< rad
    double bound = 0;        ///< m, bound on the engine's distance from the truth; negative: unknown
    double angle_bound = 0;  ///< rad, the same for the angle
  };

  /// Allocates memory for every `stride`-th of `steps` + 1 samples; chooses the stride such that they fit
  /// into `bytes`.
  Track(int steps, std::size_t bodies, std::size_t bytes = std::size_t{16} << 20);

  bool keeps(int sample) const { return sample % stride_ == 0; }
  void put(int sample, std::size_t body, const Point& point);

  struct Difference {
    double distance = 0;   ///< m or rad, at the largest ratio to the tolerance
    double tolerance = 0;  ///< the sum of the two bounds at that ratio
    bool agrees() const;
  };
  /// Returns the worst difference of two runs; nullopt if a bound is unknown. A NaN in a position or a bound
  /// is the worst.
  std::optional<Difference> worst_difference(const Track& other) const;

 private:
  int stride_ = 1;
  std::size_t bodies_, count_;
  std::shared_ptr<Point[]> points_;
};

}  // namespace plumb::harness
