#include "harness/sweep/importance.h"

#include <algorithm>
#include <span>

namespace plumb::harness::sweep {
namespace {

// Repeatedly takes the middle of each remaining part, so that the first few points are spread over the whole.
void spread(std::span<const Point> points, std::vector<Point>& out) {
  std::vector<std::span<const Point>> left{points};
  for (std::size_t i = 0; i < left.size(); ++i) {
    const std::span<const Point> part = left[i];
    if (part.empty()) continue;
    const std::size_t middle = part.size() / 2;
    out.push_back(part[middle]);
    left.push_back(part.first(middle));
    left.push_back(part.subspan(middle + 1));
  }
}

}  // namespace

std::vector<Point> by_importance(std::vector<Point> points) {
  std::vector<Point> out;
  while (!points.empty()) {
    const std::vector<Point> front = front_of(points);
    out.push_back(front.front());
    if (front.size() > 1) {
      out.push_back(front.back());
      spread(std::span(front).subspan(1, front.size() - 2), out);
    }
    std::erase_if(points, [&](const Point& point) {
      return std::any_of(front.begin(), front.end(),
                         [&](const Point& other) { return other.row == point.row; });
    });
  }
  return out;
}

}  // namespace plumb::harness::sweep
