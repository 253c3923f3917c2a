#include "harness/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/report/environments.h"
#include "harness/report/report_data.h"
#include "tests/app/program.h"

namespace plumb::harness::report {
namespace {

using app::Folder;
using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

// The data that stands in the page.
Json data_of(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="data">)";
  const std::size_t start = page.find(open) + open.size();
  return Json::parse(page.substr(start, page.find("</script>", start) - start));
}

std::string whole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

app::Ran compare(const Folder& folder, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"compare", "free_fall/vacuum", "--engine", "plumb,plumb-precise",
                                     "--out",   folder.path("r")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return app::plumb(arguments);
}

TEST(Report, CompareEndsByWritingOne) {
  const Folder folder;
  const app::Ran ran = compare(folder, {"--no-cost"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("the report is in " + folder.path("r/report.html")));
  std::string page = folder.read("r/report.html");
  EXPECT_EQ(page.substr(0, 15), "<!doctype html>");
  // Beside the charts' library, which is the file that its package installed, nothing names another place.
  const std::string library = whole(PLUMB_CHART_JS);
  const std::size_t start = page.find(library);
  ASSERT_NE(start, std::string::npos);
  page.erase(start, library.size());
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org/2000/svg")) << "the name of SVG alone";
  EXPECT_EQ(page.find("https://"), std::string::npos);
  const Json data = data_of(page);
  EXPECT_EQ(data["engines"], Json::parse(R"(["plumb","plumb-precise"])"));
  ASSERT_EQ(data["environments"].size(), 1u);
  EXPECT_EQ(data["environments"][0]["runs"], 2);
  ASSERT_EQ(data["scenes"].size(), 1u);
  EXPECT_EQ(data["scenes"][0]["label"], "free_fall/vacuum");
  EXPECT_EQ(data["scenes"][0]["rows"].size(), 2u);
  EXPECT_EQ(data["scenes"][0]["scene"]["bodies"].size(), 5u);
}

TEST(Report, TruthAndReplayFollowGalileo) {
  const Folder folder;
  compare(folder, {"--no-cost"});
  const Json scene = data_of(folder.read("r/report.html"))["scenes"][0];
  const Json& bodies = scene["scene"]["bodies"];
  const auto holds = [&](const Json& motion) {
    ASSERT_GT(motion["times"].size(), 100u);
    for (std::size_t k = 0; k < motion["times"].size(); ++k) {
      const double t = motion["times"][k];
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        const double y = bodies[i]["position"][1].get<double>() + bodies[i]["velocity"][1].get<double>() * t -
                         9.81 * t * t / 2;
        // Six digits of each number, of a time that is known to six digits.
        EXPECT_NEAR(motion["poses"][k][3 * i + 1], y, 1e-5 * (std::abs(y) + 9.81 * t * t));
      }
    }
  };
  holds(scene["motion"]);
  for (const Json& row : scene["rows"]) {
    holds(row["replay"]);
    // The run that was measured, at six digits: no peak is lost between the times.
    double largest = 0;
    for (const Json& error : row["replay"]["errors"]) largest = std::max(largest, error.get<double>());
    const double measured = row["metrics"]["position_error"];
    EXPECT_NEAR(largest, measured, 1e-5 * measured);
  }
}

TEST(Report, ReplaysAreKeptUntilTheFiguresChange) {
  const Folder folder;
  compare(folder, {"--no-cost"});
  const std::string kept = folder.read("r/replays.jsonl");
  ASSERT_EQ(app::lines_of(kept).size(), 2u);
  // One that is kept is shown as it is: what would be run anew has no such time.
  std::string changed = kept;
  const std::string zero = "\"times\":[0,";
  for (std::size_t at = 0; (at = changed.find(zero, at)) != std::string::npos;)
    changed.replace(at, zero.size(), "\"times\":[5,");
  folder.write("r/replays.jsonl", changed);
  EXPECT_EQ(app::plumb({"report", folder.path("r")}).code, 0);
  const auto first = [&] {
    return data_of(folder.read("r/report.html"))["scenes"][0]["rows"][0]["replay"]["times"][0];
  };
  EXPECT_EQ(first(), 5);
  std::string results = folder.read("r/results.jsonl");
  results.replace(results.find("\"position_error\":"), 17, "\"position_error\":1");
  folder.write("r/results.jsonl", results);
  EXPECT_EQ(app::plumb({"report", folder.path("r")}).code, 0);
  EXPECT_EQ(first(), 0);
}

TEST(Report, FailuresAndWhatIsMissingAreSaid) {
  const Folder folder;
  const app::Ran none = app::plumb({"report", folder.path("nothing")});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, AllOf(HasSubstr("cannot be read"), HasSubstr("`plumb compare`")));
  folder.write("empty.jsonl", "");
  const app::Ran empty = app::plumb({"report", folder.path("empty.jsonl")});
  EXPECT_EQ(empty.code, 2);
  EXPECT_THAT(empty.err, HasSubstr("has no results"));
  folder.write("bad.jsonl", "{}\n{}\n");
  const app::Ran bad = app::plumb({"report", folder.path("bad.jsonl")});
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, HasSubstr("line 1"));
}

TEST(Report, TextOfEnginesCannotEndTheData) {
  Result row;
  row.label = "a scene of </script><b>";
  row.engine = "mine";
  row.status = Status::Failed;
  row.reason = "</script><script>alert(1)</script>";
  const std::string page = report_page("a <title>", report_data("a <title>", std::vector{row}, {}, {}));
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_THAT(page, HasSubstr("plumb: a &lt;title>"));
  EXPECT_EQ(data_of(page)["scenes"][0]["rows"][0]["reason"], row.reason);
}

TEST(Report, ASceneOfTheUsersOwnHasItsOrdersButNoPicture) {
  std::vector<Result> rows;
  for (const double dt : {0.1, 0.05, 0.025}) {
    Result row;
    row.label = "mine";
    row.engine = "plumb";
    row.dt = row.asked.dt = dt;
    row.metrics.position_error = 3 * dt * dt;
    row.cost = Cost{.ns_per_step = 10, .ns_per_simulated_second = 10 / dt, .repetitions = 9};
    rows.push_back(row);
  }
  const Json scene = Json::parse(report_data("mine", rows, {}, {}))["scenes"][0];
  EXPECT_FALSE(scene.contains("scene"));
  EXPECT_FALSE(scene.contains("motion"));
  ASSERT_EQ(scene["orders"].size(), 1u);
  EXPECT_NEAR(scene["orders"][0]["order"], 2, 1e-12);
  EXPECT_EQ(scene["rows"][1]["asked"], "dt 1/20");
}

TEST(Environments, EachOnceWithFirstAndLastDate) {
  const Folder folder;
  const auto line = [](const char* cpu, const char* date) {
    return Json{{"environment", {{"cpu", cpu}, {"date", date}}}}.dump() + "\n";
  };
  folder.write("r.jsonl", line("x", "2026-01-02T00:00:00Z") + line("y", "2026-01-03T00:00:00Z") +
                              line("x", "2026-01-01T00:00:00Z") + "{\"cut sho");
  const auto uses = read_environments(folder.path("r.jsonl"));
  ASSERT_EQ(uses.size(), 2u);
  EXPECT_EQ(uses[0].runs, 2);
  EXPECT_EQ(uses[0].where.date, "2026-01-01T00:00:00Z");
  EXPECT_EQ(uses[0].last, "2026-01-02T00:00:00Z");
  EXPECT_EQ(uses[1].where.cpu, "y");
}

}  // namespace
}  // namespace plumb::harness::report
