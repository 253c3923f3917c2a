#include "engine/core/suggest.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace plumb {
namespace {

const std::array<std::string, 5> kNames{"plumb", "box2d", "bullet", "free_fall", "pendulum_chain"};

TEST(Suggest, ForgivesOneSlipOfEachKind) {
  EXPECT_EQ(nearest("plumbb", kNames), "plumb");        // one too many
  EXPECT_EQ(nearest("plum", kNames), "plumb");          // one too few
  EXPECT_EQ(nearest("plump", kNames), "plumb");         // another
  EXPECT_EQ(nearest("bxo2d", kNames), "box2d");         // neighbours swapped
  EXPECT_EQ(nearest("Bullet", kNames), "bullet");       // upper case
  EXPECT_EQ(nearest("freefall", kNames), "free_fall");  // forgotten separator
  EXPECT_EQ(nearest("pendulum-chian", kNames), "pendulum_chain");
}

TEST(Suggest, ForgivesOneThirdOfTheLetters) {
  const std::array<std::string, 1> names{"box"};
  EXPECT_EQ(nearest("obx", names), "box");  // a swap is one slip, not two
  EXPECT_EQ(nearest("fox", names), "box");
  EXPECT_EQ(nearest("fix", names), "");
}

TEST(Suggest, TakesTheNearestAndTheFirstOfEquals) {
  const std::array<std::string, 3> names{"cart", "card", "cord"};
  EXPECT_EQ(nearest("carp", names), "cart");
  EXPECT_EQ(nearest("cords", names), "cord");
}

TEST(Suggest, KeepsSilentWhenNothingIsNear) {
  EXPECT_EQ(nearest("teapot", kNames), "");
  EXPECT_EQ(nearest("", kNames), "");
  EXPECT_EQ(nearest("x", std::array<std::string, 2>{"a", ""}), "");
  EXPECT_EQ(nearest("plumb", {}), "");
  EXPECT_EQ(nearest(std::string(1000000, 'p'), kNames), "");
}

TEST(Suggest, SaysIt) {
  EXPECT_EQ(did_you_mean("plum", kNames), "; did you mean 'plumb'?");
  EXPECT_EQ(did_you_mean("teapot", kNames), "; there are plumb, box2d, bullet, free_fall, pendulum_chain");
  EXPECT_EQ(did_you_mean("teapot", std::vector<std::string>(13, "plumb")), "");
  EXPECT_EQ(did_you_mean("teapot", {}), "");
}

}  // namespace
}  // namespace plumb
