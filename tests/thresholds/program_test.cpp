#include <unistd.h>

#include <csignal>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

// Uses `plumb thresholds` as a user does.
namespace plumb::app {
namespace {

using Json = nlohmann::json;

TEST(ThresholdsProgram, FindsThemAndKeepsThem) {
  const Folder folder;
  const std::vector<std::string> command{
      "thresholds", "free_spin", "--engine", "plumb-float,mujoco,box2d", "--out", folder.path("extremes"),
      "--jobs",     "2"};
  const Ran ran = plumb(command);
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.out.find("free_spin"), std::string::npos) << ran.out;
  const auto lines = lines_of(folder.read("extremes/thresholds.jsonl"));
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(Json::parse(lines[0])["kind"], "environment");
  for (std::size_t i = 1; i < lines.size(); ++i) EXPECT_EQ(Json::parse(lines[i])["name"], "free_spin");

  const Ran again = plumb(command);
  EXPECT_EQ(again.out, ran.out);
  EXPECT_EQ(lines_of(folder.read("extremes/thresholds.jsonl")).size(), 4u) << "nothing is searched twice";
}

TEST(ThresholdsProgram, KilledInTheMiddleTheSameCommandGoesOn) {
  const Folder folder;
  const std::vector<std::string> command{
      "thresholds", "free_spin",         "free_speed", "stopped_bullet",   "overhang",
      "--engine",   "plumb-float,plumb", "--out",      folder.path("out"), "--jobs",
      "1",          "--format",          "json"};
  const pid_t process = start_plumb(command);
  for (int i = 0; i < 3000 && lines_of(folder.read("out/thresholds.jsonl")).size() < 3; ++i) usleep(10'000);
  kill(process, SIGKILL);
  EXPECT_EQ(wait_for(process), -SIGKILL);
  EXPECT_GE(lines_of(folder.read("out/thresholds.jsonl")).size(), 3u);
  const Ran ran = plumb(command);
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(lines_of(ran.out).size(), 8u);
  EXPECT_EQ(lines_of(folder.read("out/thresholds.jsonl")).size(), 9u) << "each once";
}

TEST(ThresholdsProgram, SaysWhatIsWrong) {
  const Ran unknown = plumb({"thresholds", "overhan"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("overhang"), std::string::npos) << unknown.err;
  EXPECT_EQ(plumb({"thresholds", "--digits", "9"}).code, 2);
  EXPECT_EQ(plumb({"thresholds", "--run-seconds", "-1"}).code, 2);
  const Folder folder;
  folder.write("thresholds.jsonl", R"({"kind":"environment","commit":"another"})"
                                   "\n");
  const Ran other = plumb({"thresholds", "overhang", "--out", folder.path()});
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("measured elsewhere"), std::string::npos) << other.err;
  const Ran listed = plumb({"thresholds", "--list"});
  EXPECT_EQ(listed.code, 0);
  EXPECT_NE(listed.out.find("arch_thickness"), std::string::npos);
}

}  // namespace
}  // namespace plumb::app
