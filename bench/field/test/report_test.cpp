#include "bench/field/report.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumb::field {
namespace {

using testing::HasSubstr;
using testing::Not;

const Scene kScene{.name = "pile", .summary = "a pile"};
const Engine kYardstick{"box2d", "1", "", nullptr}, kOther{"other", "2", "", nullptr};

Measurement measured(const Engine& engine, std::vector<double> seconds) {
  Measurement out;
  out.scene = &kScene;
  out.engine = &engine;
  out.settings = {{"iterations", "8"}};
  out.asked = {.bodies = 4, .shapes = 4};
  out.cpu_share.assign(seconds.size(), 1.0);
  out.step_seconds = std::move(seconds);
  return out;
}

TEST(Table, SpeedIsTheYardsticksMedianOverTheEngines) {
  const std::vector<Measurement> row{measured(kYardstick, {0.005, 0.004, 0.009}),
                                     measured(kOther, {0.002, 0.003, 0.002})};
  const std::string text = table(row, {});
  EXPECT_THAT(text, HasSubstr("2.50x"));
  EXPECT_THAT(text, Not(HasSubstr("~")));
  EXPECT_THAT(text, HasSubstr("-20/+80 %"));
  EXPECT_THAT(text, HasSubstr("5.00 ms"));
  EXPECT_THAT(text, HasSubstr("500000"));  // ns per body
}

TEST(Table, SpeedIsThatOfTheNewerBox2dIfItWasMeasured) {
  const Engine newer{"box2d-v3", "3", "", nullptr};
  const std::vector<Measurement> row{measured(kYardstick, {0.005}), measured(newer, {0.003}),
                                     measured(kOther, {0.002})};
  EXPECT_THAT(table(row, {}), HasSubstr("1.50x"));
}

TEST(Table, StagesHaveTheirShareOfTheStep) {
  std::vector<Measurement> row{measured(kYardstick, {0.005})};
  EXPECT_THAT(table(row, {}), Not(HasSubstr("stages")));
  row[0].stages = {{"solver", 30000}, {"events", 10000}};
  const std::string text = table(row, {});
  EXPECT_THAT(text, HasSubstr("solver            30.00 us   75.0 %"));
  EXPECT_THAT(text, HasSubstr("events            10.00 us   25.0 %"));
}

TEST(Table, SaysWhereNoiseHidesWhichIsFaster) {
  const std::vector<Measurement> row{measured(kYardstick, {0.005, 0.004, 0.009}),
                                     measured(kOther, {0.002, 0.0041, 0.002})};
  EXPECT_THAT(table(row, {}), HasSubstr("~2.50x"));
}

TEST(Table, LeavesOutWhatSaysNothing) {
  std::vector<Measurement> row{measured(kYardstick, {0.005})};
  std::string text = table(row, {});
  for (const char* head : {"height", "joint max", "touching", "escaped", "cpu", "spread"})
    EXPECT_THAT(text, Not(HasSubstr(head)));
  row[0].height = 0.9987;
  row[0].asked.joints = 2;
  row[0].quality.worst_joint = 0.0123;
  row[0].escaped = 3;
  row[0].cpu_share = {0.5};
  text = table(row, {});
  for (const char* part : {"height", "99.87 %", "joint max", "12.3 mm", "escaped", "cpu", "50 %"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(Table, AFailureHasItsReasonInItsRow) {
  std::vector<Measurement> row{measured(kYardstick, {}), measured(kOther, {0.002})};
  row[0].failure = "died";
  const std::string text = table(row, {});
  EXPECT_THAT(text, HasSubstr("died"));
  EXPECT_THAT(text, Not(HasSubstr("x  ")));  // nothing to compare with
  EXPECT_EQ(yardstick_of(row, kScene), nullptr);
}

TEST(Csv, RowsHaveTheHeadsCells) {
  Measurement sound = measured(kOther, {0.002}), failed = measured(kYardstick, {});
  failed.failure = "said \"no\"";
  const auto cells = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  EXPECT_EQ(cells(csv_row(sound, nullptr)), cells(csv_header()));
  EXPECT_EQ(cells(csv_row(failed, nullptr)), cells(csv_header()));
  EXPECT_THAT(csv_row(failed, nullptr), HasSubstr("\"said 'no'\""));
}

TEST(Json, HoldsFailuresAndFigures) {
  std::vector<Measurement> all{measured(kYardstick, {0.004}), measured(kOther, {0.002})};
  all.push_back(measured(kOther, {}));
  all[2].failure = "died";
  const auto document = nlohmann::json::parse(json(all, {}));
  EXPECT_EQ(document["results"][1]["speed"], 2.0);
  EXPECT_EQ(document["results"][1]["settings"]["iterations"], "8");
  EXPECT_EQ(document["results"][2]["failure"], "died");
  EXPECT_FALSE(document["results"][2].contains("step_s"));
}

}  // namespace
}  // namespace plumb::field
