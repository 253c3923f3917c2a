#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "harness/limits/limits_page.h"
#include "harness/stress/cell.h"
#include "tests/app/program.h"

// docs/limits.md: what is measured in it is written by the program.
namespace plumb::harness::limits {
namespace {

std::string file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream) << path;
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string cell(const char* engine, double value, stress::Verdict verdict, const char* reason = "") {
  stress::Cell cell{.family = "stack", .title = "a heavy box on a light one", .axis = "mass ratio"};
  cell.value = value;
  cell.engine = engine;
  cell.setting = "default";
  cell.finding = {.verdict = verdict, .reason = reason};
  return stress::to_json(cell) + "\n";
}

std::string threshold(const char* engine, const char* rest) {
  return fmt::format(
      R"({{"kind":"threshold","name":"overhang","title":"t","quantity":"overhang","unit":"","holds":"below","exact":0.5,)"
      R"("source":"s","judged":"j","engine":"{}","engine_version":"1","setting":"default","settings":{{}},"digits":3,)"
      R"({},"reason":"","runs":7,"seconds":1}})"
      "\n",
      engine, rest);
}

TEST(Limits, TellWhereWhatSurvivesEnds) {
  const app::Folder folder;
  folder.write("stress.jsonl", R"({"kind":"environment","plumb_version":"1","commit":"abc","cpu":"a CPU"})"
                               "\n" +
                                   cell("plumb-float", 1, stress::Verdict::Ok) +
                                   cell("plumb-float", 1000, stress::Verdict::Sinks, "by 3 mm") +
                                   cell("plumb-float", 10, stress::Verdict::Ok) +
                                   cell("plumb-float", 1e6, stress::Verdict::Explodes, "far away") +
                                   cell("plumb-precise", 1, stress::Verdict::Ok) +
                                   cell("plumb-precise", 10, stress::Verdict::Ok) +
                                   cell("plumb-precise", 1000, stress::Verdict::Ok) +
                                   cell("plumb-precise", 1e6, stress::Verdict::Ok) +
                                   cell("box2d", 1, stress::Verdict::NotFinite, "at 2 s") +
                                   cell("mujoco", 1, stress::Verdict::Skipped, "no contacts"));
  folder.write("thresholds.jsonl",
               threshold("plumb-float", R"("found":0.45,"low":0.449,"high":0.451,"outcome":"found")") +
                   threshold("mujoco", R"("found":null,"low":0,"high":1,"outcome":"refused")"));
  const LimitsData data = read_limits(folder.path());
  const std::string page = measured_part(data);
  for (const char* part :
       {"commit abc, on a CPU", "| `plumb-float` | 2 | 4 | 50.0 % | 1 explodes, 1 sinks |",
        "| `plumb-float` | 1 to 10 |  | sinks at 1000: by 3 mm |", "| `plumb-precise` | all |",
        "| `box2d` | nowhere | NaN at 1: at 2 s |", "Not supported by `mujoco`.",
        "| a heavy box on a light one | mass ratio 1 to 1e+06 | `plumb-precise` |",
        "| overhang | 0.5000 | 0.450 (-10 %) |"})
    EXPECT_NE(page.find(part), std::string::npos) << part << "\n" << page;
  EXPECT_EQ(measured_part(limits_from_jsonl(to_jsonl(data))), page) << "what is kept makes the same page";
}

TEST(Limits, StandBetweenTheMarkers) {
  const std::string before = "hand\n" + std::string(kBegin) + "old\n" + std::string(kEnd) + "written\n";
  const std::string after = with_measured_part(before, "new\n");
  EXPECT_EQ(measured_part_of(after), "new\n");
  EXPECT_EQ(after.substr(0, 5), "hand\n");
  EXPECT_EQ(after.substr(after.size() - 8), "written\n");
  EXPECT_THROW(with_measured_part("no markers", ""), Error);
  EXPECT_THROW(with_measured_part(before + std::string(kBegin), ""), Error);
  EXPECT_THROW(with_measured_part(std::string(kEnd) + std::string(kBegin), ""), Error);
}

TEST(Limits, WithoutResultsSayWhatMakesThem) {
  const app::Folder folder;
  const app::Ran ran = app::plumb({"limits", folder.path()});
  EXPECT_EQ(ran.code, 2);
  EXPECT_NE(ran.err.find("plumb stress"), std::string::npos) << ran.err;
}

TEST(Limits, TheProgramWritesPageAndData) {
  const app::Folder folder;
  folder.write("thresholds.jsonl",
               threshold("box2d", R"("found":0.5,"low":0.49,"high":0.51,"outcome":"found")"));
  const std::string page = folder.write("page.md", std::string(kBegin) + std::string(kEnd));
  EXPECT_EQ(app::plumb({"limits", folder.path(), "--out", page}).code, 0);
  EXPECT_EQ(measured_part_of(folder.read("page.md")),
            measured_part(limits_from_jsonl(folder.read("page.jsonl"))));
  EXPECT_EQ(app::plumb({"limits", folder.path()}).out, measured_part_of(folder.read("page.md")));
}

// docs/limits.md is what docs/limits.jsonl makes: its figures are not edited by hand.
TEST(Limits, ThePageIsWhatTheResultsMake) {
  const std::string docs = PLUMB_SOURCE_DIR "/docs/";
  EXPECT_EQ(measured_part_of(file(docs + "limits.md")),
            measured_part(limits_from_jsonl(file(docs + "limits.jsonl"))))
      << "write it anew: plumb limits DIR --out docs/limits.md";
}

}  // namespace
}  // namespace plumb::harness::limits
