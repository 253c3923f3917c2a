// Commands that take long, interrupted: they end at once, and what was finished is kept.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include "tests/app/program.h"

namespace plumb::app {
namespace {

struct Long {
  std::vector<std::string> command;
  std::string file;  // that it keeps what is finished in; empty: it keeps nothing
};

TEST(Interrupt, EndsEveryLongCommandAtOnce) {
  const Long all[] = {{{"compare", "--engine", "plumb"}, "results.jsonl"},
                      {{"sweep", "--engine", "plumb"}, "sweep.jsonl"},
                      {{"stress", "--engine", "plumb-float"}, "stress.jsonl"},
                      {{"thresholds", "--engine", "plumb-precise"}, "thresholds.jsonl"},
                      {{"tune", "pendulum_chain", "--tolerance", "1e-9"}, ""}};
  for (const Long& each : all) {
    for (const int signal : {SIGINT, SIGTERM}) {
      const Folder folder;
      std::vector<std::string> command = each.command;
      if (!each.file.empty()) command.insert(command.end(), {"--out", folder.path("out")});
      const pid_t process = start_plumb(command);
      for (int i = 0; i < 2000 && !each.file.empty() && folder.read("out/" + each.file).empty(); ++i)
        usleep(5'000);
      usleep(500'000);  // into its work
      kill(process, signal);
      EXPECT_EQ(wait_for(process), 130) << command.front() << " and signal " << signal;
      const std::string kept = folder.read("out/" + each.file);
      EXPECT_TRUE(each.file.empty() || (!kept.empty() && kept.back() == '\n')) << command.front();
    }
  }
}

// One scenario on one engine, which is done at once.
std::vector<std::string> compare_into(const std::string& folder) {
  return {"compare", "free_fall/vacuum", "--engine", "plumb", "--no-cost", "--out", folder};
}

// A writer that was killed, or a disk that was full, leaves half a line: the next one begins a line of its
// own.
TEST(Interrupt, HalfALineOfResultsIsDropped) {
  const Folder folder;
  const std::vector<std::string> command = compare_into(folder.path("out"));
  ASSERT_EQ(plumb(command).code, 0);
  const std::string whole = folder.read("out/results.jsonl");
  std::ofstream(folder.path("out/results.jsonl"), std::ios::app) << whole.substr(0, whole.size() / 2);
  ASSERT_EQ(plumb(command).code, 0);
  const std::vector<std::string> lines = lines_of(folder.read("out/results.jsonl"));
  EXPECT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines.front() + "\n", whole);
  EXPECT_EQ(plumb({"compare", folder.path("out"), folder.path("out")}).code, 0);
}

// Some editors leave out the last line's end; nothing of what was there is lost.
TEST(Interrupt, AWholeLastLineWithoutItsEndStays) {
  const Folder folder;
  const std::vector<std::string> command = compare_into(folder.path("out"));
  ASSERT_EQ(plumb(command).code, 0);
  const std::string whole = folder.read("out/results.jsonl");
  for (const std::string& text : {whole.substr(0, whole.size() - 1), std::string("my notes")}) {
    folder.write("out/results.jsonl", text);
    // Of notes no report can be made, which is said.
    ASSERT_EQ(plumb(command).code, text == "my notes" ? 2 : 0);
    const std::vector<std::string> lines = lines_of(folder.read("out/results.jsonl"));
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0], text);
    EXPECT_EQ(lines[1].front(), '{');
  }
}

}  // namespace
}  // namespace plumb::app
