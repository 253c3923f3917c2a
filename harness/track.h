#pragma once

#include <cstddef>
#include <memory>
#include <optional>

namespace plumb::harness {

/// Where an engine had every body and how it was turned, and how sure that is, on some of a run's samples:
/// what engines are compared by. Lies in memory that a forked child shares with its parent.
class Track {
 public:
  struct Point {
    double x = 0, y = 0;     ///< m
    double angle = 0;        ///< rad
    double bound = 0;        ///< m, distance from the truth that the engine is allowed; negative: not known
    double angle_bound = 0;  ///< rad, likewise
  };

  /// Room for every `stride`-th of `steps` + 1 samples; the stride is chosen so that it fits into `bytes`.
  Track(int steps, std::size_t bodies, std::size_t bytes = std::size_t{16} << 20);

  bool keeps(int sample) const { return sample % stride_ == 0; }
  void put(int sample, std::size_t body, const Point& point);

  struct Difference {
    double distance = 0;   ///< m or rad, where it is the largest share of what is allowed
    double tolerance = 0;  ///< the sum of the two bounds there
    bool agrees() const;
  };
  /// The worst difference of two runs; nothing where no bound is known. A place or a bound that is NaN is the
  /// worst.
  std::optional<Difference> worst_difference(const Track& other) const;

 private:
  int stride_ = 1;
  std::size_t bodies_, count_;
  std::shared_ptr<Point[]> points_;
};

}  // namespace plumb::harness
