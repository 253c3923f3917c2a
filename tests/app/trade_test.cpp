#include <unistd.h>

#include <csignal>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

// Uses sweep, front, tune and the comparison of results as a user does.
namespace plumb::app {
namespace {

using Json = nlohmann::json;

TEST(Sweep, KilledInTheMiddleTheSameCommandGoesOn) {
  const Folder folder;
  const std::vector<std::string> command{
      "sweep", "free_fall/drag", "--engine", "plumb,box2d", "--budget", "8", "--out", folder.path("s")};
  const pid_t process = start_plumb(command);
  for (int i = 0; i < 600 && lines_of(folder.read("s/sweep.jsonl")).size() < 8; ++i) usleep(20'000);
  kill(process, SIGKILL);
  EXPECT_EQ(wait_for(process), -SIGKILL);
  const std::size_t before = lines_of(folder.read("s/sweep.jsonl")).size();
  EXPECT_GE(before, 8u);
  const Ran ran = plumb(command);
  EXPECT_EQ(ran.code, 0) << ran.err;
  for (const char* part : {"free_fall/drag", "dominance", "box2d", "overall", "front"})
    EXPECT_NE(ran.out.find(part), std::string::npos) << part << ran.out;
  std::map<std::string, int> runs;
  for (const std::string& line : lines_of(folder.read("s/sweep.jsonl"))) {
    const Json json = Json::parse(line);
    if (json["kind"] == "run") ++runs[json["result"]["engine"].dump() + json["result"]["asked"].dump()];
  }
  for (const auto& [run, count] : runs) EXPECT_EQ(count, 1) << run;
  // Complete parts are not run again.
  const std::string results = folder.read("s/results.jsonl");
  const Ran again = plumb(command);
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(folder.read("s/results.jsonl"), results);

  const Ran front = plumb({"front", folder.path("s"), "--format", "json"});
  EXPECT_EQ(front.code, 0) << front.err;
  const Json json = Json::parse(front.out);
  EXPECT_EQ(json["scenes"][0]["label"], "free_fall/drag");
  EXPECT_EQ(json["dominance"][0]["rival"], "box2d");
  EXPECT_GE(json["dominance"][0]["points"], 3);  // how many depends on costs, which are measured

  const Ran same = plumb({"compare", folder.path("s"), folder.path("s/results.jsonl")});
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  EXPECT_NE(same.out.find("0 figures better, 0 worse"), std::string::npos) << same.out;
  EXPECT_NE(same.out.find("costs: 0 better, 0 worse"), std::string::npos) << same.out;
}

// The settings that a sweep chose, its engines and its instants of measurement are all in its results.
TEST(Compare, RunsOfASweepMadeAgainAreTheSameToTheBit) {
  const Folder folder;
  const Ran swept = plumb({"sweep", "free_fall/drag", "--engine", "plumb,plumb-precise,box2d", "--budget",
                           "3", "--out", folder.path("s")});
  ASSERT_EQ(swept.code, 0) << swept.err;
  // Finer than what a sweep measures at.
  ASSERT_EQ(plumb({"compare", "free_fall/vacuum", "--engine", "plumb", "--dt", "1/1000", "--no-cost",
                   "--no-report", "--out", folder.path("s")})
                .code,
            0);
  const std::size_t count = lines_of(folder.read("s/results.jsonl")).size();
  const std::vector<std::string> command = {
      "compare", "--again", folder.path("s"), "--out", folder.path("again"), "--jobs", "2"};
  const Ran again = plumb(command);
  EXPECT_EQ(again.code, 0) << again.out << again.err;
  EXPECT_NE(again.out.find("all runs are identical to the bit"), std::string::npos) << again.out;
  EXPECT_EQ(lines_of(folder.read("again/results.jsonl")).size(), count);
  // Complete runs are not made a second time.
  EXPECT_EQ(plumb(command).code, 0);
  EXPECT_EQ(lines_of(folder.read("again/results.jsonl")).size(), count);

  std::string one_digit = folder.read("s/results.jsonl");
  one_digit.insert(one_digit.find("\"position_error\":") + 17, "1");
  folder.write("s/results.jsonl", one_digit);
  const Ran differs = plumb(command);
  EXPECT_EQ(differs.code, 1);
  EXPECT_NE(differs.out.find("not all runs are the same"), std::string::npos) << differs.out;
  EXPECT_EQ(plumb({"compare", "--again", folder.path("s"), "--out", folder.path("s")}).code, 2);
}

TEST(Compare, ResultsAndScenariosAreNotMixed) {
  const Folder folder;
  folder.write("results.jsonl", "");
  EXPECT_EQ(plumb({"compare", folder.path(), "free_fall"}).code, 2);
  EXPECT_EQ(plumb({"compare", folder.path()}).code, 2);
  const Ran missing = plumb({"compare", folder.path(), "./nothing/"});
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.err.find("nothing"), std::string::npos) << missing.err;
}

TEST(Tune, FindsSettingsThatReachIt) {
  const Ran ran = plumb({"tune", "pendulum_chain", "--size", "3", "--tolerance", "1e-3", "--seconds", "8",
                         "--engine", "plumb,plumb-precise,box2d", "--format", "json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  EXPECT_EQ(json["against"], "truth");
  ASSERT_EQ(json["answers"].size(), 3u);
  const Json& best = json["answers"][0];
  EXPECT_LE(best["reaches"]["position_error"], 1e-3);
  EXPECT_TRUE(best["reaches"]["confirmed"]);
  EXPECT_GT(best["reaches"]["ns_per_game_step"], 0);
  EXPECT_EQ(json["answers"][0]["engine"].get<std::string>().substr(0, 5), "plumb");
}

// The scene of a user has no known answer: that is said, and the settings hold against the engine's limit.
TEST(Tune, AFileOfTheUsersOwn) {
  const Folder folder;
  Json scene = Json::parse(plumb({"scene", "pendulum_chain", "--size", "2"}).out);
  scene["name"] = "my pendulum";
  const std::string path = folder.write("mine.json", scene.dump());
  // Short: a double pendulum is chaotic, and what needs fine steps has to fit into the time on a busy machine
  // too.
  const Ran ran =
      plumb({"tune", path, "--tolerance", "1e-2", "--duration", "2", "--seconds", "20", "--engine", "plumb"});
  EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
  for (const char* part : {"own limit", "plumb", "to paste", "\"dt\""})
    EXPECT_NE(ran.out.find(part), std::string::npos) << part << ran.out;
}

// A spring of a user's own: each engine is held against its own limit, of which no figure is below the
// accuracy.
TEST(Sweep, ASceneFileIsHeldAgainstOwnLimitsAndCanBeRepeated) {
  const Folder folder;
  const std::string path = folder.write("one.json", R"({"gravity": [0, 0],
      "bodies": [{"name": "a", "position": [2, 0], "inertia": 1}],
      "forces": [{"type": "spring", "body_a": "world", "body_b": "a", "stiffness": 60}]})");
  const Ran ran = plumb({"sweep", path, "--duration", "0.5", "--engine", "plumb,box2d", "--budget", "6",
                         "--out", folder.path("s"), "--format", "json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json json = Json::parse(ran.out);
  for (const Json& engine : json["scenes"][0]["engines"]) {
    const double least = engine["truth_within"];
    EXPECT_GT(least, 0) << engine;
    EXPECT_NE(engine["truth"].get<std::string>().find(engine["engine"].get<std::string>()),
              std::string::npos);
    for (const Json& point : engine["front"]) EXPECT_GE(point["error"], least) << engine;
    for (const Json& at : engine["cost_at_error"])
      EXPECT_TRUE(at["error"] >= least || at["ns_per_simulated_second"].is_null()) << at;
  }
  for (const Json& rival : json["dominance"]) EXPECT_FALSE(rival["compared"]) << rival;

  const Ran unnamed = plumb({"compare", "--again", folder.path("s"), "--out", folder.path("again")});
  EXPECT_EQ(unnamed.code, 2);
  EXPECT_NE(unnamed.err.find("name the scene files"), std::string::npos) << unnamed.err;
  const Ran again = plumb({"compare", "--again", folder.path("s"), path, "--out", folder.path("again")});
  EXPECT_EQ(again.code, 0) << again.out << again.err;
  EXPECT_NE(again.out.find("identical to the bit"), std::string::npos) << again.out;
}

TEST(Tune, WithinABudget) {
  const Ran ran = plumb({"tune", "free_fall/drag", "--budget-us", "50", "--seconds", "4", "--engine",
                         "plumb,box2d", "--format", "json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Json json = Json::parse(ran.out);  // which outlives the loop over what is in it
  for (const Json& answer : json["answers"]) EXPECT_LE(answer["reaches"]["ns_per_game_step"], 50e3) << answer;
  EXPECT_EQ(plumb({"tune", "free_fall/drag"}).code, 2);
}

}  // namespace
}  // namespace plumb::app
