#include "harness/reality/published/published_law.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace plumb::harness::reality {
namespace {

PublishedLaw law_called(const std::string& name) {
  for (PublishedLaw& law : published_laws())
    if (law.name == name) return law;
  ADD_FAILURE() << name;
  return {};
}

TEST(PublishedLaws, HaveBandsAndSources) {
  for (const PublishedLaw& law : published_laws()) {
    EXPECT_LT(law.low, law.high) << law.name;
    EXPECT_FALSE(law.source.empty() || law.quantity.empty()) << law.name;
  }
}

TEST(PublishedLaws, RunOutEndsWhereRodsHaveRolledAwayAlone) {
  const PublishedLaw law = law_called("column_collapse[1]");
  // Rods side by side up to x = 3, one at 10 m, and one that went through the wall; the column was 1.2 m
  // wide.
  Sample last(law.scene.bodies.size());
  for (std::size_t i = 2; i < last.size(); ++i)
    last[i].position.x = std::min(3.0, 0.05 + 0.1 * static_cast<double>(i - 2));
  last.back().position.x = 10;
  last[2].position.x = -4;
  EXPECT_NEAR(law.measure(std::vector<Sample>{last}), (3 + 0.05) / 1.2 - 1, 1e-9);
}

TEST(PublishedLaws, PreciseRocksAsHousnerSays) {
  const std::vector<const reference::Backend*> engines{&reference::find_backend("plumb-precise")};
  for (const PublishedFinding& found : examine_published(engines)) {
    if (found.law != "rocking_block") continue;
    EXPECT_TRUE(found.inside()) << found.value << " " << found.why_not;
    // The samples are 1/240 s apart, in which a turning block falls by less than a thousandth of its tilt.
    EXPECT_NEAR(found.value, (found.low + found.high) / 2, 1e-3 * found.high);
  }
}

}  // namespace
}  // namespace plumb::harness::reality
