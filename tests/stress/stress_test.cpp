#include "harness/stress/stress.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/stress/map_text.h"
#include "tests/stress/fixture.h"

namespace plumb::harness::stress {
namespace {

using Json = nlohmann::json;

struct Fixture {
  Family first = family("first"), second = family("second", {1, 2, 3, 4, 5, 6, 7});
  fakes::FakeBackend good = engine("good"),
                     bad = engine("bad", [](long, double, std::span<BodyState> s) { s[0].position.y = 0.2; });
  Folder folder;
  StressOptions options{
      .families = {&first, &second}, .engines = {&good, &bad}, .folder = folder.path(), .jobs = 2};
};

TEST(Stress, WritesALineACell) {
  Fixture fixture;
  int families = 0;
  std::size_t steps = 0;
  const Stressed done = stress(fixture.options, {.progress =
                                                     [&](const Progress& now) {
                                                       ++steps;
                                                       EXPECT_EQ(now.total, 24u);
                                                     },
                                                 .finished =
                                                     [&](const Family&, const std::vector<Cell>& cells) {
                                                       ++families;
                                                       EXPECT_EQ(cells.size(), families == 1 ? 10u : 14u);
                                                     }});
  EXPECT_FALSE(done.interrupted);
  EXPECT_EQ(done.cells.size(), 24u);
  EXPECT_EQ(families, 2);
  EXPECT_EQ(steps, 24u);
  const std::vector<std::string> lines = fixture.folder.lines();
  ASSERT_EQ(lines.size(), 25u);
  const Json head = Json::parse(lines[0]);
  EXPECT_EQ(head["kind"], "environment");
  for (const char* name :
       {"plumb_version", "commit", "compiler", "cpu", "date", "cell_seconds", "cell_memory"})
    EXPECT_TRUE(head.contains(name)) << name;
  int ok = 0, sinks = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Json cell = Json::parse(lines[i]);
    EXPECT_EQ(cell["kind"], "cell");
    EXPECT_EQ(cell["axis"], "number");
    EXPECT_EQ(cell["outcome"] == "ok", cell["engine"] == "good");
    EXPECT_EQ(cell["reason"] == "", cell["engine"] == "good");
    (cell["outcome"] == "ok" ? ok : sinks) += 1;
  }
  EXPECT_EQ(ok, 12);
  EXPECT_EQ(sinks, 12);
}

TEST(Stress, GoesOnWhereItWas) {
  Fixture fixture;
  stress(fixture.options);
  const std::vector<std::string> before = fixture.folder.lines();
  int told = 0, ran = 0;
  const Stressed again =
      stress(fixture.options, {.progress = [&](const Progress&) { ++ran; },
                               .finished = [&](const Family&, const std::vector<Cell>&) { ++told; }});
  EXPECT_EQ(again.cells.size(), 24u);
  EXPECT_EQ(told, 2);
  EXPECT_EQ(ran, 0);
  EXPECT_EQ(fixture.folder.lines(), before);
  // Another engine is added to what is there.
  const fakes::FakeBackend third = engine("third");
  fixture.options.engines.push_back(&third);
  EXPECT_EQ(stress(fixture.options).cells.size(), 36u);
  EXPECT_EQ(fixture.folder.lines().size(), before.size() + 12);
  fixture.options.cell_seconds = 1;
  EXPECT_THROW(stress(fixture.options), Error) << "other limits";
}

TEST(Stress, QuickTakesEveryThirdValue) {
  Fixture fixture;
  fixture.options.quick = true;
  EXPECT_EQ(values_of(fixture.second, true), (std::vector<double>{1, 4, 7}));
  EXPECT_EQ(stress(fixture.options).cells.size(), 2u * (2 + 3));
}

// Killed again and again at whatever instant, it ends with what it would have had, each cell once.
TEST(Stress, SurvivesBeingKilled) {
  Fixture fixture;
  const fakes::FakeBackend slow = engine("slow", [](long, double, std::span<BodyState>) { usleep(300); });
  fixture.options.engines = {&slow};
  int killed = 0;
  bool finished = false;
  for (int attempt = 0; attempt < 200 && !finished; ++attempt) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      stress(fixture.options);
      _exit(0);
    }
    usleep(static_cast<useconds_t>(8'000 + 2'011 * attempt));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    finished = WIFEXITED(status);
    killed += finished ? 0 : 1;
  }
  EXPECT_TRUE(finished);
  EXPECT_GE(killed, 2);
  std::map<std::string, int> cells;
  for (const std::string& line : fixture.folder.lines())
    if (Json::parse(line)["kind"] == "cell") ++cells[key_of(cell_from_json(line))];
  EXPECT_EQ(cells.size(), 12u);
  for (const auto& [key, count] : cells) EXPECT_EQ(count, 1) << key;
}

TEST(Stress, TheSameForSomeFamiliesOfPlumb) {
  const Folder folder;
  const Stressed done = stress({.families = {&find_family("dt_fall"), &find_family("mass_ratio_stack")},
                                .engines = {&reference::find_backend("plumb-float")},
                                .folder = folder.path(),
                                .jobs = 2,
                                .quick = true});
  ASSERT_FALSE(done.cells.empty());
  int usual = 0;
  for (const Cell& cell : done.cells) {
    EXPECT_NE(cell.finding.verdict, Verdict::Crashed) << key_of(cell) << ": " << cell.finding.reason;
    if (cell.family == "mass_ratio_stack" && cell.value == 1) {
      EXPECT_TRUE(cell.survived()) << key_of(cell) << ": " << cell.finding.reason;
      ++usual;
    }
  }
  EXPECT_GE(usual, 2);
}

TEST(MapText, HasARowAnEngineAndAWordAnOutcome) {
  Fixture fixture;
  const Stressed done = stress(fixture.options);
  const std::span<const Cell> cells(done.cells);
  const std::string text = map_text(fixture.first, cells.subspan(0, 10), {});
  EXPECT_NE(text.find("first"), std::string::npos) << text;
  EXPECT_NE(text.find("  good       ok     ok     ok     ok     ok\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  bad     sinks  sinks  sinks  sinks  sinks\n"), std::string::npos) << text;
  const std::string counts = survival_text(cells, {});
  EXPECT_NE(counts.find("12 of   12  100.0 %"), std::string::npos) << counts;
  EXPECT_NE(counts.find("0 of   12    0.0 %"), std::string::npos) << counts;
  EXPECT_NE(legend({}).find("sinks: shapes overlap"), std::string::npos);
}

TEST(MapText, ValuesAreShort) {
  EXPECT_EQ(value_text(1e-6), "1e-6");
  EXPECT_EQ(value_text(0), "0");
  EXPECT_EQ(value_text(1.0 / 60), "1/60");
  EXPECT_EQ(value_text(0.05), "0.05");
  EXPECT_EQ(value_text(1), "1");
  EXPECT_EQ(value_text(300), "300");
  EXPECT_EQ(value_text(1000), "1e3");
  EXPECT_EQ(value_text(1e4), "1e4");
  EXPECT_EQ(value_text(1e9), "1e9");
  EXPECT_EQ(value_text(3e-3), "0.003");
}

}  // namespace
}  // namespace plumb::harness::stress
