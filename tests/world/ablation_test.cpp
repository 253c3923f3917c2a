#include "engine/world/ablation/ablation.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(Ablation, OrdinaryBuildsLeaveNothingOut) {
  EXPECT_FALSE(kAblation) << "this build has switches (-DPLUMB_ABLATION=ON)";
  for (int i = 0; i < static_cast<int>(Switch::Count); ++i) EXPECT_TRUE(enabled(static_cast<Switch>(i))) << i;
}

}  // namespace
}  // namespace plumb
