#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "tests/app/program.h"

namespace plumb::app {
namespace {

TEST(Usage, HelpAndVersion) {
  const Ran help = plumb({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("Examples:"), std::string::npos);
  for (const char* command : {"list", "engines", "explain", "run", "scene", "compare", "bench"}) {
    EXPECT_NE(help.out.find(command), std::string::npos) << command;
    if (std::string(command) == "bench") continue;
    const Ran own = plumb({command, "--help"});
    EXPECT_EQ(own.code, 0) << command;
    EXPECT_NE(own.out.find("Examples:"), std::string::npos) << command;
    EXPECT_EQ(own.err, "") << command;
  }
  const Ran version = plumb({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.substr(0, 6), "plumb ");
  EXPECT_EQ(plumb({}).code, 2);
}

TEST(Usage, AFullMediumIsAnErrorForEveryKindOfOutput) {
  for (const char* arguments : {"--version", "--help", "list", "run --help"}) {
    const std::string command = "\"" PLUMB_PROGRAM "\" " + std::string(arguments) + " >/dev/full 2>/dev/null";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2) << arguments;
  }
}

TEST(Usage, AFullMediumIsAnErrorForTheBenchmarksToo) {
  if (!std::filesystem::exists(std::filesystem::path(PLUMB_PROGRAM).parent_path() / "plumb_bench"))
    GTEST_SKIP() << "plumb_bench is not built";
  const int status = std::system("\"" PLUMB_PROGRAM "\" bench --benchmark_list_tests >/dev/full 2>/dev/null");
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

// Runs the examples of each --help for half a second, as a shell does, in one folder for each subcommand: an
// error of usage, or of a folder that another example uses, comes at once. Their files need not exist.
TEST(Usage, ExamplesInHelpTextsRunAsPrinted) {
  const std::string bin = std::filesystem::path(PLUMB_PROGRAM).parent_path().string();
  int examples = 0;
  for (const std::string& line : lines_of(plumb({"--help"}).out)) {
    // The names of subcommands are indented by two, their descriptions by more.
    if (line.size() < 3 || line.substr(0, 2) != "  " || line[2] < 'a' || line[2] > 'z') continue;
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    if (name == "plumb" || name == "bench" || name == "demo" || name == "view") continue;
    const Folder folder;
    for (const std::string& text : lines_of(plumb({name, "--help"}).out)) {
      if (text.substr(0, 8) != "  plumb ") continue;
      ++examples;
      for (const char* needed : {"docs", "results-before", "results-after"})
        std::filesystem::create_directories(folder.path() + "/" + needed);
      for (const char* results : {"results-before/results.jsonl", "results-after/results.jsonl"})
        folder.write(results, "");
      folder.write("example.sh", text);
      const std::string command = "cd " + folder.path() + " && PATH=" + bin +
                                  ":$PATH timeout -s KILL 0.5 sh example.sh >/dev/null 2>err </dev/null";
      const int status = std::system(command.c_str());
      if (WEXITSTATUS(status) != 2) continue;
      const std::string said = folder.read("err");
      bool excused = false;
      for (const char* missing : {"No such file", "File does not exist", "there is no folder",
                                  "cannot be read", "give a folder", "has neither"})
        excused = excused || said.find(missing) != std::string::npos;
      EXPECT_TRUE(excused) << text << "\n" << said;
    }
  }
  EXPECT_GT(examples, 30);
}

struct Bad {
  const char* name;
  std::vector<std::string> arguments;
  std::vector<std::string> says;  // parts of the one line on stderr
};

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.arguments.back(); }

class BadInput : public testing::TestWithParam<Bad> {};

TEST_P(BadInput, IsOneLineOnStderrAndExitCode2) {
  const Ran ran = plumb(GetParam().arguments);
  EXPECT_EQ(ran.code, 2) << ran.err;
  EXPECT_EQ(ran.out, "");
  const auto lines = lines_of(ran.err);
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.size(), 1u) << ran.err;
  EXPECT_EQ(lines.back().substr(0, 7), "plumb: ") << ran.err;
  for (const std::string& part : GetParam().says)
    EXPECT_NE(lines.back().find(part), std::string::npos) << part << "\n" << ran.err;
}

INSTANTIATE_TEST_SUITE_P(
    plumb, BadInput,
    testing::Values(
        Bad{"subcommand", {"comprae"}, {"comprae", "did you mean 'compare'"}},
        Bad{"option",
            {"run", "free_fall/vacuum", "--duraton", "1"},
            {"--duraton", "--duration", "plumb run --help"}},
        Bad{"option_of_none", {"--verion"}, {"--verion", "--version"}},
        Bad{"no_name", {"run"}, {"plumb run --help"}},
        Bad{"scenario", {"run", "free_fal"}, {"free_fal", "did you mean 'free_fall'", "plumb list"}},
        Bad{"variant", {"scene", "free_fall/vacum"}, {"vacum", "did you mean 'vacuum'"}},
        Bad{"size_zero", {"scene", "pendulum_chain[0]"}, {"size is 0"}},
        Bad{"size_negative", {"scene", "pendulum_chain", "--size", "-3"}, {"--size", "-3", "above 0"}},
        Bad{"size_huge", {"scene", "pendulum_chain[1000000000]"}, {"1000000000", "at most 1000000"}},
        Bad{"size_not_taken", {"scene", "free_fall", "--size", "7"}, {"size"}},
        Bad{"engine",
            {"run", "free_fall/vacuum", "--engine", "box2e"},
            {"box2e", "did you mean 'box2d'", "plumb engines"}},
        Bad{"engine_of_compare",
            {"compare", "free_fall", "--engine", "plum"},
            {"plum", "did you mean 'plumb'"}},
        Bad{"dt_zero", {"run", "free_fall/vacuum", "--dt", "0"}, {"--dt", "'0'"}},
        Bad{"dt_negative", {"compare", "--dt", "-0.1"}, {"--dt"}},
        Bad{"dt_nan", {"run", "free_fall/vacuum", "--dt", "nan"}, {"--dt", "'nan'"}},
        Bad{"dt_infinite", {"run", "free_fall/vacuum", "--dt", "inf"}, {"--dt", "'inf'"}},
        Bad{"dt_by_zero", {"run", "free_fall/vacuum", "--dt", "1/0"}, {"--dt", "'1/0'"}},
        Bad{"dt_words", {"run", "free_fall/vacuum", "--dt", "fast"}, {"--dt", "'fast'"}},
        Bad{"dt_tiny", {"run", "free_fall/vacuum", "--dt", "1e-12"}, {"too many"}},
        Bad{"dt_too_short", {"run", "free_fall/vacuum", "--dt", "1e-90"}, {"1e-12 to 1e12"}},
        Bad{"dt_too_long", {"run", "free_fall/vacuum", "--dt", "1e18"}, {"1e-12 to 1e12"}},
        Bad{"dt_empty", {"run", "free_fall/vacuum", "--dt", ""}, {"--dt", "empty"}},
        Bad{"duration_empty", {"run", "free_fall/vacuum", "--duration", ""}, {"--duration", "empty"}},
        Bad{"substeps_empty", {"run", "free_fall/vacuum", "--substeps", ""}, {"--substeps"}},
        Bad{"engine_empty", {"run", "free_fall/vacuum", "--engine", ""}, {"--engine", "empty"}},
        Bad{"tolerance_below_rounding",
            {"run", "free_fall/vacuum", "--engine", "plumb-precise", "--tolerance", "1e-300"},
            {"1e-12 to"}},
        Bad{"seed_beyond_64_bits",
            {"hunt", "--seed", "9223372036854775808"},
            {"--seed", "0 to 9223372036854775807"}},
        Bad{"seed_negative", {"hunt", "--seed", "-1"}, {"--seed", "0 to 9223372036854775807"}},
        Bad{"no_scenes", {"hunt", "--scenes", "0"}, {"--scenes", "1 to 9223372036854775807"}},
        Bad{"agreement_of_nothing", {"agreement", "/dev/null"}, {"no results"}},
        Bad{"front_of_nothing", {"front", "/dev/null"}, {"no results"}},
        Bad{"new_without_permission",
            {"new", "scenario", "rolling_ring", "--folder", "/proc"},
            {"/proc/rolling_ring.cpp", "cannot be written: "}},
        Bad{"hunt_without_permission",
            {"hunt", "--out", "/proc/hunt"},
            {"/proc/hunt", "cannot be created: "}},
        Bad{"substeps", {"run", "free_fall/vacuum", "--substeps", "0"}, {"--substeps", "'0'"}},
        Bad{"substeps_huge", {"run", "free_fall/vacuum", "--substeps", "99999999999"}, {"--substeps"}},
        Bad{"tolerance",
            {"run", "free_fall/vacuum", "--engine", "plumb-precise", "--tolerance", "0"},
            {"--tolerance", "'0'"}},
        Bad{"tolerance_of_fixed",
            {"run", "free_fall/vacuum", "--engine", "plumb", "--tolerance", "1e-9"},
            {"tolerance"}},
        Bad{"substeps_of_adaptive",
            {"run", "free_fall/vacuum", "--engine", "plumb-precise", "--substeps", "2"},
            {"substeps"}},
        Bad{"set_shape", {"run", "free_fall/vacuum", "--set", "integrator"}, {"--set", "OPTION=VALUE"}},
        Bad{"set_name", {"run", "free_fall/vacuum", "--set", "integratr=explicit_euler"}, {"integratr"}},
        Bad{"set_value", {"run", "free_fall/vacuum", "--set", "integrator=exlicit_euler"}, {"exlicit_euler"}},
        Bad{"duration", {"run", "free_fall/vacuum", "--duration", "-1"}, {"--duration"}},
        Bad{"rate_zero", {"run", "free_fall/vacuum", "--rate", "0"}, {"--rate", "'0'"}},
        Bad{"rate_between", {"run", "free_fall/vacuum", "--rate", "25"}, {"--rate", "60, 30, 20"}},
        Bad{"rate_high", {"run", "free_fall/vacuum", "--rate", "1000"}, {"--rate", "60"}},
        Bad{"format", {"run", "free_fall/vacuum", "--format", "xml"}, {"--format"}},
        Bad{"missing_file", {"run", "nowhere/scene.json"}, {"nowhere/scene.json", "No such file"}},
        Bad{"folder", {"run", "/tmp"}, {"/tmp", "directory"}},
        Bad{"size_of_file", {"run", "/dev/null", "--size", "3"}, {"--size"}},
        Bad{"empty_file", {"run", "/dev/null"}, {"line 1"}},
        Bad{"out_is_a_file", {"compare", "free_fall", "--out", "/dev/null"}, {"/dev/null", "--out"}},
        Bad{"engine_command",
            {"compare", "free_fall", "--engine-command", "mine"},
            {"--engine-command", "NAME=COMMAND"}},
        Bad{"engine_command_twice",
            {"compare", "free_fall", "--engine-command", "plumb=true"},
            {"plumb", "already"}},
        Bad{"engine_command_quote",
            {"compare", "free_fall", "--engine-command", "mine=\"true"},
            {"\"true", "quote", "closed"}},
        Bad{"chapter_zero", {"check", "--engine", "plumb", "--chapter", "0"}, {"--chapter", "1 to 5"}},
        Bad{"out_empty", {"sweep", "free_fall", "--out", ""}, {"--out", "empty"}},
        Bad{"duration_of_a_scenario",
            {"sweep", "free_fall", "--duration", "5"},
            {"--duration", "scene file"}},
        Bad{"threshold", {"thresholds", "overhong"}, {"overhong", "overhang", "--list"}},
        Bad{"explain_a_rival", {"explain", "free_fall/vacuum", "--engine", "box2d"}, {"box2d", "plan"}}),
    [](const auto& which) { return which.param.name; });

TEST(Usage, ARefusalNamesAnEngineThatRunsTheScene) {
  const Folder folder;
  const std::string scene = folder.write(
      "weld.json",
      R"({"bodies": [{"name": "a", "mass": 1, "inertia": 1}], "joints": [{"type": "weld", "name": "j",
          "body_a": "world", "body_b": "a"}]})");
  for (const char* engine : {"chipmunk", "ode", "mujoco", "simbody", "bullet-multibody", "box2d"}) {
    const Ran ran = plumb({"run", scene, "--engine", engine, "--duration", "0.1"});
    if (ran.code == 0 || ran.err.find("not in this build") != std::string::npos) continue;
    EXPECT_EQ(ran.code, 2) << engine;
    EXPECT_NE(ran.err.find("'plumb"), std::string::npos) << ran.err;
  }
}

// Libraries greet on stdout, but only data goes there: the first line is the header.
TEST(Usage, NoEnginePrintsAmongTheData) {
  for (const char* engine : {"box2d", "bullet", "chipmunk", "ode", "mujoco", "simbody"}) {
    const Ran ran = plumb({"run", "free_fall", "--engine", engine, "--format", "csv"});
    if (ran.code != 0) continue;
    EXPECT_EQ(ran.out.substr(0, ran.out.find('\n')), "t,body,x,y,angle,vx,vy,w") << engine;
  }
}

// A broken scene file: the line, the body, the field and the value are named.
struct Broken {
  const char* name;
  const char* text;
  std::vector<std::string> says;
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }

class BrokenScene : public testing::TestWithParam<Broken> {};

TEST_P(BrokenScene, NamesLineBodyFieldAndValue) {
  const Folder folder;
  const Ran ran = plumb({"run", folder.write("scene.json", GetParam().text), "--duration", "1"});
  EXPECT_EQ(ran.code, 2) << ran.err;
  EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
  for (const std::string& part : GetParam().says)
    EXPECT_NE(ran.err.find(part), std::string::npos) << part << "\n" << ran.err;
}

INSTANTIATE_TEST_SUITE_P(
    plumb, BrokenScene,
    testing::Values(Broken{"mask",
                           "{\"bodies\": [{\"name\": \"a\", \"shapes\": [{\"type\": \"circle\", "
                           "\"radius\": 1,\n\"filter\": {\"mask\": -9223372036854775809}}]}]}",
                           {"line 2", "'a'", "mask", "-2^63"}},
                    Broken{"mass",
                           "{\"name\": \"s\", \"bodies\": [\n{\"name\": \"ball\",\n \"mass\": -2}]}",
                           {"line 3", "'ball'", "mass", "-2"}},
                    Broken{"syntax", "{\"name\": \"s\",\n\"bodies\": [,]}", {"line 2"}},
                    Broken{"radius",
                           "{\"name\": \"s\", \"bodies\": [{\"name\": \"ball\", \"shapes\": [\n{\"type\": "
                           "\"circle\", \"radius\": 0}]}]}",
                           {"line 2", "radius", "0"}},
                    Broken{"twice",
                           "{\"name\": \"s\", \"bodies\": [{\"name\": \"ball\", \"inertia\": 1},\n{\"name\": "
                           "\"ball\", \"inertia\": 1}]}",
                           {"line 2", "'ball'"}}),
    [](const auto& which) { return which.param.name; });

TEST(Output, AClosedPipeEndsQuietly) {
  const Folder folder;
  const std::string command = std::string(PLUMB_PROGRAM) + " run free_fall/vacuum --dt 1/10000 2>" +
                              folder.path("err") + " | head -n 2 > " + folder.path("out");
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(lines_of(folder.read("out")).size(), 2u);
  EXPECT_EQ(folder.read("err"), "");
}

// With stdout closed, the next file that is opened would get its number, and be written into.
TEST(Output, AClosedStdoutIsAnErrorAndLeavesResultsAsTheyAre) {
  const Folder folder;
  const std::string common =
      std::string(PLUMB_PROGRAM) + " compare free_fall/vacuum --engine plumb --no-cost ";
  const std::string command = common + "--out " + folder.path("r") + " >&- 2>" + folder.path("err");
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_EQ(folder.read("err"), "plumb: stdout: Bad file descriptor\n");
  const std::vector<std::string> lines = lines_of(folder.read("r/results.jsonl"));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines.front().front(), '{');
}

TEST(Output, AFullMediumIsAnError) {
  const Folder folder;
  const std::string command = std::string(PLUMB_PROGRAM) + " list > /dev/full 2>" + folder.path("err");
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_NE(folder.read("err").find("plumb: stdout"), std::string::npos) << folder.read("err");
}

// A run has data to give, whether or not somebody listens to what it says besides.
TEST(Output, ARunWhoseStderrCannotBeWrittenGivesItsData) {
  const Folder folder;
  for (const std::string stderr_to : {"2>&-", "2>/dev/full", "2> >(true)"}) {
    const std::string command = "bash -c '" + std::string(PLUMB_PROGRAM) +
                                " run elastic_collision --duration 0.1 --format json " + stderr_to + " > " +
                                folder.path("out") + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << stderr_to;
    EXPECT_EQ(lines_of(folder.read("out")).size(), 7u) << stderr_to;
    const std::string refused =
        "bash -c '" + std::string(PLUMB_PROGRAM) + " run no-such-scene " + stderr_to + "'";
    EXPECT_EQ(WEXITSTATUS(std::system(refused.c_str())), 2) << stderr_to;
  }
}

TEST(Output, ControlCharactersOfArgumentsAndFilesAreEscaped) {
  const Folder folder;
  const std::string bad = folder.write("a\x1b[31m\n.json", "{");
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"run", "\x1b[31m"},
                                                    {"run", bad},
                                                    {"run", "free_fall", "--engine", "\x1b[31m\x9b"},
                                                    {"\x1b[31m"},
                                                    {"run", "free_fall", "--\x1b[31m"},
                                                    {"report", bad}}) {
    const Ran ran = plumb(arguments);
    EXPECT_EQ(ran.code, 2);
    EXPECT_EQ(ran.err.find('\x1b'), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("\\x1b"), std::string::npos) << ran.err;
    EXPECT_EQ(lines_of(ran.err).size(), 1u) << ran.err;
  }
}

TEST(Output, AFileThatCannotBeReadIsNotTakenForAnEmptyOne) {
  const Folder folder;
  // A process's own memory is open to it, and begins with a page that is not there.
  const std::string command = std::string(PLUMB_PROGRAM) + " run - < /proc/self/mem 2>" + folder.path("err");
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);
  EXPECT_NE(folder.read("err").find("standard input: cannot be read"), std::string::npos)
      << folder.read("err");
  const std::string named = std::string(PLUMB_PROGRAM) + " run ./mem 2>" + folder.path("err");
  std::filesystem::create_symlink("/proc/self/mem", folder.path("mem"));
  EXPECT_EQ(WEXITSTATUS(std::system(("cd " + folder.path() + " && " + named).c_str())), 2);
  EXPECT_NE(folder.read("err").find("cannot be read"), std::string::npos) << folder.read("err");
}

TEST(Output, AReportThatCannotBeWrittenEndsWithCode2) {
  const Folder folder;
  std::filesystem::create_directories(folder.path("r/report.html"));
  const Ran ran =
      plumb({"compare", "free_fall/vacuum", "--engine", "plumb", "--no-cost", "--out", folder.path("r")});
  EXPECT_EQ(ran.code, 2) << ran.err;
  EXPECT_NE(ran.err.find("plumb: there is no report"), std::string::npos) << ran.err;
}

TEST(Output, AFileSizeLimitIsAnErrorLikeAFullMedium) {
  const Folder folder;
  const std::string command = "bash -c 'ulimit -f 1; " + std::string(PLUMB_PROGRAM) +
                              " compare free_fall --engine plumb --no-cost --out " + folder.path("r") +
                              " > /dev/null 2>" + folder.path("err") + "'";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);
  EXPECT_EQ(folder.read("err").rfind("plumb: ", 0), 0u) << folder.read("err");
}

}  // namespace
}  // namespace plumb::app
