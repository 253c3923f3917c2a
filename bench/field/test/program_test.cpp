#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <nlohmann/json.hpp>

#include "bench/field/engines.h"
#include "bench/field/heap.h"

namespace plumb::field {
namespace {

using testing::HasSubstr;

struct Ran {
  int code = 0;
  std::string out;
};

/// Runs the program with `arguments`; `errors` redirects stderr.
Ran run(const std::string& arguments, const std::string& errors = "2>&1") {
  Ran out;
  FILE* pipe = popen((std::string(PLUMB_FIELD_PROGRAM) + " " + arguments + " " + errors).c_str(), "r");
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    out.out.append(buffer.data(), n);
  out.code = WEXITSTATUS(pclose(pipe));
  return out;
}

TEST(Program, NamesWhatItDoesNotKnow) {
  const Ran scene = run("large_piramid"), engine = run("--engine bux2d"), option = run("--stepps 3");
  EXPECT_EQ(scene.code, 2);
  EXPECT_THAT(scene.out, HasSubstr("did you mean 'large_pyramid'?"));
  EXPECT_EQ(engine.code, 2);
  EXPECT_THAT(engine.out, HasSubstr("did you mean 'box2d'?"));
  EXPECT_EQ(option.code, 2);
  EXPECT_EQ(run("--steps 0").code, 2);
  EXPECT_EQ(run("--repeat none").code, 2);
  EXPECT_EQ(run("--format xml").code, 2);
}

TEST(Program, HelpHasExamplesAndListHasAll) {
  const Ran help = run("--help"), list = run("--list");
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("plumb_field large_pyramid tumbler"));
  EXPECT_EQ(list.code, 0);
  EXPECT_THAT(list.out, HasSubstr("joint_grid"));
  EXPECT_THAT(list.out, HasSubstr("chipmunk"));
}

TEST(Program, SolversStandBesideEachOther) {
  const Ran two =
      run("chain_10 --quick --repeat 1 --engine plumb --solver xpbd,direct --format csv", "2>/dev/null");
  EXPECT_EQ(two.code, 0);
  EXPECT_THAT(two.out, HasSubstr("chain_10,plumb:xpbd,"));
  EXPECT_THAT(two.out, HasSubstr("chain_10,plumb:direct,"));
  const Ran all =
      run("one_free_body --quick --repeat 1 --engine plumb --solver all --format json", "2>/dev/null");
  EXPECT_EQ(all.code, 0);
  for (const char* name : {"soft_steps", "sequential_impulses", "jakobsen", "xpbd", "direct"})
    EXPECT_THAT(all.out, HasSubstr("\"solver\": \"" + std::string(name)));
  const Ran unknown = run("empty --engine plumb --solver xpdb");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.out, HasSubstr("did you mean 'xpbd'?"));
}

TEST(Program, RunsPlumbWithNumbersOfThreadsBesideEachOther) {
  const Ran both =
      run("pyramid_10 --quick --repeat 1 --engine plumb --threads 1,2 --format json", "2>/dev/null");
  ASSERT_EQ(both.code, 0);
  EXPECT_THAT(both.out, HasSubstr("\"engine\": \"plumb:2\""));
  EXPECT_THAT(both.out, HasSubstr("\"threads\": \"1\""));
  EXPECT_THAT(both.out, HasSubstr("\"threads\": \"2\""));
  EXPECT_EQ(run("empty --engine plumb --threads 0").code, 2);
}

TEST(Program, ProfilesTheStagesOfAStep) {
  const Ran ran = run("pyramid_10 --quick --repeat 1 --engine plumb --profile --format json", "2>/dev/null");
  ASSERT_EQ(ran.code, 0);
  const auto result = nlohmann::json::parse(ran.out)["results"][0];
  double sum = 0;
  for (const auto& stage : result["stages_ns"]) sum += stage.get<double>();
  const double step = 1e9 * result["step_s"].get<double>();
  EXPECT_GT(sum, 0.3 * step);
  EXPECT_GT(result["stages_ns"]["solver"].get<double>(), 0);
}

TEST(Program, AnEngineThatIsMissingHasItsOwnCode) {
  for (const Engine& engine : engines()) {
    const Ran ran = run("empty --quick --repeat 1 --engine " + engine.name);
    EXPECT_EQ(ran.code, engine.missing.empty() ? 0 : 3) << ran.out;
  }
}

TEST(Program, StdoutThatIsFullIsAnError) { EXPECT_EQ(run("--list >/dev/full").code, 4); }

TEST(Program, JsonIsAllThatIsOnStdout) {
  const Ran ran = run("pyramid_10 chain_10 --quick --repeat 2 --format json", "2>/dev/null");
  ASSERT_EQ(ran.code, 0);
  const auto document = nlohmann::json::parse(ran.out);
  std::size_t present = 0;
  for (const Engine& engine : engines()) present += engine.missing.empty();
  ASSERT_EQ(document["results"].size(), 2 * present);
  for (const auto& result : document["results"]) {
    EXPECT_GT(result["step_s"].get<double>(), 0);
    EXPECT_EQ(result["repetitions_s"].size(), 2u);
    EXPECT_FALSE(result["settings"].empty());
    EXPECT_EQ(result["bytes_a_body"].get<double>() > 0, heap::counted());
  }
}

TEST(Program, CsvHasAsManyCellsAsItsHead) {
  const Ran ran = run("empty chain_10 --quick --repeat 1 --format csv", "2>/dev/null");
  ASSERT_EQ(ran.code, 0);
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  std::size_t start = 0;
  const auto head = commas(ran.out.substr(0, ran.out.find('\n')));
  for (std::size_t end = 0; (end = ran.out.find('\n', start)) != std::string::npos; start = end + 1)
    EXPECT_EQ(commas(ran.out.substr(start, end - start)), head);
}

TEST(Program, TablesHaveNoColourAndNoProgressInAPipe) {
  const Ran ran = run("empty --quick --repeat 1");
  EXPECT_EQ(ran.out.find('\x1b'), std::string::npos);
  EXPECT_THAT(ran.out, HasSubstr("ns"));
}

}  // namespace
}  // namespace plumb::field
