#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace plumb::app {
namespace {

TEST(Reality, WithoutMeasurementsSaysWhereToGetThem) {
  const Folder folder;
  const Ran ran = plumb({"reality", "--data", folder.path()});
  EXPECT_EQ(ran.code, 4);
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(lines_of(ran.err).size(), 1u);
  for (const char* part : {"ellipse_impacts.csv", "docs/reality.md", "--data"})
    EXPECT_NE(ran.err.find(part), std::string::npos) << part << "\n" << ran.err;
}

TEST(Reality, BadMeasurementsAreRefusedWithTheLine) {
  const Folder folder;
  folder.write("ellipse_impacts.csv", "x,vx,vy,w,vx1,vy1,w1,lever_normal,lever_tangent,flagged\n1,2,three\n");
  folder.write("square_drops.csv", "drop,x,y,angle\n1,2,3,4\n");
  const Ran ran = plumb({"reality", "--data", folder.path(), "--engine", "plumb"});
  expect_refused(ran, "reality");
  EXPECT_NE(ran.err.find("line 2"), std::string::npos) << ran.err;
}

TEST(Reality, PageHasBothErrorsOfEveryEngine) {
  const char* data = std::getenv("PLUMB_REALITY_DATA");
  if (data == nullptr)
    GTEST_SKIP() << "set PLUMB_REALITY_DATA to the folder of the measurements, see docs/reality.md";
  const Folder folder;
  const Ran ran = plumb(
      {"reality", "--data", data, "--engine", "plumb,bullet", "--format", "json", "--out", folder.path("r")});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const nlohmann::json found = nlohmann::json::parse(ran.out);
  EXPECT_EQ(found["ellipse"]["laws"].size(), 9u);
  EXPECT_EQ(found["square"]["engines"].size(), 4u) << "two engines at two rates";
  const std::string page = folder.read("r/reality.html");
  for (const char* part :
       {"One impact of an ellipse", "bullet 250 Hz", "plumb 1000 Hz", "numerical", "of the law", "<svg"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org")) << "the page loads nothing";
  EXPECT_NE(folder.read("r/ellipse.svg").find("newton"), std::string::npos);
}

}  // namespace
}  // namespace plumb::app
