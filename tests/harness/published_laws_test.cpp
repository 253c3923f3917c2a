#include "harness/reality/published/published_law.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "harness/reality/published/domino_row.h"

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

TEST(PublishedLaws, RowOfDominoesTopplesAsFastAsInVanLeeuwensTable) {
  // Speeds over sqrt(g h) by a copy of his program, which takes steps of a hundredth of the turn and the last
  // one beyond it: up to 1/400 of the time. Blocks of 48 mm x 7.5 mm, friction 0.25.
  const struct {
    double gap, speed;
  } rows[] = {{0.100, 1.468}, {0.204, 1.380}, {0.309, 1.321}, {0.406, 1.276}, {0.503, 1.230}, {0.600, 1.180}};
  for (const auto& row : rows)
    EXPECT_NEAR(toppling_speed({1, 7.5 / 48, row.gap, 0.25, 1}), row.speed, row.speed / 400);
  EXPECT_EQ(toppling_speed({1, 7.5 / 48, 0.01, 2, 1}), 0) << "with much friction the wave stops";
}

TEST(PublishedLaws, ReboundIsTheHighestPointAfterTheImpact) {
  const PublishedLaw law = law_called("bouncing_ball[tennis]");
  std::vector<Sample> samples(6, Sample(2));
  const double heights[] = {3, 2, 0.1, 0.9, 1.4, 1.3};
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i][1].position.y = heights[i];
  EXPECT_NEAR(law.measure(samples), 1.4 - 0.033, 1e-12);
}

TEST(PublishedLaws, SpeedOfDominoesIsMeasuredFarFromThePush) {
  const PublishedLaw law = law_called("dominoes[2]");
  // Domino i turns at 1 rad/s from 0.05 i s on.
  std::vector<Sample> samples;
  for (int step = 0; step < 600; ++step) {
    Sample& sample = samples.emplace_back(law.scene.bodies.size());
    for (std::size_t i = 1; i < sample.size(); ++i)
      sample[i].angle = -std::max(0.0, step * law.dt - 0.05 * static_cast<double>(i));
  }
  EXPECT_NEAR(law.measure(samples), 3 * 0.075 / 0.05 / std::sqrt(9.81 * 0.48), 1e-9);
  EXPECT_EQ(law.measure(std::vector<Sample>(600, samples.front())), 0) << "nothing moves";
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
  const std::vector<PublishedLaw> laws{law_called("rocking_block")};
  for (const PublishedFinding& found : examine_published(laws, engines)) {
    EXPECT_TRUE(found.inside()) << found.value << " " << found.why_not;
    // The samples are 1/240 s apart, in which a turning block falls by less than a thousandth of its tilt.
    EXPECT_NEAR(found.value, (found.low + found.high) / 2, 1e-3 * found.high);
  }
}

}  // namespace
}  // namespace plumb::harness::reality
