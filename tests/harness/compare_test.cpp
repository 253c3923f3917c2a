#include "harness/compare.h"

#include <algorithm>
#include <csignal>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/summary.h"
#include "harness/table.h"
#include "tests/harness/fakes.h"

namespace plumb::harness {
namespace {

using namespace fakes;

Motion off_by(double error) {
  return [exact = exactly(thrown()), error](long step, double dt, std::span<BodyState> out) {
    exact(step, dt, out);
    out[0].position.x += error * static_cast<double>(step) * dt;
  };
}

struct Fixture {
  scenarios::Scenario scenario = family(thrown);
  FakeBackend good{"plumb", off_by(1e-4)}, near{"near", off_by(0.02)}, wrong{"wrong", off_by(3)},
      dead{"dead", [](long, double, std::span<BodyState>) { raise(SIGABRT); }};
  CompareOptions options{.instances = {{&scenario, "", 1}}, .engines = {&good, &near, &wrong, &dead}};
};

TEST(Compare, RunsAllMeasuresAllAndJudges) {
  Fixture fixture;
  std::size_t finished = 0, progress = 0;
  const Comparison comparison =
      compare(fixture.options, {.finished = [&](std::span<const Result> r) { finished += r.size(); },
                                .progress = [&](const Progress&) { ++progress; }});
  ASSERT_EQ(comparison.results.size(), 4u);
  EXPECT_EQ(finished, 4u);
  EXPECT_EQ(progress, 4u);
  EXPECT_FALSE(comparison.interrupted);
  EXPECT_FALSE(comparison.as_expected());
  const auto& [good, near, wrong, dead] =
      std::tie(comparison.results[0], comparison.results[1], comparison.results[2], comparison.results[3]);
  EXPECT_TRUE(good.unexpected.empty());
  EXPECT_TRUE(near.unexpected.empty());
  ASSERT_FALSE(wrong.unexpected.empty());
  EXPECT_NE(wrong.unexpected[0].find("position_error"), std::string::npos);
  EXPECT_EQ(dead.status, Status::Crashed);
  EXPECT_FALSE(dead.unexpected.empty());
  EXPECT_FALSE(dead.cost);
}

TEST(Compare, SaysWhoAgreesWithWhom) {
  Fixture fixture;
  fixture.options.measure_cost = false;
  const std::vector<Result> results = compare_on(fixture.options.instances[0], fixture.options);
  EXPECT_EQ(results[0].agrees_with, std::vector<std::string>{"near"});
  EXPECT_EQ(results[0].disagrees_with, std::vector<std::string>{"wrong"});
  EXPECT_EQ(results[2].agrees_with, std::vector<std::string>{});
  EXPECT_EQ(results[2].disagrees_with, (std::vector<std::string>{"plumb", "near"}));
}

TEST(Compare, CostIsWhatTheEngineSaysItSpent) {
  Fixture fixture;
  fixture.options.engines = {&fixture.good};
  const std::vector<Result> results = compare_on(fixture.options.instances[0], fixture.options);
  ASSERT_TRUE(results[0].cost);
  EXPECT_DOUBLE_EQ(results[0].cost->ns_per_step, 1000);  // the fake engine's own account
  EXPECT_DOUBLE_EQ(results[0].cost->ns_per_simulated_second, 60'000);
  EXPECT_EQ(results[0].cost->repetitions, 5);
  EXPECT_EQ(results[0].cost->steps, 120);
  EXPECT_GT(results[0].cost->setup_ns, 0);
}

TEST(Compare, ABrokenScenarioFailsItsRunsAlone) {
  Fixture fixture;
  const scenarios::Scenario broken = family(
      []() -> scenarios::Problem {
        throw Error(Error::Kind::Value, "body 'x'", "mass", "-1", "must be above 0");
      },
      "broken");
  fixture.options.instances.insert(fixture.options.instances.begin(), {&broken, "", 1});
  fixture.options.engines = {&fixture.good};
  fixture.options.measure_cost = false;
  const Comparison comparison = compare(fixture.options);
  ASSERT_EQ(comparison.results.size(), 2u);
  EXPECT_EQ(comparison.results[0].status, Status::Failed);
  EXPECT_NE(comparison.results[0].reason.find("mass"), std::string::npos);
  EXPECT_EQ(comparison.results[1].status, Status::Ok);
}

TEST(Compare, CostsDifferOnlyWhereTheirMiddleHalvesDo) {
  const auto cost = [](double low, double middle, double high) {
    return Cost{.ns_per_step = middle, .ns_per_step_low = low, .ns_per_step_high = high};
  };
  EXPECT_TRUE(clearly_differ(cost(1, 2, 3), cost(4, 5, 6)));
  EXPECT_TRUE(clearly_differ(cost(4, 5, 6), cost(1, 2, 3)));
  EXPECT_FALSE(clearly_differ(cost(1, 2, 4.5), cost(4, 5, 6)));
  const Cost summary = summarise({{5, 50, 9}, {1, 10, 9}, {4, 40, 9}, {2, 20, 9}, {3, 30, 9}}, 0.5);
  EXPECT_EQ(summary.ns_per_step, 3);
  EXPECT_EQ(summary.ns_per_step_low, 2);
  EXPECT_EQ(summary.ns_per_step_high, 4);
  EXPECT_EQ(summary.setup_ns, 30);
  EXPECT_EQ(summary.ns_per_simulated_second, 6);
}

TEST(Result, ReadsBackWhatItWrote) {
  Fixture fixture;
  for (const Result& result : compare_on(fixture.options.instances[0], fixture.options)) {
    EXPECT_EQ(to_json(result_from_json(to_json(result))), to_json(result));
    const auto json = nlohmann::json::parse(to_json_with_environment(result));
    for (const char* key : {"scenario", "size", "engine", "engine_version", "precision", "settings", "status",
                            "reason", "metrics", "cost", "checks", "environment"})
      EXPECT_TRUE(json.contains(key)) << key;
    for (const char* key :
         {"compiler", "flags", "build_type", "cpu", "commit", "os", "date", "plumb_version"})
      EXPECT_FALSE(json["environment"][key].get<std::string>().empty()) << key;
    EXPECT_EQ(to_json(result_from_json(json.dump())), to_json(result));
  }
  EXPECT_THROW(result_from_json("{}"), Error);
  EXPECT_THROW(result_from_json("nonsense"), Error);
}

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0, start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    longest = std::max(longest, end - start);
    start = end + 1;
  }
  return longest;
}

TEST(Table, FitsAndNamesWhatWasMissed) {
  Fixture fixture;
  const std::vector<Result> results = compare_on(fixture.options.instances[0], fixture.options);
  for (const int width : {110, 80, 60}) {
    const std::string text = table(results, {.width = width, .colour = false}) +
                             summary(results, {.width = width, .colour = false});
    EXPECT_LE(longest_line(table(results, {.width = width, .colour = false})),
              static_cast<std::size_t>(width))
        << text;
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    for (const char* part : {"plumb", "near", "wrong", "dead", "crashed: signal 6 (SIGABRT)",
                             "UNEXPECTED: position_error", "NOT as expected"})
      EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  EXPECT_NE(table(results, {.width = 110, .colour = true}).find('\x1b'), std::string::npos);
}

TEST(Summary, RoundsRatiosToOneDigitBeforeThePoint) {
  for (const auto& [ratio, text] : std::vector<std::pair<double, std::string>>{
           {999, " 999 x"}, {999.7, " 1.0e3 x"}, {99'990'000, " 1.0e8 x"}, {1.14e5, " 1.1e5 x"}}) {
    Result ours, theirs;
    ours.engine = "plumb", theirs.engine = "rival";
    ours.label = theirs.label = "a";
    ours.dt = theirs.dt = 1.0 / 60;
    ours.metrics.position_error = 1e-9, theirs.metrics.position_error = 1e-9 * ratio;
    const Result results[] = {ours, theirs};
    EXPECT_NE(summary(results, {}).find(text), std::string::npos) << summary(results, {});
  }
}

TEST(Summary, SaysWherePlumbIsWorseFirst) {
  const auto result = [](const char* engine, const char* label, double position, double gap) {
    Result r;
    r.engine = engine;
    r.label = label;
    r.dt = 1.0 / 60;
    r.metrics.position_error = position;
    r.metrics.joint_gap = gap;
    return r;
  };
  const std::vector<Result> results = {result("plumb", "a", 1e-6, 1e-16), result("rival", "a", 1e-3, 1e-15),
                                       result("plumb", "b", 2e-3, 0), result("rival", "b", 1e-3, 1e-8)};
  const std::string text = summary(results, {});
  EXPECT_NE(text.find("worse in 1 of 4 figures"), std::string::npos) << text;
  EXPECT_NE(text.find("b position_error: 2.0e-03 against 1.0e-03 m"), std::string::npos) << text;
  EXPECT_NE(text.find("joint_gap               better in 1, equal in 1, worse in 0"), std::string::npos)
      << text;
  EXPECT_LT(text.find("worse in 1 of 4"), text.find("better in"));
}

TEST(Csv, HasAFieldAColumn) {
  Fixture fixture;
  fixture.dead.unsupported_ = "no \"circles\", no boxes";
  const auto fields = [](const std::string& line) {
    bool quoted = false;
    std::ptrdiff_t count = 1;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      count += c == ',' && !quoted ? 1 : 0;
    }
    return count;
  };
  for (const Result& result : compare_on(fixture.options.instances[0], fixture.options))
    EXPECT_EQ(fields(csv_row(result)), fields(csv_header())) << csv_row(result);
}

}  // namespace
}  // namespace plumb::harness
