#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/app/program.h"

namespace plumb::app {
namespace {

using Json = nlohmann::json;

TEST(Compare, WritesResultsAsItSays) {
  const Folder folder;
  const Ran ran = plumb(
      {"compare", "free_fall/vacuum", "--engine", "plumb,plumb-precise", "--out", folder.path("results")});
  EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("free_fall/vacuum"), std::string::npos);
  EXPECT_EQ(ran.err, "");
  EXPECT_EQ(ran.out.find('\x1b'), std::string::npos) << "no colour but on a terminal";
  const auto lines = lines_of(folder.read("results/results.jsonl"));
  ASSERT_EQ(lines.size(), 2u);
  const Json json = Json::parse(lines[0]);
  EXPECT_EQ(json["scenario"], "free_fall");
  EXPECT_EQ(json["variant"], "vacuum");
  EXPECT_EQ(json["engine"], "plumb");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["precision"], "double");
  for (const char* key :
       {"position_error", "velocity_error", "energy_drift", "momentum_drift", "joint_gap", "penetration"})
    EXPECT_TRUE(json["metrics"].contains(key)) << key;
  for (const char* key : {"ns_per_step", "ns_per_simulated_second", "setup_ns"})
    EXPECT_GT(json["cost"][key].get<double>(), 0) << key;
  for (const Json& check : json["checks"])
    for (const char* key : {"name", "oracle", "value", "tolerance", "pass"})
      EXPECT_TRUE(check.contains(key)) << key;
  // Appended, not overwritten.
  plumb({"compare", "free_fall/vacuum", "--engine", "plumb", "--no-cost", "--out", folder.path("results")});
  EXPECT_EQ(lines_of(folder.read("results/results.jsonl")).size(), 3u);
}

TEST(Compare, FormatsAreDataAlone) {
  const Folder folder;
  const std::vector<std::string> common = {"compare",   "free_fall", "--engine",       "plumb",
                                           "--no-cost", "--out",     folder.path("r"), "--format"};
  const auto with = [&](const char* format) {
    std::vector<std::string> arguments = common;
    arguments.emplace_back(format);
    return plumb(arguments);
  };
  const Ran json = with("json");
  for (const std::string& line : lines_of(json.out)) EXPECT_EQ(Json::parse(line)["engine"], "plumb");
  EXPECT_EQ(lines_of(json.out).size(), 2u);
  const Ran csv = with("csv");
  EXPECT_EQ(lines_of(csv.out).size(), 3u);
  EXPECT_EQ(csv.out.substr(0, 9), "scenario,");
  EXPECT_EQ(json.err + csv.err, "");
}

TEST(Compare, AProgramThatIsNoEngineIsRefused) {
  const Folder folder;
  const Ran ran = plumb(
      {"compare", "free_fall/vacuum", "--engine-command", "mine=/bin/false", "--out", folder.path("r")});
  EXPECT_EQ(ran.code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_NE(ran.err.find("mine=/bin/false"), std::string::npos) << ran.err;
}

// `--engine` may name what `--engine-command` gives: then nothing else runs.
TEST(Compare, AnEngineGivenByACommandIsKnownByItsName) {
  const Folder folder;
  const std::string worker =
      (std::filesystem::path(PLUMB_PROGRAM).parent_path() / "plumb-worker-bullet-double").string();
  if (!std::filesystem::exists(worker)) GTEST_SKIP() << "no engine is built as a program";
  const Ran ran = plumb({"compare", "free_fall/vacuum", "--engine", "mine", "--engine-command",
                         "mine=" + worker, "--format", "json", "--out", folder.path("r")});
  const auto lines = lines_of(ran.out);
  EXPECT_FALSE(lines.empty()) << ran.err;
  for (const std::string& line : lines) EXPECT_EQ(Json::parse(line)["engine"], "mine");
}

TEST(Compare, AnInterruptKeepsWhatIsFinished) {
  const Folder folder;
  const pid_t process = start_plumb({"compare", "--engine", "plumb,plumb-float", "--out", folder.path("r")});
  for (int i = 0; i < 1200 && lines_of(folder.read("r/results.jsonl")).size() < 2; ++i) usleep(50'000);
  kill(process, SIGINT);
  EXPECT_EQ(wait_for(process), 130);
  const auto lines = lines_of(folder.read("r/results.jsonl"));
  EXPECT_GE(lines.size(), 2u);
  for (const std::string& line : lines) EXPECT_TRUE(Json::accept(line)) << line;
}

TEST(Run, AnInterruptEndsWithWholeLines) {
  const pid_t process = start_plumb({"run", "pendulum_chain[1]", "--duration", "100000"});
  usleep(500'000);
  kill(process, SIGINT);
  EXPECT_EQ(wait_for(process), 130);
}

// On a terminal of its own, made by script(1).
TEST(Compare, ColoursATerminalUnlessNoColorIsSet) {
  if (access("/usr/bin/script", X_OK) != 0) GTEST_SKIP() << "script(1) is not installed";
  if (std::system("script -qec true /dev/null > /dev/null 2>&1 < /dev/null") != 0)
    GTEST_SKIP() << "this system gives out no terminals (/dev/pts is not mounted)";
  const Folder folder;
  const auto on_terminal = [&](const std::string& before) {
    const std::string inner = before + " TERM=xterm " + PLUMB_PROGRAM +
                              " compare free_fall/vacuum --engine plumb --no-cost --out " + folder.path("r");
    const std::string command =
        "script -qec '" + inner + "' /dev/null > " + folder.path("out") + " 2>&1 < /dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return folder.read("out");
  };
  EXPECT_NE(on_terminal("env -u NO_COLOR").find("\x1b[1m"), std::string::npos);
  EXPECT_EQ(on_terminal("env NO_COLOR=1").find("\x1b[1m"), std::string::npos);
}

}  // namespace
}  // namespace plumb::app
