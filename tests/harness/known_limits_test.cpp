#include "harness/known_limits.h"

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "harness/known_limits_page.h"
#include "harness/result.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness {
namespace {

TEST(KnownLimits, PatternsMatch) {
  EXPECT_TRUE(matches("box2d", "box2d"));
  EXPECT_FALSE(matches("box2d", "box2d-v3"));
  EXPECT_TRUE(matches("bullet*", "bullet-double"));
  EXPECT_TRUE(matches("*[100]", "pendulum_chain[100]"));
  EXPECT_TRUE(matches("a|b*|c", "bee"));
  EXPECT_FALSE(matches("a|b", "ab"));
  EXPECT_FALSE(matches("", "a"));
  EXPECT_TRUE(matches("*", ""));
}

// Each declared limit is about something that there is.
TEST(KnownLimits, NameEnginesInstancesAndChecksThatExist) {
  for (const KnownLimit& limit : known_limits()) {
    bool engine = false, instance = false;
    for (const auto* backend : reference::backends())
      engine = engine || matches(limit.engine, backend->name());
    for (const auto& scenario : scenarios::all())
      for (const auto& member : scenarios::select(scenario.name))
        instance = instance || matches(limit.instance, member.label());
    EXPECT_TRUE(engine) << limit.engine;
    EXPECT_TRUE(instance) << limit.instance;
    EXPECT_GT(limit.reason.size(), 20u);
    EXPECT_TRUE(!limit.engine.starts_with("plumb") || !limit.engine.starts_with("plumb-precise"))
        << "limits are declared for rivals and for the game world, whose sweeps are few";
  }
}

TEST(KnownLimits, AreListedInTheDocuments) {
  std::ifstream file(PLUMB_SOURCE_DIR "/docs/known-limits.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, known_limits_page()) << "write it anew: plumb list --known-limits > docs/known-limits.md";
}

Result with_check(const char* engine, const char* label, bool pass) {
  Result result;
  result.engine = engine;
  result.label = label;
  result.checks = {{"position_error", Oracle::Exact, 2, pass ? 3.0 : 1.0, pass, {}}};
  return result;
}

TEST(Judge, AMissThatIsNotDeclaredIsUnexpected) {
  Result result = with_check("unheard-of", "nowhere", false);
  judge(result, true);
  ASSERT_EQ(result.unexpected.size(), 1u);
  EXPECT_EQ(result.unexpected[0], "position_error is 2, its bound is 1");
  result = with_check("unheard-of", "nowhere", true);
  judge(result, true);
  EXPECT_TRUE(result.unexpected.empty());
}

TEST(Judge, OnlyOkAndSkippedAreExpectedOfARun) {
  for (const Status status :
       {Status::Ok, Status::Skipped, Status::Failed, Status::Crashed, Status::Timeout}) {
    Result result = with_check("unheard-of", "nowhere", true);
    result.status = status;
    result.reason = "so it went";
    judge(result, true);
    EXPECT_EQ(result.unexpected.empty(), status == Status::Ok || status == Status::Skipped);
  }
}

constexpr KnownLimit kLimits[] = {{"rival*", "chain[20]|chain[100]", "position_error", "its joints stretch"},
                                  {"rival", "fall", "position_error", "it is clamped at long steps", true}};

TEST(Judge, ADeclaredMissIsExpectedAndADeclaredOneThatHasGoneIsNot) {
  Result result = with_check("rival-float", "chain[20]", false);
  judge(result, true, kLimits);
  EXPECT_TRUE(result.unexpected.empty());
  EXPECT_EQ(result.checks[0].known_limit, "its joints stretch");
  result = with_check("rival-float", "chain[20]", true);
  judge(result, true, kLimits);
  ASSERT_EQ(result.unexpected.size(), 1u);
  EXPECT_NE(result.unexpected[0].find("known limit has gone"), std::string::npos);
  judge(result, false, kLimits);  // at other settings it may pass
  EXPECT_TRUE(result.unexpected.empty());
  result = with_check("rival-float", "chain[5]", false);
  judge(result, true, kLimits);
  EXPECT_EQ(result.unexpected.size(), 1u);
}

TEST(Judge, ALimitOfOtherSettingsIsNoneAtTheDefaultOnes) {
  Result result = with_check("rival", "fall", false);
  judge(result, false, kLimits);
  EXPECT_TRUE(result.unexpected.empty());
  judge(result, true, kLimits);
  EXPECT_EQ(result.unexpected.size(), 1u);
  result = with_check("rival", "fall", true);
  judge(result, true, kLimits);
  EXPECT_TRUE(result.unexpected.empty());
}

}  // namespace
}  // namespace plumb::harness
