#include "harness/reality/reality.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "tests/harness/made_up_measurements.h"

namespace plumb::harness::reality {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(RealitySample, HalvesAreRandomCompleteAndTheSameForASeed) {
  const Halves halves = halves_of(101, 4);
  EXPECT_EQ(halves.train.size(), 50u);
  EXPECT_EQ(halves.test.size(), 51u);
  std::vector<std::size_t> all = halves.train;
  all.insert(all.end(), halves.test.begin(), halves.test.end());
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], i);
  EXPECT_EQ(halves_of(101, 4).train, halves.train);
  EXPECT_NE(halves_of(101, 5).train, halves.train);
}

TEST(RealitySample, QuantilesAndTheMiddleHalf) {
  EXPECT_DOUBLE_EQ(quantile({3, 1, 2, 4}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({5, 1, 2, 3, 4}, 0.9), 4.6);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.5), 7);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_DOUBLE_EQ(middle_mean({1e9, 1, 3, 2, 4, -1e9, 2, 3}), 2.5);
}

TEST(RealitySample, BootstrapIntervalOfAMedianIsAsWideAsTheorySays) {
  // Of n uniform values the median's standard error is 1 / (2 sqrt(n)).
  std::vector<double> values;
  for (int i = 0; i < 900; ++i) values.push_back((i + 0.5) / 900);
  const Estimate found = estimate(values, 0.5, 3);
  EXPECT_NEAR(found.value, 0.5, 1e-3);
  EXPECT_NEAR(found.high - found.low, 2 * 1.96 / (2 * std::sqrt(900.0)), 0.01);
}

TEST(RealityFit, FindsTheLeastOfACurvedValley) {
  const std::vector<Parameter> parameters{{"x", "", -1.2, 0.3, -5, 5}, {"y", "", 1, 0.3, -5, 5}};
  const Fit fit = minimise(parameters, 1000, [](std::span<const double> v) {
    return 1 + 100 * std::pow(v[1] - v[0] * v[0], 2) + std::pow(1 - v[0], 2);
  });
  EXPECT_NEAR(fit.values[0], 1, 1e-2);
  EXPECT_NEAR(fit.values[1], 1, 1e-2);
}

TEST(RealityFit, StaysWithinTheBounds) {
  const std::vector<Parameter> parameters{{"x", "", 0.9, 0.3, 0, 1}};
  const Fit fit = minimise(parameters, 200, [](std::span<const double> v) { return 5 - v[0]; });
  EXPECT_EQ(fit.values[0], 1);
}

TEST(RealityEllipse, FindsTheLawAndTheValuesThatTheImpactsWereMadeWith) {
  const std::vector<EllipseLaw>& laws = ellipse_laws();
  const auto made_with =
      std::find_if(laws.begin(), laws.end(), [](const EllipseLaw& law) { return law.name == "poisson"; });
  ASSERT_NE(made_with, laws.end());
  const std::vector<double> values{3.7e-4, 0.17, 0.62};
  const EllipseFindings findings = examine_ellipse(made_up(*made_with, values), 1);
  EXPECT_EQ(findings.impacts, 400);
  EXPECT_EQ(findings.doubted, 40);
  const EllipseFinding& found = findings.laws[static_cast<std::size_t>(made_with - laws.begin())];
  EXPECT_NEAR(found.values[0], values[0], 2e-6);
  EXPECT_NEAR(found.values[1], values[1], 2e-3);
  EXPECT_NEAR(found.values[2], values[2], 4e-3);
  EXPECT_LT(found.median.value, 0.01) << "noise alone";
  EXPECT_LT(found.median.low, found.median.value);
  EXPECT_GT(found.median.high, found.median.value);
  EXPECT_GT(findings.laws[0].ninetieth.value, 3 * found.ninetieth.value)
      << "Newton's law is told apart where the slip stops";
  EXPECT_LE(findings.bound.median.value, found.median.value);
}

TEST(RealityDrops, StartIsTheParabolaBeforeTheFirstImpact) {
  // A square that falls with these velocities and rebounds at frame 12.
  MeasuredDrop drop{1, {}};
  const double vx = -0.4, vy = -1.5, w = 2, g = 9.81;
  for (int i = 0; i < 60; ++i) {
    const double t = (i - 12) / kFramesPerSecond;
    const double y = t < 0 ? 0.05 + (vy - 0.47) * t - g * t * t / 2 : 0.05 + 1.2 * t - g * t * t / 2;
    drop.frames.push_back({{vx * t, y}, w * t});
  }
  const std::vector<DropStart> starts = starts_of(std::vector<MeasuredDrop>{drop});
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_NEAR(starts[0].state.velocity.x, vx, 1e-12);
  EXPECT_NEAR(starts[0].state.angular_velocity, w, 1e-12);
  EXPECT_NEAR(starts[0].state.position.y, starts[0].frames[0].position.y, 1e-12);
  EXPECT_EQ(starts[0].frames.size(), 60u - 11u);
}

TEST(RealityDrops, NumericalErrorIsToldFromTheLawsError) {
  // Under the law that is fitted, no error of the law is left, and Precise has no numerical one.
  const std::vector<double> values{0.0302, 0, 0.01, 5.8e-4, 0.15, 0.45};
  const std::vector<const reference::Backend*> engines{&reference::find_backend("plumb-precise"),
                                                       &reference::find_backend("bullet")};
  const DropFindings findings = examine_drops(made_up_drops(drop_laws().front(), values), engines, 1);
  EXPECT_EQ(findings.drops, 40);
  ASSERT_GE(findings.engines.size(), 2u);
  EXPECT_LT(findings.laws[0].model.position[0].value, 1e-3);
  EXPECT_LT(findings.engines[0].numerical.position[0].value, 1e-7);
  EXPECT_EQ(findings.engines[0].engine, "plumb-precise");
  EXPECT_EQ(findings.engines[0].dt, 0);
  if (findings.engines[1].why_not.empty()) {
    EXPECT_GT(findings.engines[1].numerical.position[0].value, 1e-5);
  }
}

class RealityFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "plumb-reality-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string write(const char* name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  fs::path folder_;
};

TEST_F(RealityFile, ColumnsAreFoundByNameAndTheSquaresAnglesTurned) {
  const std::string path = write("d.csv", "drop,frame,angle,x,y\n1,0,0.5,1,2\n1,1,0.6,1,2\n7,0,1,3,4\r\n");
  const std::vector<MeasuredDrop> drops = read_drops(path);
  ASSERT_EQ(drops.size(), 2u);
  EXPECT_EQ(drops[0].frames.size(), 2u);
  EXPECT_EQ(drops[1].number, 7);
  EXPECT_EQ(drops[1].frames[0].position.y, 4);
  EXPECT_EQ(drops[0].frames[1].angle, -0.6);
}

TEST_F(RealityFile, BadFilesAreNamedWithTheLine) {
  EXPECT_THAT([&] { read_drops(write("a.csv", "drop,x,y\n1,2,3\n")); },
              ThrowsMessage<Error>(HasSubstr("angle")));
  EXPECT_THAT([&] { read_drops(write("b.csv", "drop,x,y,angle\n1,2,3,4\n1,2,x,4\n")); },
              ThrowsMessage<Error>(testing::AllOf(HasSubstr("line 3"), HasSubstr("number"))));
  EXPECT_THAT([&] { read_drops(write("c.csv", "drop,x,y,angle\n")); },
              ThrowsMessage<Error>(HasSubstr("no rows")));
  EXPECT_EQ(missing_file(folder_.string()), kImpactFile);
}

/// The measurements themselves, which plumb does not bring along: PLUMB_REALITY_DATA names their folder.
TEST(RealityMeasured, BestLawPredictsTheEllipseTo13Percent) {
  const char* folder = std::getenv("PLUMB_REALITY_DATA");
  if (folder == nullptr || !missing_file(folder).empty())
    GTEST_SKIP() << "set PLUMB_REALITY_DATA to the folder of the measurements, see docs/reality.md";
  const EllipseFindings findings = examine_ellipse(read_impacts(std::string(folder) + "/" + kImpactFile), 1);
  EXPECT_EQ(findings.impacts, 2000);
  EXPECT_EQ(findings.doubted, 282);
  EXPECT_LT(findings.laws[findings.best].median.high, 0.13);
  EXPECT_EQ(findings.laws[findings.best].parameters.size(), 5u);
  EXPECT_LT(findings.laws[findings.best_of_all_floors].median.value, 0.13)
      << "without a parameter of the place";
  EXPECT_EQ(findings.laws[findings.best_of_all_floors].parameters.size(), 5u);
  EXPECT_NEAR(findings.laws[0].median.value, 0.163, 0.01) << "Newton";
  EXPECT_NEAR(findings.laws[1].median.value, 0.145, 0.01) << "Poisson";
  EXPECT_NEAR(findings.bound.median.value, 0.035, 0.004);
}

}  // namespace
}  // namespace plumb::harness::reality
