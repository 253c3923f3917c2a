#include "demos/window/script.h"

#include <gtest/gtest.h>

#include "demos/core/registry.h"
#include "engine/scene/error.h"

namespace plumb::window {
namespace {

TEST(Script, IsReadLineByLine) {
  const std::vector<Deed> deeds = parse_script(
      "# a comment\n\n0 press 1 -2.5\n 0.25  set gravity = 3\r\n0.25 wheel 0 1 -2\n1 picture a b.png", "s");
  ASSERT_EQ(deeds.size(), 4u);
  EXPECT_EQ(deeds[0].kind, Deed::Kind::Press);
  EXPECT_EQ(deeds[0].point.x, 1);
  EXPECT_EQ(deeds[0].point.y, -2.5);
  EXPECT_EQ(deeds[1].time, 0.25);
  EXPECT_EQ(deeds[1].text, "gravity = 3");
  EXPECT_EQ(deeds[2].turns, -2);
  EXPECT_EQ(deeds[3].text, "a b.png");
}

TEST(Script, NamesTheLineThatIsWrong) {
  struct Case {
    const char *text, *says;
    int line;
  };
  for (const Case& each : {Case{"0 press 1 2\n1 pres 1 2", "'press'", 2}, Case{"x press 1 2", "time in s", 1},
                           Case{"-1 key p", "negative", 1}, Case{"\n\n1 press 1", "y in m", 3},
                           Case{"1 press 1 2 3", "'3' is too much", 1}, Case{"1 key", "lacks", 1},
                           Case{"1 key p\n0.5 key p", "earlier", 2}, Case{"1 press nan 2", "x in m", 1}}) {
    try {
      parse_script(each.text, "file");
      ADD_FAILURE() << each.text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Syntax);
      EXPECT_EQ(error.line(), each.line) << each.text;
      EXPECT_NE(std::string(error.what()).find(each.says), std::string::npos) << error.what();
    }
  }
}

TEST(Script, SetsNumbersChoicesAndSwitches) {
  const auto demo = demos::make("bouncing_ball");
  assign(*demo, "gravity=3.5");
  EXPECT_EQ(demo->control("gravity").value, 3.5);
  assign(*demo, "integrator = explicit Euler");
  EXPECT_EQ(demo->control("integrator").value, 0);
  EXPECT_THROW(assign(*demo, "gravity"), Error);
  EXPECT_THROW(assign(*demo, "gravty=1"), Error);
  EXPECT_THROW(assign(*demo, "gravity=1000"), Error);
  EXPECT_THROW(assign(*demo, "integrator=Eule"), Error);
  const auto pool = demos::make("pool_break");
  assign(*pool, "pockets=off");
  EXPECT_EQ(pool->control("pockets").value, 0);
}

TEST(Script, ShowsWhatItNames) {
  Player player({{"drop", "", [] { return Show{demos::make("ragdoll")}; }}}, 0);
  show(player, "contacts");
  show(player, "velocities");
  EXPECT_TRUE(player.options.contacts);
  EXPECT_FALSE(player.options.normals);
  EXPECT_TRUE(player.motion.velocities);
  EXPECT_FALSE(player.motion.forces);
  EXPECT_THROW(show(player, "contract"), Error);
}

}  // namespace
}  // namespace plumb::window
