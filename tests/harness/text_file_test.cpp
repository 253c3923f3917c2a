#include "harness/text_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/scene/error.h"

namespace plumb::harness {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

class TextFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "plumb-text-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  fs::path folder_;
};

TEST_F(TextFile, IsReplacedAsAWhole) {
  write_whole(path("a"), "first");
  write_whole(path("a"), "second");
  EXPECT_EQ(read_text(path("a")), "second");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "nothing else is left";
}

TEST_F(TextFile, LinksStayLinks) {
  write_whole(path("a"), "first");
  fs::create_symlink("a", path("link"));
  write_whole(path("link"), "second");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_text(path("a")), "second");
}

// A pipe or a device is written to: a file in its place would take it away from everybody.
TEST_F(TextFile, PipesStayPipes) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = open(path("pipe").c_str(), O_RDWR | O_NONBLOCK);
  write_whole(path("pipe"), "text");
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  char buffer[16];
  EXPECT_EQ(read(reader, buffer, sizeof buffer), 4);
  close(reader);
}

TEST_F(TextFile, WhatCannotBeReadOrWrittenIsNamed) {
  EXPECT_THAT([&] { read_text(path("none")); }, ThrowsMessage<Error>(HasSubstr("No such file")));
  EXPECT_THAT([&] { read_text(path(""), "give another"); }, ThrowsMessage<Error>(HasSubstr("give another")));
  EXPECT_THAT([&] { write_whole(path(""), "x"); }, ThrowsMessage<Error>(HasSubstr("cannot be written")));
  EXPECT_THAT([&] { write_whole(path("no/folder"), "x"); }, ThrowsMessage<Error>(HasSubstr("no/folder")));
}

}  // namespace
}  // namespace plumb::harness
