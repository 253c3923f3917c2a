#include <csignal>
#include <string>

#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

// Uses stress as a user does.
namespace plumb::app {
namespace {

using Json = nlohmann::json;

const std::vector<std::string> kSmall{"stress",  "dt_fall",  "mass_ratio_stack",
                                      "--quick", "--engine", "plumb-float"};

std::vector<std::string> with(std::vector<std::string> command, const std::vector<std::string>& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

TEST(Stress, PrintsMapsAndCounts) {
  const Folder folder;
  const Ran ran = plumb(with(kSmall, {"--out", folder.path("s")}));
  EXPECT_EQ(ran.code, 0) << ran.err;
  for (const char* part : {"dt_fall", "mass_ratio_stack", "mass ratio", "right is:", "plumb-float careful",
                           "cells survived", "plumb-float in any setting", "stress.jsonl"})
    EXPECT_NE(ran.out.find(part), std::string::npos) << part << "\n" << ran.out;
  EXPECT_EQ(ran.out.find('\x1b'), std::string::npos) << "no colour where it is not a terminal";
  // Again: nothing is run, the same is printed.
  const std::string file = folder.read("s/stress.jsonl");
  const Ran again = plumb(with(kSmall, {"--out", folder.path("s"), "--format", "json"}));
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(folder.read("s/stress.jsonl"), file);
  const Json cells = Json::parse(again.out);
  EXPECT_EQ(cells.size() + 1, lines_of(file).size());
  const Ran csv = plumb(with(kSmall, {"--out", folder.path("s"), "--format", "csv"}));
  EXPECT_EQ(lines_of(csv.out).size(), cells.size() + 1);
}

TEST(Stress, KilledInTheMiddleTheSameCommandGoesOn) {
  const Folder folder;
  const std::vector<std::string> command = with(kSmall, {"--out", folder.path("s"), "--jobs", "1"});
  const pid_t process = start_plumb(command);
  for (int i = 0; i < 1500 && lines_of(folder.read("s/stress.jsonl")).size() < 3; ++i) usleep(4'000);
  kill(process, SIGKILL);
  EXPECT_EQ(wait_for(process), -SIGKILL);
  const std::string before = folder.read("s/stress.jsonl");
  EXPECT_GE(lines_of(before).size(), 3u);
  EXPECT_EQ(plumb(command).code, 0);
  const std::string after = folder.read("s/stress.jsonl");
  EXPECT_GT(after.size(), before.size());
  EXPECT_EQ(after.substr(0, before.rfind('\n') + 1), before.substr(0, before.rfind('\n') + 1));
}

TEST(Stress, UsageIsExplained) {
  const Ran list = plumb({"stress", "--list"});
  EXPECT_EQ(list.code, 0);
  for (const char* part : {"stack_height", "mass ratio", "1e9"})
    EXPECT_NE(list.out.find(part), std::string::npos) << part;
  const Ran unknown = plumb({"stress", "stack_hight"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("did you mean 'stack_height'"), std::string::npos) << unknown.err;
  EXPECT_EQ(plumb({"stress", "--cell-seconds", "-1"}).code, 2);
  EXPECT_EQ(plumb({"stress", "--cell-memory", "much"}).code, 2);
  EXPECT_NE(plumb({"stress", "--help"}).out.find("Examples"), std::string::npos);
}

}  // namespace
}  // namespace plumb::app
