#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "demos/core/registry.h"
#include "tests/app/program.h"
#include "tests/window/pictures.h"

namespace plumb::window {
namespace {

using app::Folder;
using app::plumb;
using app::Ran;
using testing::HasSubstr;

// Orange, as nothing but bodies that move is.
bool awake(Colour colour) { return colour.r > colour.b + 40; }

TEST(Program, ListsTheDemos) {
  const Ran ran = plumb({"demo", "--list"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  const auto lines = app::lines_of(ran.out);
  ASSERT_EQ(lines.size(), demos::all().size());
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_THAT(lines[i], HasSubstr(demos::all()[i].about.name));
}

// The ball is drawn where it was after 29 steps of 1/60 s: after 30 frames the picture stands at the start of
// the 30th step. Verlet's parabola is exact.
TEST(Program, DrawsTheBallWhereItIs) {
  const Folder folder;
  const std::string file = folder.path("ball.png");
  const Ran ran =
      plumb({"demo", "bouncing_ball", "--headless", "--seconds", "0.5", "--no-panel", "--set", "damping=0",
             "--set", "integrator=Verlet", "--width", "800", "--height", "640", "--screenshot", file});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("steps  30\n"));
  const Canvas picture = read_png(file);
  ASSERT_EQ(picture.width(), 800);
  ASSERT_EQ(picture.height(), 640);
  // The room of 8 m by 6 m and 0.3 m around it, with a margin of 16 px, below 36 px: the width decides, and
  // the middle is at half of 16 px and 640 - 36 px.
  const double scale = (800 - 32) / 8.6, t = 29.0 / 60;
  const double x = 1.5 + 2.5 * t, y = 5.2 - 9.81 * t * t / 2;
  const Blob ball = blob_of(picture, awake);
  EXPECT_NEAR(ball.centre.x, 400 + scale * (x - 4), 0.3);
  EXPECT_NEAR(ball.centre.y, 310 - scale * (y - 3), 0.3);
  const double radius = 0.3 * scale;  // less the pixels that the edge goes through
  EXPECT_NEAR(std::sqrt(static_cast<double>(ball.count) / M_PI), radius, 1);
}

TEST(Program, TheSameCallGivesTheSameBytes) {
  const Folder folder;
  for (const char* name : {"ragdoll", "pool_break"}) {
    for (const char* file : {"a.png", "b.png"})
      ASSERT_EQ(plumb({"demo", name, "--headless", "--seconds", "0.5", "--show", "contacts", "--screenshot",
                       folder.path(file)})
                    .code,
                0);
    EXPECT_GT(folder.read("a.png").size(), 1000u);
    EXPECT_EQ(folder.read("a.png"), folder.read("b.png")) << name;
  }
}

TEST(Program, EveryDemoDrawsSomethingInBothThemes) {
  const Folder folder;
  for (const demos::Entry& entry : demos::all()) {
    std::set<std::string> pictures;
    for (const char* theme : {"dark", "light"}) {
      const Ran ran =
          plumb({"demo", entry.about.name, "--headless", "--seconds", "0.2", "--theme", theme, "--no-panel",
                 "--width", "400", "--height", "300", "--screenshot", folder.path("a.png")});
      ASSERT_EQ(ran.code, 0) << ran.err;
      const Canvas picture = read_png(folder.path("a.png"));
      const std::set<std::uint32_t> colours(picture.pixels().begin(), picture.pixels().end());
      EXPECT_GT(colours.size(), 20u) << entry.about.name;
      pictures.insert(folder.read("a.png"));
    }
    EXPECT_EQ(pictures.size(), 2u) << entry.about.name;
  }
}

// A ball that is held does not fall; one that is let go does.
TEST(Program, ScriptsPlay) {
  const Folder folder;
  const std::string script = folder.write(
      "s", "0.1 press 4 3\n0.5 picture " + folder.path("held.png") + "\n0.5 release 4 3\n0.9 key p\n");
  const Ran ran =
      plumb({"demo", "bouncing_ball", "--headless", "--seconds", "2", "--no-panel", "--width", "800",
             "--height", "640", "--script", script, "--screenshot", folder.path("end.png")});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Blob held = blob_of(read_png(folder.path("held.png")), awake);
  EXPECT_NEAR(held.centre.x, 400, 0.3);
  EXPECT_NEAR(held.centre.y, 310, 0.3);
  // Paused after 24 frames of falling.
  EXPECT_THAT(ran.out, HasSubstr("steps  54\n"));
  EXPECT_GT(blob_of(read_png(folder.path("end.png")), awake).centre.y, 370);
}

TEST(Program, ViewHoldsTheSceneAgainstItsTruth) {
  const Ran ran = plumb({"view", "pendulum_chain[5]", "--headless", "--seconds", "0.5"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, testing::ContainsRegex("position error: [0-9.]+e-05 m"));
  EXPECT_THAT(ran.out, HasSubstr("energy drift: "));
}

TEST(Program, ViewDrawsOtherEnginesAndReadsFiles) {
  const Folder folder;
  const std::string file = folder.write("scene.json", plumb({"scene", "elastic_collision/oblique"}).out);
  std::set<std::string> pictures;
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--ghost", "plumb-precise"}}) {
    std::vector<std::string> arguments = {
        "view",       file,    "--headless", "--seconds",    "0.5",
        "--no-panel", "--set", "dt=0.04",    "--screenshot", folder.path("a.png")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran ran = plumb(arguments);
    ASSERT_EQ(ran.code, 0) << ran.err;
    pictures.insert(folder.read("a.png"));
  }
  EXPECT_EQ(pictures.size(), 2u);
}

// The engine of the course's first starter, which stands between plumb's own and the truth.
std::string starter() { return "mine=python3 -B " PLUMB_SOURCE_DIR "/docs/course/starters/ball.py"; }

TEST(Program, ViewIsMovedByAnEngineOfOnesOwn) {
  const Folder folder;
  std::set<std::string> pictures;
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--engine-command", starter()},
                                               {"--engine-command", starter(), "--ghost", "mine"},
                                               {}}) {
    std::vector<std::string> arguments = {
        "view", "ball_in_room/falling", "--headless",   "--seconds",
        "1.5",  "--no-panel",           "--screenshot", folder.path("a.png")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran ran = plumb(arguments);
    ASSERT_EQ(ran.code, 0) << ran.err;
    pictures.insert(folder.read("a.png"));
  }
  EXPECT_EQ(pictures.size(), 3u);
}

TEST(Program, DemoPlaysTheChecksOfAnEngineOfOnesOwn) {
  const std::vector<std::string> base = {
      "demo", "bouncing_ball", "--engine-command", starter(), "--headless", "--seconds", "1"};
  std::vector<std::string> named = base;
  named.insert(named.end(), {"--check", "four_walls"});
  const Ran first = plumb(base), walls = plumb(named);
  ASSERT_EQ(first.code, 0) << first.err;
  ASSERT_EQ(walls.code, 0) << walls.err;
  EXPECT_THAT(walls.out, HasSubstr("end of the run: 5 s"));
  EXPECT_NE(first.out, walls.out);
  std::vector<std::string> wrong = base;
  wrong.insert(wrong.end(), {"--check", "five_walls"});
  EXPECT_THAT(plumb(wrong).err, HasSubstr("five_walls"));
}

TEST(Program, SaysWhatIsWrong) {
  const Folder folder;
  const std::string script = folder.write("s", "0 jump 1 2\n");
  struct Case {
    std::vector<std::string> arguments;
    const char* says;
  };
  for (const Case& each : std::vector<Case>{
           {{"demo", "ragdol", "--headless", "--seconds", "1"}, "did you mean 'ragdoll'?"},
           {{"demo", "ragdoll", "--headless"}, "give --seconds T"},
           {{"demo", "ragdoll", "--headless", "--seconds", "1", "--set", "gravitas=1"}, "gravitas"},
           {{"demo", "ragdoll", "--headless", "--seconds", "1", "--script", script}, "'jump'"},
           {{"demo", "ragdoll", "--headless", "--seconds", "0", "--screenshot", "/nowhere/a.png"},
            "/nowhere"},
           {{"demo", "ragdoll", "--wide", "3"}, "plumb demo --help"},
           {{"view", "kepler", "--headless", "--seconds", "1", "--ghost", "box3d"}, "box3d"},
           {{"view", "keppler", "--headless", "--seconds", "1"}, "keppler"}}) {
    const Ran ran = plumb(each.arguments);
    EXPECT_EQ(ran.code, 2) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(each.says));
    EXPECT_EQ(app::lines_of(ran.err).size(), 1u) << ran.err;
  }
}

// The drivers that SDL would take where there is no display are not used unless asked for.
TEST(Program, SaysThatThereIsNoDisplay) {
  const Ran ran =
      plumb({"demo", "bouncing_ball"}, {"DISPLAY=", "WAYLAND_DISPLAY=", "XDG_RUNTIME_DIR=/nowhere"});
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("--headless --seconds T --screenshot FILE"));
}

TEST(Program, MeasuresFrames) {
  const Ran ran = plumb({"demo", "bouncing_ball", "--headless", "--measure-frames", "5"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  for (const char* part : {"5 frames", "median", "p99", "steps", "drawing", "showing"})
    EXPECT_THAT(ran.out, HasSubstr(part));
}

}  // namespace
}  // namespace plumb::window
