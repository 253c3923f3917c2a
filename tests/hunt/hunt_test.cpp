#include "harness/hunt/hunt.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <set>

#include <unistd.h>

#include "engine/scene/error.h"
#include "harness/hunt/workers.h"
#include "harness/text_file.h"

namespace plumb::harness::hunt {
namespace {

/// A folder that goes with the test.
struct Folder {
  std::string path = std::filesystem::temp_directory_path() / ("plumb_hunt_" + std::to_string(getpid()));
  Folder() { std::filesystem::remove_all(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};

HuntOptions few(const std::string& folder, std::uint64_t scenes) {
  return {.engines = {Engine(reference::find_backend("plumb-float"))},
          .seconds = 0,
          .scenes = scenes,
          .jobs = 2,
          .folder = folder,
          .shrinks = 0};
}

TEST(Hunt, GoesOnWhereItStoppedAndRunsNothingTwice) {
  const Folder folder;
  EXPECT_EQ(hunt(few(folder.path, 6), {}).scenes, 6u);
  const std::string before = read_text(folder.path + "/hunt.jsonl");
  EXPECT_EQ(hunt(few(folder.path, 6), {}).scenes, 6u);
  EXPECT_EQ(read_text(folder.path + "/hunt.jsonl"), before);
  EXPECT_EQ(hunt(few(folder.path, 9), {}).scenes, 9u);
  const std::string after = read_text(folder.path + "/hunt.jsonl");
  EXPECT_EQ(after.substr(0, before.size()), before);
}

TEST(Hunt, AFolderWithAnotherHuntIsRefused) {
  const Folder folder;
  hunt(few(folder.path, 1), {});
  HuntOptions other = few(folder.path, 1);
  other.seed = 2;
  EXPECT_THROW(hunt(other, {}), Error);
}

TEST(Workers, AnswersDeathsAndHangsAreToldApart) {
  Workers workers(2, 0.2, [](std::uint64_t task) -> std::string {
    if (task == 1) raise(SIGKILL);
    while (task == 2) {
    }
    return "answer " + std::to_string(task);
  });
  std::set<std::uint64_t> done, died, hung;
  std::uint64_t next = 0;
  while (done.size() + died.size() + hung.size() < 6) {
    while (workers.idle() > 0 && next < 6) workers.start(next++);
    for (const Answer& answer : workers.wait()) {
      if (answer.kind == Answer::Kind::Done) {
        EXPECT_EQ(answer.text, "answer " + std::to_string(answer.task));
        done.insert(answer.task);
      } else {
        (answer.kind == Answer::Kind::Died ? died : hung).insert(answer.task);
      }
    }
  }
  EXPECT_EQ(done, (std::set<std::uint64_t>{0, 3, 4, 5}));
  EXPECT_EQ(died, std::set<std::uint64_t>{1});
  EXPECT_EQ(hung, std::set<std::uint64_t>{2});
}

}  // namespace
}  // namespace plumb::harness::hunt
