// Checks what a report shows of more runs than a page has room for.
#include "harness/report/shown_rows.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/report/report_data.h"
#include "harness/sweep/rows.h"
#include "tests/sweep/rows.h"

namespace plumb::harness::report {
namespace {

using sweep::row;

const MetricField& kPosition = kMetricFields[0];

// Runs of an engine whose front is one in ten of them, all with the same step but for a series of six.
std::vector<Result> many(const std::string& engine, int count, const std::string& label = "scene") {
  std::vector<Result> out;
  for (int i = 0; i < count; ++i) {
    const double along = 1 + i / 10;
    out.push_back(row(engine, (i % 10 == 0 ? 1 : 2) / along, along * (i % 10 == 0 ? 1 : 3), 1.0 / 64, label));
    out.back().asked.options["tune"] = std::to_string(i);
  }
  for (int i = 0; i < 6; ++i) {
    const double dt = std::ldexp(1.0, -i);
    out[static_cast<std::size_t>(10 * i + 5)].dt = out[static_cast<std::size_t>(10 * i + 5)].asked.dt = dt;
    out[static_cast<std::size_t>(10 * i + 5)].asked.options["tune"] = "series";
  }
  return out;
}

TEST(FairShare, GivesTheLargeWhatTheSmallLeave) {
  EXPECT_EQ(fair_share({1, 2, 3}, 100, 1), 3u) << "room for all";
  EXPECT_EQ(fair_share({10, 10, 10, 10}, 20, 1), 5u);
  EXPECT_EQ(fair_share({1, 1, 100, 100}, 20, 1), 9u) << "2 + 2 x 9 = 20";
  EXPECT_EQ(fair_share({100, 100}, 2, 4), 4u) << "never below the least";
  EXPECT_EQ(fair_share({}, 10, 4), 4u);
}

TEST(ShownRows, AllWhereThereIsRoom) {
  const std::vector<Result> rows = many("a", 200);
  EXPECT_EQ(shown_rows(rows, kPosition, std::vector<bool>(rows.size()), 200).size(), 200u);
}

TEST(ShownRows, OfEachEngineAtMostSoManyWithWhatIsKeptAndTheBest) {
  std::vector<Result> rows = many("a", 500);
  const std::vector<Result> other = many("b", 30 + 40);
  rows.insert(rows.end(), other.begin(), other.end());
  std::vector<bool> kept(rows.size(), false);
  kept[123] = true;
  const std::vector<std::size_t> shown = shown_rows(rows, kPosition, kept, 20);
  EXPECT_EQ(shown.size(), 40u);
  EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end()));
  EXPECT_EQ(std::set<std::size_t>(shown.begin(), shown.end()).size(), 40u);
  const auto has = [&](std::size_t place) { return std::binary_search(shown.begin(), shown.end(), place); };
  EXPECT_TRUE(has(123));
  EXPECT_TRUE(has(490)) << "the most accurate of a";
  EXPECT_TRUE(has(0)) << "the cheapest";
}

TEST(ShownRows, FrontSeriesAndTroublesTakeTurns) {
  std::vector<Result> rows = many("a", 500);
  for (int i = 0; i < 40; ++i) {
    Result& bad = rows[static_cast<std::size_t>(10 * i + 7)];
    bad.status = Status::Diverged;
    bad.reason = i % 2 == 0 ? "away" : "not a number";
    bad.cost.reset();
  }
  rows[33].checks.push_back({.name = "energy", .pass = false});
  const std::vector<std::size_t> shown = shown_rows(rows, kPosition, std::vector<bool>(rows.size()), 30);
  ASSERT_EQ(shown.size(), 30u);
  int front = 0, series = 0, missed = 0;
  std::set<std::string> reasons;
  for (const std::size_t place : shown) {
    front += place % 10 == 0 ? 1 : 0;
    series += rows[place].asked.options.at("tune") == "series" ? 1 : 0;
    missed += rows[place].checks.empty() ? 0 : 1;
    if (rows[place].status != Status::Ok) reasons.insert(rows[place].reason);
  }
  EXPECT_EQ(series, 6) << "the whole series";
  EXPECT_EQ(reasons.size(), 2u) << "one of each kind of failure";
  EXPECT_EQ(missed, 1);
  EXPECT_GE(front, 20) << "and the rest of the front, which is one in ten of all";
  // Spread over the front: no gap is a quarter of it.
  std::size_t before = 0;
  for (const std::size_t place : shown) {
    if (place % 10 != 0) continue;
    EXPECT_LT(place - before, 125u);
    before = place;
  }
}

// Twenty scenes of three engines: 120,000 runs.
TEST(ReportData, OfManyRunsFitsAPageAndCountsAll) {
  std::vector<Result> rows;
  for (int scene = 0; scene < 20; ++scene)
    for (const char* engine : {"plumb", "a", "b"}) {
      std::vector<Result> some = many(engine, 2000, "scene " + std::to_string(scene));
      for (Result& one : some)
        one.settings = {{"dt", std::to_string(one.dt)}, {"solver", "a long name of one"}};
      rows.insert(rows.end(), some.begin(), some.end());
    }
  rows[1].status = Status::Crashed;
  rows[1].reason = "signal 11";
  const std::string text = report_data("many", rows, {}, {});
  EXPECT_LT(text.size(), 18'000'000u);
  const auto data = nlohmann::json::parse(text);
  std::size_t all = 0, shown = 0;
  for (const auto& scene : data["scenes"]) {
    all += scene["runs"]["all"].get<std::size_t>();
    shown += scene["rows"].size();
  }
  EXPECT_EQ(all, rows.size());
  EXPECT_LE(shown, 14'000u);
  EXPECT_GT(shown, 13'000u) << "the room is used";
  EXPECT_EQ(data["scenes"][0]["runs"]["statuses"]["crashed"], 1);
  EXPECT_EQ(data["scenes"][0]["runs"]["failures"][0]["text"], "plumb: crashed: signal 11");
  // Standings are of all runs, their list of exceptions is cut.
  std::size_t worse = 0, listed = 0;
  for (const auto& standing : data["standings"]) {
    EXPECT_EQ(standing["points"], 2000);
    worse += standing["worse"].get<std::size_t>();
    listed += standing["exceptions"].size();
  }
  EXPECT_GE(worse, listed);
  EXPECT_LE(listed, 3000u);
}

// A motion that would not fit is thinned, and no peak between its samples is lost.
TEST(ReportData, MotionsHaveTheRoomThatIsLeft) {
  std::vector<Result> rows;
  std::map<std::string, std::string> replays;
  const int samples = 40'001, peak = 12'345;
  for (int i = 0; i < 20; ++i) {
    rows.push_back(row("engine " + std::to_string(i), 1, 1));
    nlohmann::json motion{{"times", nlohmann::json::array()}};
    for (int k = 0; k < samples; ++k) {
      motion["times"].push_back(1e-4 * k);
      motion["poses"].push_back({0.123456, 0.234567, 0.345678});
      motion["errors"].push_back(k == peak ? 7.0 : 0.5);
    }
    replays[sweep::key_of(rows.back())] = motion.dump();
  }
  const std::string text = report_data("motions", rows, {}, replays);
  EXPECT_LT(text.size(), 19'000'000u);
  const auto replay = nlohmann::json::parse(text)["scenes"][0]["rows"][0]["replay"];
  const std::size_t count = replay["times"].size();
  EXPECT_LT(count, static_cast<std::size_t>(samples));
  EXPECT_EQ(replay["poses"].size(), count);
  ASSERT_EQ(replay["errors"].size(), count);
  EXPECT_EQ(replay["times"][count - 1], 1e-4 * (samples - 1)) << "to the end";
  double largest = 0;
  for (const auto& error : replay["errors"]) largest = std::max(largest, error.get<double>());
  EXPECT_EQ(largest, 7.0);
}

}  // namespace
}  // namespace plumb::harness::report
