// Checks the words around the tables of a comparison.
#include "harness/plain_words.h"

#include <gmock/gmock.h>

#include "harness/table.h"

namespace plumb::harness {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Result run(const std::string& scene, const std::string& engine, bool near_truth, bool agrees) {
  Result result;
  result.label = scene;
  result.engine = engine;
  result.metrics.position_error = near_truth ? 1e-6 : 0.5;
  Check check{.name = "position_error"};
  check.oracle = Oracle::Exact;
  check.pass = near_truth;
  result.checks.push_back(check);
  (agrees ? result.agrees_with : result.disagrees_with).push_back("other");
  return result;
}

Result skip(const std::string& scene, const std::string& engine, const std::string& reason) {
  Result result;
  result.label = scene;
  result.engine = engine;
  result.status = Status::Skipped;
  result.reason = reason;
  return result;
}

TEST(PlainWords, ATruthThatAllEnginesContradictAlikeIsSuspect) {
  const std::vector<Result> results{run("wrong", "plumb", false, true), run("wrong", "box2d", false, true),
                                    run("right", "plumb", true, true), run("right", "box2d", false, false)};
  EXPECT_THAT(suspect_truths(results), ElementsAre("wrong"));
  EXPECT_THAT(conclusion(results, {}),
              HasSubstr("wrong: all engines agree with each other, and none with the"));
}

TEST(PlainWords, OneMakersEnginesSayNothingOfTheTruth) {
  const std::vector<Result> results{run("a", "plumb", false, true), run("a", "plumb-precise", false, true)};
  EXPECT_THAT(suspect_truths(results), IsEmpty());
}

TEST(PlainWords, EnginesThatDisagreeSayNothingOfTheTruth) {
  const std::vector<Result> results{run("a", "plumb", false, true), run("a", "box2d", false, false)};
  EXPECT_THAT(suspect_truths(results), IsEmpty());
}

TEST(PlainWords, EachEngineHasALine) {
  const std::vector<Result> results{run("a", "plumb", true, true), run("a", "box2d", false, false),
                                    skip("a", "mujoco", "it has contacts")};
  const std::string text = conclusion(results, {});
  EXPECT_THAT(text, HasSubstr("plumb               ran 1 scene, nearest to the true positions in 1"));
  EXPECT_THAT(text, HasSubstr("box2d               ran 1 scene, nearest to the true positions in 0"));
  EXPECT_THAT(text, HasSubstr("mujoco              ran none of these scenes"));
}

TEST(PlainWords, SkipsWithOneReasonShareALine) {
  const std::vector<Result> results{run("a", "plumb", true, true), skip("a", "mujoco", "it has contacts"),
                                    skip("a", "bullet", "it has contacts")};
  const std::string text = table(results, {});
  EXPECT_THAT(text, HasSubstr("skipped: mujoco, bullet (it has contacts)"));
  EXPECT_THAT(text, Not(HasSubstr("skipped: it has contacts")));
}

}  // namespace
}  // namespace plumb::harness
