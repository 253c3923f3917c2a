#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "demos/core/registry.h"

namespace plumb::demos {
namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream in(path);
  EXPECT_TRUE(in) << path;
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

const std::filesystem::path kDocs = PLUMB_DOCS;

// The page's example is a demo of these tests.
TEST(Docs, TheExampleIsTheOneThatRuns) {
  const std::string source = content(kDocs / ".." / "tests" / "demos" / "drop_demo.cpp");
  EXPECT_THAT(content(kDocs / "demos.md"), testing::HasSubstr("```cpp\n" + source + "```\n"));
  EXPECT_EQ(make("drop")->about().name, "drop");
}

TEST(Docs, EveryDemoAndItsKeysAreListed) {
  const std::string page = content(kDocs / "demos.md");
  for (const Entry& entry : all()) {
    if (entry.about.name == "drop") continue;
    EXPECT_THAT(page, testing::HasSubstr("| `" + entry.about.name + "` |"));
    for (const Key& key : entry.about.keys) {
      if (key.key == ' ') continue;
      EXPECT_THAT(page, testing::HasSubstr(std::string("`") + key.key + "`"));
    }
  }
}

// Every milestone that the page names is a test here or in tests/window.
TEST(Docs, MilestonesAreTests) {
  const std::string page = content(kDocs / "demos.md");
  std::string tests;
  for (const char* folder : {"demos", "window"})
    for (const auto& entry : std::filesystem::directory_iterator(kDocs / ".." / "tests" / folder))
      tests += content(entry.path());
  std::istringstream lines(page.substr(page.find("## Milestones")));
  int found = 0;
  for (std::string line; std::getline(lines, line);) {
    for (std::size_t at = 0; (at = line.find('`', at)) != std::string::npos; ++at) {
      const std::size_t end = line.find('`', at + 1);
      const std::string quoted = line.substr(at + 1, end - at - 1),
                        name = quoted.substr(quoted.find('.') + 1);
      at = end;
      if (quoted.find('.') == std::string::npos) continue;
      EXPECT_THAT(tests, testing::HasSubstr(", " + name + ")")) << quoted;
      ++found;
    }
  }
  EXPECT_GT(found, 25);
}

}  // namespace
}  // namespace plumb::demos
