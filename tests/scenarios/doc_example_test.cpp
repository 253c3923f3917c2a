// The example of docs/adding-a-scenario.md is linked into this program, so it runs through the tests of every
// scenario as well.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "scenarios/scenario.h"

namespace plumb::scenarios {
namespace {

TEST(DocExample, IsAScenarioLikeAnyOther) {
  const auto instances = select("dumbbell");
  ASSERT_EQ(instances.size(), 1u);
  EXPECT_EQ(instances[0].label(), "dumbbell");
  EXPECT_EQ(instances[0].build().scene.joints.size(), 1u);
}

// Like every scenario in this program it has been through the tests of all.
TEST(NewScenario, IsAScenarioAsItIsWritten) { EXPECT_EQ(select("newly_written").size(), 1u); }

TEST(NewScenario, MayBeNamedAsAKeywordOfTheLanguage) { EXPECT_EQ(select("register").size(), 1u); }

TEST(DocExample, IsAtMostFortyLines) {
  std::ifstream file(PLUMB_DOC_EXAMPLE);
  ASSERT_TRUE(file) << PLUMB_DOC_EXAMPLE;
  int lines = 0;
  for (std::string line; std::getline(file, line);) ++lines;
  EXPECT_GT(lines, 10);
  EXPECT_LE(lines, 40);
}

}  // namespace
}  // namespace plumb::scenarios
