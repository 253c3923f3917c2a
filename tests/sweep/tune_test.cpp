// Holds tune to its word: settings are found that meet the wish, twice.
#include "harness/sweep/tune.h"

#include <sys/mman.h>

#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "harness/metrics.h"
#include "tests/harness/fakes.h"

namespace plumb::harness::sweep {
namespace {

using namespace fakes;

constexpr double kTolerance = 1e-3;

// A number that the runs' processes see: how often the settings that were found are being tried again.
class Shared {
 public:
  Shared()
      : value_(static_cast<int*>(
            mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {}
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  ~Shared() { munmap(value_, sizeof(int)); }
  int& operator*() const { return *value_; }

 private:
  int* value_;
};

// Off by `first` in the search, by `again` from when costs are measured on: in the run that confirms.
Motion off_by(const Shared& measuring, double first, double again) {
  return
      [exact = exactly(thrown()), first, again, &measuring](long step, double dt, std::span<BodyState> out) {
        exact(step, dt, out);
        out[0].position.x += *measuring == 0 ? first : again;
      };
}

TuneAnswer tuned(double first, double again, std::optional<double> tolerance = kTolerance) {
  const scenarios::Scenario scenario = family(thrown);
  const Shared measuring;
  const FakeBackend engine("fake", off_by(measuring, first, again));
  TuneOptions options{.instance = {&scenario, "", 1}, .engines = {&engine}, .metric = &kMetricFields[0]};
  options.tolerance = tolerance;
  if (!tolerance) options.budget_ns = 1e9;
  options.seconds = 2, options.repetitions = 1;
  const Tuned all =
      tune(options, [&](const std::string& what) { *measuring += what.starts_with("measuring") ? 1 : 0; });
  EXPECT_EQ(all.answers.size(), 1u);
  // Settings that are no answer are not offered.
  const std::string text = tune_text(options, all, Style{}), json = tune_json(options, all);
  EXPECT_EQ(text.find("to paste") != std::string::npos, all.answers[0].found) << text;
  EXPECT_EQ(json.find("\"problem\"") == std::string::npos, all.answers[0].found) << json;
  return all.answers[0];
}

TEST(Tune, TakesWhatMeetsTheWishTwice) {
  const TuneAnswer answer = tuned(0.98 * kTolerance, 0.98 * kTolerance);
  EXPECT_TRUE(answer.found) << answer.problem;
  EXPECT_TRUE(answer.confirmed);
  EXPECT_NEAR(answer.error, 0.98 * kTolerance, 1e-12);
}

TEST(Tune, DoesNotTakeWhatMissesByTwoPerCent) {
  const TuneAnswer answer = tuned(1.02 * kTolerance, 1.02 * kTolerance);
  EXPECT_FALSE(answer.found);
  EXPECT_NEAR(answer.error, 1.02 * kTolerance, 1e-12) << answer.problem;
}

TEST(Tune, DoesNotTakeWhatMissesWhenRunOnceMore) {
  const TuneAnswer answer = tuned(0.98 * kTolerance, 1.02 * kTolerance);
  EXPECT_FALSE(answer.found);
  EXPECT_FALSE(answer.confirmed);
  EXPECT_NE(answer.problem.find("a second run"), std::string::npos) << answer.problem;
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(tuned(0.98 * kTolerance, not_a_number).found);
  EXPECT_FALSE(tuned(1e-6, not_a_number, {}).found) << "within a budget as well";
}

TEST(Tune, SaysThatASecondRunGaveAnotherError) {
  const TuneAnswer answer = tuned(0.97 * kTolerance, 0.98 * kTolerance);
  EXPECT_TRUE(answer.found) << answer.problem;
  EXPECT_FALSE(answer.confirmed);
  EXPECT_NEAR(answer.error, 0.98 * kTolerance, 1e-12) << "the worse of the two";
}

// The search does not tell errors below 1e-12 from each other; what was asked for does.
TEST(Tune, AWishBelowTheFloorOfTheSearchIsHeldToItself) {
  EXPECT_TRUE(tuned(0, 0, 1e-14).found);
  EXPECT_FALSE(tuned(5e-13, 5e-13, 1e-14).found);
}

}  // namespace
}  // namespace plumb::harness::sweep
