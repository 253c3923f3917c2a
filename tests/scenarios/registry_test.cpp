#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "engine/scene/error.h"
#include "scenarios/scenario.h"

namespace plumb::scenarios {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

std::vector<std::string> labels(const std::vector<Instance>& instances) {
  std::vector<std::string> labels;
  for (const Instance& instance : instances) labels.push_back(instance.label());
  return labels;
}

Error error_of(std::string_view name, int size = 0) {
  try {
    select(name, size);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << name << " was accepted";
  return {Error::Kind::Io, "", "", "", ""};
}

TEST(Registry, HoldsEveryScenarioByName) {
  std::vector<std::string> names;
  for (const Scenario& scenario : all()) names.push_back(scenario.name);
  EXPECT_TRUE(std::ranges::is_sorted(names));
  EXPECT_THAT(names, IsSupersetOf({"elastic_collision", "free_fall", "off_centre_torque", "pendulum_chain"}));
}

TEST(Registry, SelectsVariantsAndSizes) {
  EXPECT_THAT(labels(select("free_fall")), ElementsAre("free_fall/vacuum", "free_fall/drag"));
  EXPECT_THAT(labels(select("free_fall/drag")), ElementsAre("free_fall/drag"));
  EXPECT_THAT(labels(select("free_fall/drag[1]")), ElementsAre("free_fall/drag"));
  EXPECT_THAT(labels(select("pendulum_chain")),
              ElementsAre("pendulum_chain[1]", "pendulum_chain[2]", "pendulum_chain[5]", "pendulum_chain[20]",
                          "pendulum_chain[100]"));
  EXPECT_THAT(labels(select("pendulum_chain[7]")), ElementsAre("pendulum_chain[7]"));
  EXPECT_THAT(labels(select("pendulum_chain", 7)), ElementsAre("pendulum_chain[7]"));
  EXPECT_THAT(labels(select("pendulum_chain[7]", 7)), ElementsAre("pendulum_chain[7]"));
}

TEST(Registry, LabelsSelectThemselves) {
  for (const Scenario& scenario : all())
    for (const Instance& instance : select(scenario.name))
      EXPECT_THAT(labels(select(instance.label())), ElementsAre(instance.label()));
}

TEST(Registry, SuggestsTheNearestName) {
  EXPECT_STREQ(error_of("pendulum_chian").what(),
               "scenario 'pendulum_chian': there is none by this name; did you mean 'pendulum_chain'?");
  EXPECT_EQ(error_of("pendulum_chian").kind(), Error::Kind::Name);
  const Error variant = error_of("free_fall/vacum");
  EXPECT_EQ(variant.kind(), Error::Kind::Name);
  EXPECT_EQ(variant.subject(), "scenario 'free_fall'");
  EXPECT_EQ(variant.field(), "variant");
  EXPECT_EQ(variant.value(), "vacum");
  EXPECT_THAT(variant.problem(), HasSubstr("did you mean 'vacuum'?"));
  EXPECT_EQ(error_of("").kind(), Error::Kind::Name);
  EXPECT_EQ(error_of("free_fall/").kind(), Error::Kind::Name);
  EXPECT_EQ(error_of("pendulum_chain/[5]").kind(), Error::Kind::Name);
}

TEST(Registry, RefusesSizesThatMakeNoSense) {
  for (const char* name :
       {"pendulum_chain[0]", "pendulum_chain[-3]", "pendulum_chain[x]", "pendulum_chain[]",
        "pendulum_chain[5", "pendulum_chain[5]x", "pendulum_chain[99999999999]", "pendulum_chain[2.5]",
        "pendulum_chain[5][5]", "free_fall[3]", "free_fall/drag[3]"}) {
    const Error error = error_of(name);
    EXPECT_EQ(error.kind(), Error::Kind::Value) << name;
    EXPECT_EQ(error.field(), "size") << name;
  }
  EXPECT_THAT(error_of("free_fall", 3).what(), HasSubstr("does not scale"));
  EXPECT_THAT(error_of("pendulum_chain[5]", 20).what(), HasSubstr("contradicts the size 20"));
}

TEST(Scenarios, AreFilesOfAtMostFortyLines) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PLUMB_SOURCE_DIR "/scenarios")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream file(entry.path());
    const auto lines = std::count(std::istreambuf_iterator<char>(file), {}, '\n');
    EXPECT_LE(lines, 40) << entry.path();
    EXPECT_GT(lines, 10) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 60);
}

}  // namespace
}  // namespace plumb::scenarios
