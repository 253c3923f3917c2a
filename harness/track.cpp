#include "harness/track.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <sys/mman.h>

#include "engine/scene/error.h"

namespace plumb::harness {

Track::Track(int steps, std::size_t bodies, std::size_t bytes) : bodies_(bodies) {
  const std::size_t sample = std::max<std::size_t>(1, bodies) * sizeof(Point);
  const std::size_t room = std::max<std::size_t>(2, bytes / sample);
  stride_ = std::max(1, static_cast<int>((static_cast<std::size_t>(steps) + room) / room));
  count_ = (static_cast<std::size_t>(steps / stride_) + 1) * bodies_;
  const std::size_t size = std::max<std::size_t>(1, count_) * sizeof(Point);
  void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw Error(Error::Kind::Run, "the run", "", std::to_string(size), "does not fit into memory");
  points_ = {static_cast<Point*>(memory), [size](Point* points) { munmap(points, size); }};
}

void Track::put(int sample, std::size_t body, const Point& point) {
  points_[static_cast<std::size_t>(sample / stride_) * bodies_ + body] = point;
}

bool Track::Difference::agrees() const { return distance <= tolerance; }

std::optional<Track::Difference> Track::worst_difference(const Track& other) const {
  std::optional<Difference> worst;
  double worst_share = -1;
  for (std::size_t i = 0; i < std::min(count_, other.count_); ++i) {
    const Point &a = points_[i], &b = other.points_[i];
    if (a.bound < 0 || b.bound < 0) return {};
    const double angle_tolerance =
        std::min(a.angle_bound, b.angle_bound) < 0 ? -1 : a.angle_bound + b.angle_bound;
    const Difference differences[] = {{std::hypot(a.x - b.x, a.y - b.y), a.bound + b.bound},
                                      {std::abs(a.angle - b.angle), angle_tolerance}};
    for (const Difference& difference : differences) {
      if (difference.tolerance < 0) continue;
      // A NaN in a position or a bound agrees with nothing.
      if (std::isnan(difference.distance) || std::isnan(difference.tolerance)) return difference;
      const double share = difference.distance == 0 ? 0 : difference.distance / difference.tolerance;
      if (share <= worst_share) continue;
      worst_share = share;
      worst = difference;
    }
  }
  return worst;
}

}  // namespace plumb::harness
