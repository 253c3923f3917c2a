#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

// Uses hunt as a user does.
namespace plumb::app {
namespace {

using Json = nlohmann::json;

TEST(Hunt, FindsWritesAndReplays) {
  const Folder folder;
  const std::vector<std::string> command{"hunt",        "flight", "--scenes",       "5",        "--engine",
                                         "plumb-float", "--out",  folder.path("h"), "--format", "json"};
  const Ran ran = plumb(command);
  EXPECT_TRUE(ran.code == 0 || ran.code == 1) << ran.err;
  const Json kinds = Json::parse(ran.out);
  EXPECT_EQ(kinds.empty(), ran.code == 0);
  const std::string log = folder.read("h/hunt.jsonl");
  EXPECT_GE(lines_of(log).size(), 6u);
  EXPECT_EQ(plumb(command).out, ran.out);
  EXPECT_EQ(folder.read("h/hunt.jsonl"), log) << "nothing is run twice";
  for (const Json& kind : kinds) {
    const std::string file = folder.path("h/" + kind.at("file").get<std::string>());
    EXPECT_EQ(plumb({"hunt", "--replay", file}).code, 1) << file;
  }
}

TEST(Hunt, ASceneIsPrintedAndReplayed) {
  const Ran drawn = plumb({"hunt", "--draw", "3", "--seed", "9"});
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_EQ(Json::parse(drawn.out).at("index"), 3);
  EXPECT_EQ(plumb({"hunt", "--draw", "3", "--seed", "9"}).out, drawn.out);
}

TEST(Hunt, UsageIsExplained) {
  const Ran list = plumb({"hunt", "--list"});
  EXPECT_EQ(list.code, 0);
  for (const char* part : {"star", "tiles", "sensor", "disturbances"})
    EXPECT_NE(list.out.find(part), std::string::npos) << part;
  expect_refused(plumb({"hunt", "stra"}), "an unknown family");
  expect_refused(plumb({"hunt", "tiles"}), "a support");
  expect_refused(plumb({"hunt", "--replay", "/nowhere/x.json"}), "no file");
}

}  // namespace
}  // namespace plumb::app
