#include "demos/window/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <tuple>
#include <vector>

namespace plumb::window {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Returns the labels of characters of 7 px by 13 px in a picture of 200 px by 100 px, as text, x and y.
std::vector<std::tuple<std::string, double, double>> shown(const std::vector<Label>& labels) {
  std::vector<std::tuple<std::string, double, double>> out;
  for (const Label& label : placed(labels, {7, 13}, {200, 100}))
    out.emplace_back(label.text, label.pixel.x, label.pixel.y);
  return out;
}

using Shown = std::tuple<std::string, double, double>;

TEST(Labels, StandAbovePointsAndBelowThoseAlreadyLabelled) {
  EXPECT_THAT(shown({{{100, 50}, "frame"}, {{100, 50}, "ball"}, {{100, 50}, "1 kg"}}),
              ElementsAre(Shown{"frame", 100, 50}, Shown{"ball", 100, 63}));
}

// Of bodies one below another, closer than a text is high, a text that finds no place is left out.
TEST(Labels, DoNotCoverEachOtherInAPile) {
  EXPECT_THAT(shown({{{50, 20}, "a"}, {{50, 26}, "b"}, {{50, 32}, "c"}, {{50, 52}, "d"}}),
              ElementsAre(Shown{"a", 50, 20}, Shown{"b", 50, 39}, Shown{"d", 50, 52}));
  // Beside each other, widths count: 4 characters reach 14 px to each side.
  EXPECT_THAT(shown({{{50, 20}, "2 kg"}, {{78, 20}, "2 kg"}}),
              ElementsAre(Shown{"2 kg", 50, 20}, Shown{"2 kg", 78, 20}));
  EXPECT_THAT(shown({{{50, 20}, "2 kg"}, {{77, 20}, "2 kg"}}),
              ElementsAre(Shown{"2 kg", 50, 20}, Shown{"2 kg", 77, 33}));
}

TEST(Labels, AreNotCutByTheEdge) {
  EXPECT_THAT(shown({{{3, 50}, "wall"}, {{198, 50}, "wall"}, {{100, 4}, "top"}, {{100, 100}, "low"}}),
              ElementsAre(Shown{"wall", 14, 50}, Shown{"wall", 186, 50}, Shown{"top", 100, 17},
                          Shown{"low", 100, 100}));
  EXPECT_THAT(shown({{{-1, 50}, "out"}, {{100, 101}, "out"}}), IsEmpty());
  EXPECT_THAT(shown({{{std::numeric_limits<double>::quiet_NaN(), 50}, "lost"}}), IsEmpty());
}

}  // namespace
}  // namespace plumb::window
