// The data is made up: which outcome stands where is what the tests read off it.
#include "harness/report/extremes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/scene/error.h"
#include "harness/report/environments.h"
#include "harness/report/report_data.h"
#include "tests/app/program.h"

namespace plumb::harness::report {
namespace {

using app::Folder;
using stress::Cell;
using stress::Verdict;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

const std::string kData = PLUMB_REPORT_DATA;

Cell cell_of(double value, const char* engine, const char* setting, Verdict verdict) {
  Cell cell{.family = "f", .value = value, .engine = engine, .setting = setting};
  cell.finding.verdict = verdict;
  return cell;
}

TEST(Extremes, CountsWhatSurvivesByEngineSettingAndFamily) {
  const std::vector<Endurance> rows = endurances(read_extremes(kData).cells);
  ASSERT_EQ(rows.size(), 7u);
  // plumb's engines first, the worst of them before the others: 8 and 12 of 12, 11 of 12; then 2 of 8 and 4
  // of 12.
  std::vector<std::string> names;
  for (const Endurance& row : rows) names.push_back(row.engine + " " + row.setting);
  EXPECT_THAT(names, ElementsAre("any of plumb's any setting", "plumb-float default", "plumb-float careful",
                                 "plumb-float any setting", "plumb-precise default", "bullet-double default",
                                 "box2d default"));
  EXPECT_EQ(rows[1].all.survived, 8);
  EXPECT_EQ(rows[1].all.total, 12);
  EXPECT_EQ(rows[1].families.at("mass_ratio_stack").survived, 2);
  EXPECT_THAT(rows[1].outcomes,
              ElementsAre(Pair("inaccurate", 1), Pair("ok", 8), Pair("refused", 1), Pair("sinks", 2)));
  // Skipped runs are not counted.
  EXPECT_EQ(rows[5].all.survived, 2);
  EXPECT_EQ(rows[5].all.total, 8);
  EXPECT_FALSE(rows[5].families.contains("stiff_spring"));
  EXPECT_EQ(rows[5].outcomes.at("skipped"), 4);
}

TEST(Extremes, ACellSurvivesWhereAnySettingDoes) {
  // 1: the first alone; 2: the second alone; 3: none; 4: only another engine of plumb; 5: only a rival.
  const std::vector<Cell> cells{
      cell_of(1, "plumb-float", "a", Verdict::Ok),        cell_of(2, "plumb-float", "a", Verdict::Sinks),
      cell_of(3, "plumb-float", "a", Verdict::NotFinite), cell_of(4, "plumb-float", "a", Verdict::Skipped),
      cell_of(5, "plumb-float", "a", Verdict::Skipped),   cell_of(1, "plumb-float", "b", Verdict::Sinks),
      cell_of(2, "plumb-float", "b", Verdict::Ok),        cell_of(3, "plumb-float", "b", Verdict::Refused),
      cell_of(4, "plumb-float", "b", Verdict::Skipped),   cell_of(5, "plumb-float", "b", Verdict::Skipped),
      cell_of(4, "plumb-precise", "a", Verdict::Ok),      cell_of(5, "box2d", "a", Verdict::Ok)};
  std::map<std::string, std::string> counts;
  for (const Endurance& row : endurances(cells))
    if (row.setting == "any setting")
      counts[row.engine] = std::to_string(row.all.survived) + " of " + std::to_string(row.all.total);
  EXPECT_THAT(counts, ElementsAre(Pair("any of plumb's", "3 of 4"), Pair("plumb-float", "2 of 3")));
}

TEST(Extremes, ALaterLineReplacesAnEarlierOneAndACutLineIsPassedOver) {
  const Folder folder;
  const auto line = [](double value, Verdict verdict) {
    return stress::to_json(cell_of(value, "mine", "plain", verdict)) + "\n";
  };
  folder.write("stress.jsonl", "{\"kind\":\"environment\"}\n" + line(1, Verdict::Crashed) +
                                   line(2, Verdict::NotFinite) + line(1, Verdict::Ok) +
                                   "{\"kind\":\"cell\",\"fam");
  const std::vector<Cell> cells = read_extremes(folder.path("")).cells;
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0].finding.verdict, Verdict::Ok);
  EXPECT_EQ(cells[1].finding.verdict, Verdict::NotFinite);
  folder.write("stress.jsonl", line(1, Verdict::Ok) + "{\"kind\":\"cell\"}\n" + line(2, Verdict::Ok));
  try {
    read_extremes(folder.path(""));
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Syntax);
    EXPECT_EQ(error.field(), "line 2");
  }
}

TEST(Extremes, EachLogNamesItsEnvironmentOnceForAllItsRuns) {
  const auto uses = read_environments(kData);
  ASSERT_EQ(uses.size(), 1u);
  EXPECT_EQ(uses[0].runs, 60 + 5);
  EXPECT_EQ(uses[0].where.cpu, "a processor");
}

TEST(Extremes, AFolderWithoutResultsHasAReportOfThem) {
  const Folder folder;
  for (const char* name : {"stress.jsonl", "thresholds.jsonl"})
    std::filesystem::copy_file(kData + "/" + name, folder.path(name));
  const app::Ran ran = app::plumb({"report", folder.path(""), "--picture", folder.path("map.svg")});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("map.svg"));
  const std::string page = folder.read("report.html");
  EXPECT_THAT(page, HasSubstr("a heavy box on a light one"));
  // "<" stands in a reason.
  EXPECT_THAT(page, HasSubstr("the step can follow: \\u003c= 1e3"));
  EXPECT_THAT(page, HasSubstr("\"thresholds\":[{\"kind\":\"threshold\",\"name\":\"ramp_friction\""));
}

TEST(Extremes, AFamilyBringsItsRule) {
  const std::string data = extremes_data(read_extremes(kData));
  EXPECT_THAT(data, HasSubstr("\"mass_ratio_stack\":\"" + stress::find_family("mass_ratio_stack").rule));
  EXPECT_THAT(data, Not(HasSubstr("\"bullet\":\""))) << "there is no such family";
}

TEST(Extremes, ThePictureHasANumberInEveryCell) {
  std::vector<Cell> cells = read_extremes(kData).cells;
  const std::string plain = cells[0].family;
  for (Cell& cell : cells)
    if (cell.family == plain) cell.family = "a <family>_&_more";
  const std::string svg = extremes_picture(cells);
  EXPECT_EQ(svg.substr(0, 5), "<svg ");
  EXPECT_THAT(svg, HasSubstr("a &lt;family> &amp; more"));
  const auto count = [&](const std::string& text) {
    int out = 0;
    for (std::size_t at = 0; (at = svg.find(text, at)) != std::string::npos; ++at) ++out;
    return out;
  };
  // Seven rows of three families and the sum of these.
  EXPECT_EQ(count("text-anchor=\"middle\""), 28);
  EXPECT_EQ(count(">8/12<"), 1);
  EXPECT_EQ(count(">2/4<"), 3) << "plumb-float's stacks and springs, box2d's bullets";
  EXPECT_EQ(count(">\u2013<"), 1);
}

}  // namespace
}  // namespace plumb::harness::report
