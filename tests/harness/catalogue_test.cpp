#include "harness/catalogue.h"

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace plumb::harness {
namespace {

TEST(Catalogue, IsListedInTheDocuments) {
  std::ifstream file(PLUMB_SOURCE_DIR "/docs/scenarios.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, catalogue_page()) << "write it anew: plumb list --page > docs/scenarios.md";
}

TEST(Catalogue, HasSixtyCasesAndMoreInFortyFiveFiles) {
  EXPECT_GE(catalogue().size(), 60u);
  EXPECT_GE(scenarios::all().size(), 45u);
}

TEST(Catalogue, FindsCasesByTextAndByTruth) {
  const auto found = catalogue({.text = "PENDULUM", .truth = "integrated"});
  ASSERT_FALSE(found.empty());
  for (const CatalogueEntry& entry : found) EXPECT_EQ(entry.kind, scenarios::TruthKind::Integrated);
  EXPECT_TRUE(catalogue({.text = "no such text"}).empty());
}

TEST(Catalogue, TellsTopicsByTheScene) {
  for (const CatalogueEntry& entry : catalogue()) {
    const auto expect = [&](std::string_view label, Topic topic) {
      EXPECT_TRUE(entry.instance.label() != label || entry.topic == topic) << label;
    };
    expect("ramp_block/slips", Topic::LastingContacts);
    expect("ramp_block/holds", Topic::LastingContacts);
    expect("kepler", Topic::Forces);
    expect("atwood", Topic::Joints);
    expect("struck_rod/elastic", Topic::Impacts);
    expect("free_fall/vacuum", Topic::FreeMotion);
    expect("overhang[5]", Topic::Equilibrium);
  }
}

}  // namespace
}  // namespace plumb::harness
