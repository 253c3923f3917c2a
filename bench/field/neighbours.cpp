#include "bench/field/neighbours.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace plumb::field {

void for_each_meeting(std::span<const Bounds> boxes, const std::function<void(int, int)>& visit) {
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int i) { return boxes[i].low.x; });
  std::vector<int> open;
  for (const int i : order) {
    const Bounds& box = boxes[i];
    std::erase_if(open, [&](int j) { return boxes[j].high.x < box.low.x; });
    for (const int j : open)
      if (boxes[j].low.y <= box.high.y && box.low.y <= boxes[j].high.y) visit(std::min(i, j), std::max(i, j));
    open.push_back(i);
  }
}

}  // namespace plumb::field
