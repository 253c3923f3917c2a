// Case files as their users write them: docs/cases.md, run as it stands, and files with mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/program.h"

namespace plumb::app {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

std::string file_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A fenced block of the page, and the file that the text before it says to save it as.
struct Block {
  std::string language, text, name;
};

std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> blocks;
  std::vector<std::string> names;  // of files, in the text since the last block
  std::istringstream in(page);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("```")) {
      for (std::size_t at = 0; (at = line.find('`', at)) != std::string::npos;) {
        const std::size_t end = line.find('`', at + 1);
        if (end == std::string::npos) break;
        const std::string word = line.substr(at + 1, end - at - 1);
        const bool is_path = word.find(' ') == std::string::npos;
        if (is_path && (word.ends_with(".json") || word.ends_with(".csv"))) names.push_back(word);
        at = end + 1;
      }
      continue;
    }
    Block block{line.substr(3), "", ""};
    while (std::getline(in, line) && line != "```") block.text += line + "\n";
    if (block.language != "sh" && !names.empty()) {
      block.name = names.front();
      names.erase(names.begin());
    } else {
      names.clear();
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

// Files that the page has saved by now stand in commands by their own names.
std::vector<std::string> words_of(const std::string& command, const Folder& folder) {
  std::istringstream in(command);
  std::vector<std::string> words;
  for (std::string word; in >> word;) {
    const bool is_file = word == "." || word.ends_with(".json") || word.ends_with(".xml");
    words.push_back(is_file ? folder.path(word == "." ? "" : word) : word);
  }
  return words;
}

TEST(CaseFiles, TheWalkThroughOfThePageRuns) {
  const Folder folder, results;
  int commands = 0;
  for (const Block& block : blocks_of(file_of(PLUMB_SOURCE_DIR "/docs/cases.md"))) {
    if (!block.name.empty()) {
      // "save this as strict.json, with the scene in scene.json": the first block is the first name.
      folder.write(block.name, block.text);
    }
    if (block.language != "sh") continue;
    std::istringstream lines(block.text);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t comment = line.find("# exits with ");
      if (!line.starts_with("plumb ") || comment == std::string::npos) continue;
      std::vector<std::string> words = words_of(line.substr(6, comment - 6), folder);
      if (words.front() == "compare") words.insert(words.end(), {"--out", results.path("r")});
      const Ran ran = plumb(words);
      EXPECT_EQ(ran.code, std::stoi(line.substr(comment + 13))) << line << "\n" << ran.out << ran.err;
      ++commands;
    }
  }
  EXPECT_GE(commands, 8);
  EXPECT_THAT(folder.read("report.xml"), HasSubstr("<testcase classname=\"measured\" name=\"plumb\""));
}

/// A case of free fall from rest for a second, with `expect` and `more` members.
std::string fall(const std::string& expect, const std::string& more = "") {
  return R"({"plumb_case": 1, "source": "Galileo", "duration": 1, "expect": [)" + expect + "]" + more +
         R"(, "scene": {"gravity": [0, -10], "bodies": [{"name": "ball", "position": [0, 5],
            "shapes": [{"type": "circle", "radius": 0.1}]}]}})";
}

TEST(CaseFiles, AMissExitsWithOneAndSaysByHowMuch) {
  const Folder folder;
  // g is taken for 9: at the end the ball is half a metre below what is expected.
  const std::string file =
      folder.write("wrong.json", fall(R"({"of": "ball.y", "is": "5 - 9*t^2/2", "tolerance": 0.1})"));
  const Ran ran = plumb({"compare", file, "--engine", "plumb-precise", "--no-cost", "--out", folder.path("r"),
                         "--junit", folder.path("report.xml")});
  EXPECT_EQ(ran.code, 1) << ran.out << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("expected ball.y is 0.5, its bound is 0.1"));
  EXPECT_THAT(folder.read("report.xml"),
              HasSubstr("<failure message=\"expected ball.y is 0.5, its bound is 0.1\">"));
  EXPECT_THAT(folder.read("report.xml"), HasSubstr("tests=\"1\" failures=\"1\""));
  const Json json = Json::parse(lines_of(folder.read("r/results.jsonl")).front());
  EXPECT_NEAR(json["metrics"]["expected_miss"].get<double>(), 5, 1e-6);
}

TEST(CaseFiles, EveryKindOfExpectationCanPassAndCanMiss) {
  const char* const passes[] = {
      R"({"of": "ball.y", "is": "5 - 5*t^2", "tolerance": 1e-6})",
      R"({"of": "ball.y", "at_least": 0, "at_most": "ball.y0"})",
      R"({"of": "ball.vy", "is": -5, "at": 0.503, "tolerance": 0.0301})",
      R"({"of": "ball.y", "is": 5, "tolerance": 0.01, "until": 0.04})",
      R"({"law": "energy", "tolerance": 1e-6})",
      R"({"states": [{"t": 0.7, "body": "ball", "y": 2.55, "vy": -7}], "tolerance": 1e-6})",
      R"({"motion": "ball", "x": 0, "y": "5 - 5*t^2", "angle": 0, "vx": 0, "vy": "-10*t", "w": 0, "tolerance": 1e-6})",
  };
  const char* const misses[] = {
      R"({"of": "ball.y", "is": "5 - 5*t", "tolerance": 0.1})",
      R"({"of": "ball.y", "at_least": 0.1})",
      R"({"of": "ball.vy", "is": -5, "at": 0.503, "tolerance": 0.0299})",
      R"({"of": "ball.y", "is": 5, "tolerance": 0.01, "until": 0.06})",
      R"({"law": "momentum", "tolerance": 0.1})",
      R"({"states": [{"t": 0.7, "body": "ball", "y": 2.55, "vy": -7.1}], "tolerance": 1e-6})",
      R"({"motion": "ball", "vy": "-10*t + 0.001", "tolerance": {"velocity": 1e-6}})",
  };
  const Folder folder;
  const auto code = [&](const char* expect) {
    const std::string file = folder.write("case.json", fall(expect));
    return plumb({"check", "--engine", "plumb-precise", "--case", file}).code;
  };
  for (const char* expect : passes) EXPECT_EQ(code(expect), 0) << expect;
  for (const char* expect : misses) EXPECT_EQ(code(expect), 1) << expect;
}

TEST(CaseFiles, EnginesThatNeedNotPassFailNothing) {
  const Folder folder;
  const std::string file =
      folder.write("fine.json", fall(R"({"of": "ball.y", "is": "5 - 5*t^2", "tolerance": 1e-6})",
                                     R"(, "must_pass": ["plumb-precise"])"));
  const Ran ran = plumb({"compare", file, "--engine", "plumb-precise,box2d", "--no-cost", "--out",
                         folder.path("r"), "--junit", folder.path("report.xml")});
  EXPECT_EQ(ran.code, 0) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("the case does not require this engine to pass"));
  EXPECT_THAT(folder.read("report.xml"), HasSubstr("to pass\n</system-out>")) << "a line a miss";
}

// Nothing in the scene at the start tells how far it goes but the force.
TEST(CaseFiles, ABodyWithoutShapesThatAForceMovesFromRestHasNotDiverged) {
  const Folder folder;
  const std::string file =
      folder.write("push.json", R"({"plumb_case": 1, "source": "x = F/m t^2/2, Newton", "duration": 10,
        "expect": [{"of": "cart.x", "is": "4/cart.mass*t^2/2", "tolerance": 1e-6}],
        "scene": {"gravity": [0, 0], "bodies": [{"name": "cart", "mass": 2, "inertia": 1}],
          "forces": [{"type": "point_force", "body": "cart", "force": [4, 0]}]}})");
  const Ran ran =
      plumb({"compare", file, "--engine", "plumb-precise", "--no-cost", "--out", folder.path("r")});
  EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
}

TEST(Agreement, IsPrintedAtTheEndOfAComparisonAndFromItsResults) {
  const Folder folder;
  const Ran ran = plumb({"compare", "pendulum_chain[20]", "--engine", "plumb,plumb-precise,box2d",
                         "--no-cost", "--no-report", "--out", folder.path("r")});
  EXPECT_EQ(ran.code, 0) << ran.err;
  const Ran text = plumb({"agreement", folder.path("r")});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("agree with the truth: plumb, plumb-precise (2 of 3)"));
  EXPECT_THAT(text.out, HasSubstr("not: box2d velocity_error"));
  EXPECT_THAT(text.out, HasSubstr("Each of Box2D's 8 iterations"));
  EXPECT_THAT(ran.out, HasSubstr(text.out)) << "the same, derived anew";
  const Json json = Json::parse(plumb({"agreement", folder.path("r"), "--format", "json"}).out);
  EXPECT_EQ(json["agree"], Json({"plumb", "plumb-precise"}));
  EXPECT_GT(json["dissents"][0]["misses"][0]["times"].get<double>(), 1);
  const Ran without = plumb({"agreement", folder.path("r"), "--without", "box*"});
  EXPECT_THAT(without.out, HasSubstr("in 1 of 1: pendulum_chain[20] (2)"));
  EXPECT_EQ(plumb({"agreement", folder.path("nowhere")}).code, 2);
}

TEST(CaseFiles, BadFilesNameFileMemberAndValue) {
  struct Bad {
    std::string text, member, problem;
  };
  const std::string good = R"({"of": "ball.y", "is": "5 - 5*t^2", "tolerance": 1e-6})";
  const Bad files[] = {
      {fall(R"({"of": "bal.y", "is": 1, "tolerance": 1})"), "expect[0].of", "did you mean 'ball.y'"},
      {fall(R"({"of": "ball.y", "is": "5 - ", "tolerance": 1})"), "expect[0].is", "is not a formula"},
      {fall(R"({"of": "ball.y", "is": 1, "tolerance": 0})"), "expect[0].tolerance", "must be above 0"},
      {fall(R"({"of": "ball.y", "is": 1, "tolerance": -1})"), "expect[0].tolerance", "must be above 0"},
      {fall(R"({"of": "ball.y", "is": 1})"), "expect[0].tolerance", "is missing"},
      {fall(R"({"of": "ball.y", "tolerance": 1})"), "expect[0]", "must have either 'is', or 'at_least'"},
      {fall(R"({"of": "ball.y", "is": 1, "tolerance": 1, "at": 2})"), "expect[0].at",
       "from 0 to the duration"},
      {fall(R"({"law": "enrgy", "tolerance": 1})"), "expect[0].law", "did you mean 'energy'"},
      {fall(R"({"states": "nowhere.csv", "tolerance": 1})"), "expect[0].states", "nowhere.csv"},
      {fall(R"({"states": [{"t": 0, "body": "cube", "x": 0}], "tolerance": 1})"), "expect[0].states",
       "no body"},
      {fall(R"({"motion": "ball", "tolerance": 1})"), "expect[0]", "must have one of the members"},
      {fall(good, R"(, "expext": 1)"), "expext", "did you mean 'expect'"},
      {fall(good, R"(, "parameters": {"a": "t"})"), "parameters.a", "must not depend on t"},
      {fall(""), "expect", "without expectations cannot fail"},
      {R"({"plumb_case": 2, "source": "", "scene": {}, "duration": 1, "expect": []})", "plumb_case",
       "must be 1"},
      {R"({"plumb_case": 1, "source": "", "scene": {"bodies": 3}, "duration": 1, "expect": []})", "scene",
       "list"},
      {R"({"plumb_case": 1,)", "", "is not JSON"},
  };
  const Folder folder;
  for (const Bad& bad : files) {
    const std::string file = folder.write("bad.json", bad.text);
    const Ran ran = plumb({"compare", file, "--engine", "plumb", "--out", folder.path("r")});
    expect_refused(ran, bad.text);
    EXPECT_THAT(ran.err, HasSubstr("bad.json"));
    EXPECT_THAT(ran.err, HasSubstr(bad.member));
    EXPECT_THAT(ran.err, HasSubstr(bad.problem)) << bad.text;
  }
}

TEST(CaseFiles, AScenariosNameIsTaken) {
  const Folder folder;
  const std::string file = folder.write("bounce.json", fall(R"({"law": "energy", "tolerance": 1})"));
  expect_refused(plumb({"compare", file, "--out", folder.path("r")}), "the name of a scenario");
}

TEST(CaseFiles, RunSweepAndReportTakeThem) {
  const Folder folder;
  const std::string file =
      folder.write("drop.json", fall(R"({"of": "ball.y", "is": "5 - 5*t^2", "tolerance": 0.2})"));
  EXPECT_EQ(lines_of(plumb({"run", file, "--rate", "2"}).out).size(), 4u);
  const Ran swept = plumb({"sweep", file, "--engine", "box2d", "--budget", "20", "--out", folder.path("s")});
  EXPECT_EQ(swept.code, 0) << swept.err;
  EXPECT_EQ(plumb({"report", folder.path("s"), "--out", folder.path("page.html")}).code, 0);
  EXPECT_THAT(folder.read("page.html"), HasSubstr("expected_miss"));
}

TEST(Museum, EnginesThatACaseAsksForMeetIt) {
  const Folder folder;
  const std::string museum = PLUMB_SOURCE_DIR "/museum";
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(museum)) {
    if (entry.path().extension() != ".json") continue;
    ++count;
    EXPECT_LE(lines_of(file_of(entry.path())).size(), 40u) << entry.path();
    EXPECT_THAT(Json::parse(file_of(entry.path()))["source"].get<std::string>(), HasSubstr("/issues/"))
        << entry.path();
  }
  EXPECT_GE(count, 20u);
  const Ran ran =
      plumb({"compare", museum, "--engine", "plumb,plumb-precise", "--no-cost", "--out", folder.path("r")});
  EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
}

TEST(Verdict, ListsWhatMissesFirstAndWritesItsFiles) {
  const Folder folder;
  const std::string wrong =
      folder.write("wrong.json", fall(R"({"of": "ball.y", "is": 5, "tolerance": 0.1})"));
  const Ran ran =
      plumb({"verdict", "--engine", "plumb-precise", "--case", "free_fall/vacuum", "--case", wrong, "--badge",
             folder.path("badge.svg"), "--json", folder.path("v.json"), "--junit", folder.path("v.xml")});
  EXPECT_EQ(ran.code, 1) << ran.out << ran.err;
  EXPECT_LT(ran.out.find("misses"), ran.out.find("agrees"));
  EXPECT_THAT(ran.out, HasSubstr("1 of 2 cases agree"));
  EXPECT_THAT(folder.read("badge.svg"), HasSubstr("1 of 2 agree"));
  EXPECT_EQ(Json::parse(folder.read("v.json"))["misses"], 1);
  EXPECT_THAT(folder.read("v.xml"), HasSubstr("failures=\"1\""));
}

TEST(Verdict, JudgesAProgramOnTheCatalogue) {
  const std::string starter = PLUMB_SOURCE_DIR "/docs/course/starters/ball.py";
  const Ran ran = plumb({"verdict", "--case", "bounce", "--case", "pendulum/60", "--", "python3", starter});
  EXPECT_THAT(ran.out, HasSubstr("unsupported"));
  EXPECT_THAT(ran.out, HasSubstr("bounce/e_0"));
}

// Engines from npm run where they are installed: `plumb engines --install NAME`.
class NpmEngine : public testing::TestWithParam<const char*> {};

TEST_P(NpmEngine, FallsAndBouncesAsItsLimitsSay) {
  const Json engines = Json::parse(plumb({"engines", "--format", "json"}).out);
  const auto engine = std::find_if(engines.begin(), engines.end(),
                                   [](const Json& each) { return each["name"] == GetParam(); });
  ASSERT_NE(engine, engines.end());
  if (!(*engine)["installed"].get<bool>()) GTEST_SKIP() << (*engine)["reason"];
  EXPECT_TRUE((*engine)["foreign_cost"].get<bool>());
  EXPECT_FALSE((*engine)["limits"].get<std::string>().empty());
  const Folder folder;
  const Ran ran = plumb({"compare", "free_fall/vacuum", "bounce/e_0", "--engine",
                         std::string(GetParam()) + "," + GetParam() + "-default", "--no-cost", "--out",
                         folder.path("r")});
  EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
  for (const std::string& line : lines_of(folder.read("r/results.jsonl"))) {
    const Json result = Json::parse(line);
    EXPECT_EQ(result["status"], "ok") << line;
    if (std::string(result["engine"]).ends_with("-default")) continue;
    EXPECT_LT(result["metrics"]["position_error"].get<double>(), 1.0) << line;
  }
}

std::string name_of_engine(const testing::TestParamInfo<const char*>& engine) { return engine.param; }

INSTANTIATE_TEST_SUITE_P(All, NpmEngine, testing::Values("box2d3", "matter", "p2", "planck", "rapier"),
                         name_of_engine);

TEST(Engines, AVersionThatIsNotInstalledSaysHow) {
  const Folder folder;
  const Ran ran = plumb(
      {"compare", "free_fall/vacuum", "--engine", "rapier@0.0.1", "--no-cost", "--out", folder.path("r")},
      {"PLUMB_ENGINES=" + folder.path("none")});
  EXPECT_THAT(ran.out, HasSubstr("--install rapier@0.0.1"));
  expect_refused(plumb({"engines", "--install", "rapir"}), "an engine that npm has not");
  expect_refused(plumb({"engines", "--install", "rapier@../x"}), "a version that is none");
  expect_refused(plumb({"bisect", "bounce/e_1", "plumb"}), "an engine that is not from npm");
}

}  // namespace
}  // namespace plumb::app
