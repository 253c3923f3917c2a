// `plumb check` as its users have it: over the real protocol, with engines that pass, err, hang and crash.
#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "harness/course/course.h"
#include "tests/app/program.h"

namespace plumb::course {
namespace {

using app::plumb;
using app::Ran;
using testing::HasSubstr;
using Json = nlohmann::json;

Json examined(std::vector<std::string> command, std::vector<std::string> options = {}) {
  std::vector<std::string> arguments{"check", "--format", "json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  arguments.push_back("--");
  arguments.insert(arguments.end(), command.begin(), command.end());
  const Ran ran = plumb(arguments);
  EXPECT_TRUE(ran.code == 0 || ran.code == 1) << ran.err;
  Json out = Json::parse(ran.out);
  EXPECT_EQ(ran.code == 0, out["passed"] == out["checks"]);
  return out;
}

std::string mistake_in(const Json& report, const std::string& check) {
  for (const Json& result : report["results"])
    if (result["check"] == check) return result["mistake"];
  return "no such check";
}

int count(const Json& report, const std::string& verdict, int chapter) {
  int out = 0;
  for (const Json& result : report["results"])
    out += result["verdict"] == verdict && result["chapter"] == chapter;
  return out;
}

TEST(Check, APlainEnginePassesAllOverTheProtocol) {
  const Json report = examined({PLUMB_STUDENT});
  EXPECT_EQ(report["passed"], report["checks"]) << report.dump(1);
  EXPECT_GE(report["checks"], 5 * 5);
}

TEST(Check, MistakesAreRecognisedOverTheProtocol) {
  const auto one = [](const char* mistake, const char* chapter) {
    return examined({PLUMB_STUDENT, mistake}, {"--chapter", chapter});
  };
  EXPECT_EQ(mistake_in(one("explicit_euler", "2"), "spring"), "explicit_euler");
  EXPECT_EQ(mistake_in(one("last_force_only", "2"), "forces_add"), "last_force_only");
  EXPECT_EQ(mistake_in(one("masses_swapped", "3"), "heavy_hits_light"), "masses_swapped");
  EXPECT_EQ(mistake_in(one("inertia_sixth", "4"), "torque_spins"), "inertia_sixth");
  EXPECT_EQ(mistake_in(one("r_cross_n_flipped", "4"), "ball_hits_rod"), "r_cross_n_flipped");
  EXPECT_EQ(mistake_in(one("stick_masses_ignored", "5"), "stick_weighs_masses"), "masses_ignored");
}

TEST(Check, EnginesThatAreBuiltInPass) {
  for (const char* engine : {"plumb", "plumb-float", "plumb-precise"}) {
    const Ran ran = plumb({"check", "--engine", engine});
    EXPECT_EQ(ran.code, 0) << engine << "\n" << ran.out << ran.err;
    EXPECT_THAT(ran.out, HasSubstr("48 of 48 checks pass"));
  }
}

TEST(Check, ADiagnosisIsPrintedWithItsFigures) {
  const Ran ran = plumb({"check", "--chapter", "2", "--", PLUMB_STUDENT, "explicit_euler"});
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.out, HasSubstr("FAIL    spring"));
  EXPECT_THAT(ran.out, HasSubstr("growth of energy a step: 1.0025, expected 1 within"));
  EXPECT_THAT(ran.out,
              HasSubstr("Your energy grows by 1 + w^2 h^2 = 1.002500 a step: that is explicit Euler."));
  EXPECT_THAT(ran.out, HasSubstr("7 of 8 checks pass"));
}

// Starters: chapter 1 is done, of the rest they say that it is not yet.
void expect_starter(const std::vector<std::string>& command) {
  const Json report = examined(command);
  EXPECT_EQ(report["passed"], 8) << report.dump(1);
  EXPECT_EQ(count(report, "pass", 1), 8);
  EXPECT_EQ(count(report, "not_yet", 2) + count(report, "not_yet", 3), 18);
  EXPECT_EQ(count(report, "not_yet", 4) + count(report, "not_yet", 5), 22);
  for (const Json& result : report["results"])
    if (result["verdict"] == "not_yet") {
      EXPECT_THAT(result["says"].get<std::string>(),
                  AnyOf(HasSubstr("This check needs"), HasSubstr("and refuses a scene")));
    }
}

TEST(Starters, Python) { expect_starter({"python3", PLUMB_STARTERS "/ball.py"}); }
TEST(Starters, Cpp) { expect_starter({PLUMB_STARTER_CPP}); }
#ifdef PLUMB_NODE
TEST(Starters, JavaScript) { expect_starter({PLUMB_NODE, PLUMB_STARTERS "/ball.js"}); }
#endif

TEST(Starters, EachSolvedChapterPassesItsChecks) {
  for (const course::Chapter& chapter : course::chapters()) {
    const std::string file = fmt::format("{}/python/solved/chapter{}.py", PLUMB_STARTERS, chapter.number);
    const Json report = examined({"python3", "-B", file}, {"--chapter", std::to_string(chapter.number)});
    EXPECT_EQ(report["passed"], chapter.checks.size()) << file << report.dump(1);
  }
}

// Both ways of holding a joint that chapter 5 teaches pass its checks. Positions lose more spin, by a known
// law; what loses more than that is no method.
TEST(Starters, JointsHeldByPositionsPassChapterFive) {
  const std::string file = fmt::format("{}/tests/course/joints_by_positions.py", PLUMB_SOURCE_DIR);
  for (const char* dt : {"1/30", "1/60", "1/120"}) {
    const Json report = examined({"python3", "-B", file}, {"--chapter", "5", "--dt", dt});
    EXPECT_EQ(report["passed"], report["checks"]) << report.dump(1);
  }
  const Json report = examined({"python3", "-B", file, "--spin-lost"}, {"--chapter", "5"});
  EXPECT_EQ(mistake_in(report, "stick_keeps_its_length"), "");  // said, without a cause
  EXPECT_NE(report.dump().find("The stick loses its spin"), std::string::npos) << report.dump(1);
  EXPECT_EQ(count(report, "fail", 5), 5) << report.dump(1);
}

// The part of a scene that docs/protocol.md says is enough for chapters 1 to 3.
TEST(Starters, AnEngineWrittenFromTheProtocolPassesThreeChapters) {
  const Json report = examined({"python3", PLUMB_CIRCLES});
  for (const int chapter : {1, 2, 3}) {
    EXPECT_EQ(count(report, "fail", chapter) + count(report, "broken", chapter), 0) << report.dump(1);
    EXPECT_EQ(count(report, "not_yet", chapter), 0) << report.dump(1);
  }
}

TEST(Check, AnEngineThatHangsHasAResultInTime) {
  const app::Folder folder;
  const std::string engine =
      folder.write("hangs.py",
                   "import sys, time\n"
                   "print('{\"protocol\":1,\"name\":\"x\",\"version\":\"1\",\"precision\":\"double\",'\n"
                   "  '\"method\":{\"scheme\":\"semi_implicit_euler\",\"order\":1,\"epsilon\":1e-16},'\n"
                   "  '\"shapes\":[\"circle\"]}', flush=True)\n"
                   "time.sleep(100)\n");
  const auto start = std::chrono::steady_clock::now();
  const Ran ran = plumb({"check", "--timeout", "2", "--", "python3", engine});
  EXPECT_EQ(ran.code, 1) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("BROKEN  falls"));
  EXPECT_THAT(ran.out, HasSubstr("not tried: the engine has hung 3 times"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST(Check, AnEngineThatCrashesHasAResult) {
  const app::Folder folder;
  const std::string engine =
      folder.write("crashes.py",
                   "import sys\n"
                   "sys.stdin.readline()\n"
                   "print('{\"protocol\":1,\"name\":\"x\",\"version\":\"1\",\"precision\":\"double\",'\n"
                   "  '\"method\":{\"scheme\":\"semi_implicit_euler\",\"order\":1,\"epsilon\":1e-16},'\n"
                   "  '\"shapes\":[\"circle\"]}', flush=True)\n"
                   "sys.stdin.readline()\n"
                   "raise SystemExit('no idea what to do')\n");
  const Ran ran = plumb({"check", "--chapter", "1", "--", "python3", engine});
  EXPECT_EQ(ran.code, 1) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("BROKEN  falls"));
  EXPECT_THAT(ran.out, HasSubstr("no idea what to do"));
  EXPECT_THAT(ran.out, HasSubstr("0 of 8 checks pass"));
}

TEST(Check, ReportsUseTheEnginesOwnName) {
  EXPECT_EQ(examined({"python3", "-B", PLUMB_STARTERS "/ball.py"}, {"--chapter", "1"})["engine"], "ball");
}

TEST(Check, WhatFollowsAMistakeSaysSo) {
  const Ran ran = plumb({"check", "--chapter", "1", "--", PLUMB_STUDENT, "gravity_twice"});
  EXPECT_THAT(ran.out, HasSubstr("This may follow from gravity_twice above"));
}

TEST(Run, TakesAnEngineOfOnesOwn) {
  const Ran ran = plumb({"run", "bounce/e_1", "--engine-command",
                         "mine=python3 -B " PLUMB_STARTERS "/ball.py", "--duration", "1", "--rate", "2"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(app::lines_of(ran.out).size(), 1u + 2u * 3u)
      << ran.out;  // a heading, and two bodies at three times
}

TEST(Check, MisuseIsToldApart) {
  EXPECT_EQ(plumb({"check"}).code, 2);
  EXPECT_EQ(plumb({"check", "--engine", "plumb", "--", "python3"}).code, 2);
  EXPECT_EQ(plumb({"check", "--engine", "plumbum"}).code, 2);
  EXPECT_EQ(plumb({"check", "--chapter", "6", "--engine", "plumb"}).code, 2);
  EXPECT_EQ(plumb({"check", "--dt", "1", "--engine", "plumb"}).code, 2);
  EXPECT_EQ(plumb({"check", "--", "/no/such/engine"}).code, 2);
}

}  // namespace
}  // namespace plumb::course
