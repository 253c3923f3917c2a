#include "bench/field/neighbours.h"

#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumb::field {
namespace {

TEST(ForEachMeeting, FindsWhatAllPairsFind) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0, 20), size(0, 2);
  std::vector<Bounds> boxes;
  for (int i = 0; i < 300; ++i) {
    const Vec2d low{place(random), place(random)};
    boxes.push_back({low, low + Vec2d{size(random), size(random)}});
  }
  boxes.push_back({{-5, 3}, {50, 4}});
  std::set<std::pair<int, int>> expected;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(boxes.size()); ++j)
      if (boxes[i].low.x <= boxes[j].high.x && boxes[j].low.x <= boxes[i].high.x &&
          boxes[i].low.y <= boxes[j].high.y && boxes[j].low.y <= boxes[i].high.y)
        expected.insert({i, j});
  std::set<std::pair<int, int>> found;
  for_each_meeting(boxes, [&](int i, int j) {
    EXPECT_LT(i, j);
    EXPECT_TRUE(found.insert({i, j}).second) << "twice";
  });
  EXPECT_EQ(found, expected);
}

TEST(ForEachMeeting, TouchingEdgesMeet) {
  const std::vector<Bounds> boxes{{{0, 0}, {1, 1}}, {{1, 1}, {2, 2}}};
  int met = 0;
  for_each_meeting(boxes, [&](int, int) { ++met; });
  EXPECT_EQ(met, 1);
}

}  // namespace
}  // namespace plumb::field
