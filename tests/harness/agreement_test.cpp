// Checks what is derived from results about who agrees with whom.
#include "harness/agreement.h"

#include <gmock/gmock.h>

#include "engine/scene/error.h"
#include "harness/table.h"

namespace plumb::harness {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;
using Names = std::vector<std::string>;

Result run(const std::string& engine, double error, const Names& agrees, const std::string& limit = "") {
  Result result;
  result.label = "drop";
  result.engine = engine;
  result.engine_version = "1";
  result.truth = "Galileo";
  result.agrees_with = agrees;
  result.checks.push_back({"position_error", Oracle::Exact, error, 0.1, error <= 0.1, limit});
  result.checks.push_back({"energy_drift", Oracle::Invariant, 10 * error, 0.1, 10 * error <= 0.1, limit});
  return result;
}

// Three engines near the truth in a chain: "a" and "b" agree, "b" and "c" agree, "a" and "c" do not.
std::vector<Result> three() {
  return {run("a", 0.001, {"b"}), run("b", 0.002, {"a", "c"}), run("c", 0.5, {"b"}, "c rounds to a metre.")};
}

TEST(Agreement, SaysWhoAgreesWithTheTruthAndWhoMissesByHowMuchAndWhy) {
  const std::vector<Agreement> cases = agreements(three());
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_THAT(cases[0].agree, ElementsAre("a", "b"));
  ASSERT_EQ(cases[0].dissents.size(), 1u);
  const Dissent& dissent = cases[0].dissents[0];
  EXPECT_EQ(dissent.engine, "c");
  EXPECT_EQ(dissent.reason, "c rounds to a metre.");
  ASSERT_EQ(dissent.misses.size(), 2u);
  EXPECT_EQ(dissent.misses[0].check, "energy_drift") << "the largest multiple first";
  EXPECT_DOUBLE_EQ(dissent.misses[0].times(), 50);
  EXPECT_DOUBLE_EQ(dissent.misses[1].times(), 5);
}

TEST(Agreement, GroupsEnginesOfWhichEachAgreesWithEachOther) {
  EXPECT_THAT(agreements(three())[0].groups, ElementsAre(Names{"a", "b"}, Names{"b", "c"}));
  EXPECT_THAT(agreements(three())[0].partners("b"), UnorderedElementsAre("a", "c"));
  // A ring of four without its diagonals has four pairs; with one of them, two triangles.
  const std::vector<Result> ring{run("a", 0, {"b", "d"}), run("b", 0, {"a", "c"}), run("c", 0, {"b", "d"}),
                                 run("d", 0, {"a", "c"})};
  EXPECT_EQ(agreements(ring)[0].groups.size(), 4u);
  const std::vector<Result> braced{run("a", 0, {"b", "c", "d"}), run("b", 0, {"a", "c"}),
                                   run("c", 0, {"a", "b", "d"}), run("d", 0, {"a", "c"})};
  EXPECT_THAT(agreements(braced)[0].groups, ElementsAre(Names{"a", "b", "c"}, Names{"a", "c", "d"}));
}

TEST(Agreement, TakesTheLastResultAtTheDefaultSettings) {
  std::vector<Result> results = three();
  results[2].asked.substeps = 8;                // another setting: not comparable
  results.push_back(run("a", 5, {}, "late."));  // the same again
  const Agreement one = agreements(results)[0];
  EXPECT_THAT(one.agree, ElementsAre("b"));
  ASSERT_EQ(one.dissents.size(), 1u);
  EXPECT_EQ(one.dissents[0].engine, "a");
}

TEST(Agreement, AnEngineThatDidNotRunNeitherAgreesNorMisses) {
  std::vector<Result> results = three();
  results[0].status = Status::Skipped;
  results[0].reason = "it has no contacts";
  results[1].status = Status::Crashed;
  results[1].reason = "signal 11";
  const Agreement one = agreements(results)[0];
  EXPECT_THAT(one.agree, IsEmpty());
  ASSERT_EQ(one.absent.size(), 2u);
  EXPECT_FALSE(one.absent[0].broke);
  EXPECT_TRUE(one.absent[1].broke);
  EXPECT_THAT(agreement_text(std::vector{one}, AgreementDetail::Full, {}),
              HasSubstr("no result: b: signal 11"));
}

TEST(Agreement, AMissWithoutAReasonSaysSo) {
  EXPECT_EQ(agreements(std::vector{run("a", 5, {})})[0].dissents[0].reason, "no reason is declared");
}

TEST(Agreement, ABoundOfZeroIsExceededByNoFiniteMultiple) {
  EXPECT_EQ(times_text({"joint_gap", 0.1, 0}), "beyond any bound");
  EXPECT_EQ(times_text({"joint_gap", 0.3, 0.2}), "1.5 x");
}

TEST(Agreement, TextHasEachReasonOnceAndCasesWithoutMissesTogether) {
  std::vector<Result> results = three();
  for (Result result : three()) {
    result.label = "throw";
    results.push_back(result);
  }
  Result alone = run("a", 0, {});
  alone.label = "rest";
  results.push_back(alone);
  const std::string text = agreement_text(agreements(results), AgreementDetail::Full, {});
  EXPECT_THAT(text, HasSubstr("in 1 of 3: rest (1)"));
  EXPECT_THAT(text, HasSubstr("agree with the truth: a, b (2 of 3)"));
  EXPECT_THAT(text, HasSubstr("not: c energy_drift 5, 50 x its bound and 1 more (1)"));
  EXPECT_THAT(text, HasSubstr("with each other: a, b; b, c"));
  const std::size_t first = text.find("c rounds to a metre.");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("c rounds to a metre.", first + 1), std::string::npos);
  EXPECT_THAT(
      agreement_text(agreements(results), AgreementDetail::Brief, {}),
      HasSubstr("drop: 2 of 3 agree with the truth; not c energy_drift 5, 50 x its bound and 1 more (1)\n"));
}

TEST(Agreement, JsonReadsBackAndCsvHasALineAMiss) {
  const std::vector<Agreement> cases = agreements(three());
  const std::string json = agreement_json(cases[0]);
  EXPECT_EQ(agreement_json(agreement_from_json(json)), json);
  EXPECT_THROW(agreement_from_json("{}"), Error);
  EXPECT_EQ(agreement_csv(cases),
            "label,engine,outcome,check,value,bound,times,agrees_with,reason\n"
            "drop,a,agrees,,,,,b,\n"
            "drop,b,agrees,,,,,a c,\n"
            "drop,c,misses,energy_drift,5,0.1,50,b,c rounds to a metre.\n"
            "drop,c,misses,position_error,0.5,0.1,5,b,c rounds to a metre.\n");
}

TEST(Agreement, IsInTheLinesOfAComparison) {
  const std::vector<Result> results = three();
  EXPECT_THAT(to_json(results[0]), HasSubstr(R"("agrees_with_truth":true)"));
  EXPECT_THAT(to_json(results[2]), HasSubstr(R"("agrees_with_truth":false)"));
  EXPECT_THAT(csv_row(results[0]), testing::EndsWith(",yes,b,,,"));
  EXPECT_THAT(csv_row(results[2]),
              testing::EndsWith(",no,b,,position_error=0.5/0.1 energy_drift=5/0.1,c rounds to a metre."));
}

}  // namespace
}  // namespace plumb::harness
