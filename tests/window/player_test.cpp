#include "demos/window/player.h"

#include <gtest/gtest.h>

#include "demos/core/registry.h"
#include "engine/scene/error.h"

namespace plumb::window {
namespace {

constexpr double kFrame = 1.0 / 60;

std::vector<Item> items() {
  std::vector<Item> out;
  for (const demos::Entry& entry : demos::all())
    out.push_back({entry.about.name, entry.about.summary, [&entry] { return Show{entry.make()}; }});
  return out;
}

Player ball() {
  Player player(items(), 0);
  player.strict = true;
  return player;
}

TEST(Player, PausesAndStepsForthAndBack) {
  Player player = ball();
  for (int i = 0; i < 10; ++i) player.advance(kFrame);
  ASSERT_EQ(player.demo().step_count(), 10);
  const std::uint64_t tenth = player.demo().hash();
  player.key("p");
  player.advance(kFrame);
  EXPECT_EQ(player.demo().step_count(), 10);
  player.key("o");
  EXPECT_EQ(player.demo().step_count(), 11);
  const std::uint64_t eleventh = player.demo().hash();
  player.key("b");
  EXPECT_EQ(player.demo().step_count(), 10);
  EXPECT_EQ(player.demo().hash(), tenth);
  player.key("o");
  EXPECT_EQ(player.demo().hash(), eleventh);
}

TEST(Player, GoesBackToTheStartAndNoFarther) {
  Player player = ball();
  const std::uint64_t start = player.demo().hash();
  for (int i = 0; i < 100; ++i) player.advance(kFrame);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(player.back());
  EXPECT_EQ(player.demo().hash(), start);
  EXPECT_FALSE(player.back());
  EXPECT_EQ(player.demo().step_count(), 0);
  EXPECT_FALSE(player.message.empty());
}

// All demos, bit for bit: what was done after a state is undone.
TEST(Player, EveryDemoGoesBackAndOnAlike) {
  Player player(items(), 0);
  player.strict = true;
  for (std::size_t place = 0; place < player.items().size(); ++place) {
    player.open(place);
    player.paused = false;
    for (int i = 0; i < 30; ++i) player.advance(kFrame);
    player.paused = true;
    const std::uint64_t before = player.demo().hash();
    for (int i = 0; i < 5; ++i) player.step();
    const std::uint64_t after = player.demo().hash();
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(player.back());
    EXPECT_EQ(player.demo().hash(), before) << player.items()[place].name;
    for (int i = 0; i < 5; ++i) player.step();
    EXPECT_EQ(player.demo().hash(), after) << player.items()[place].name;
  }
}

TEST(Player, RestartsAsItBegan) {
  Player player = ball();
  const std::uint64_t start = player.demo().hash();
  for (int i = 0; i < 30; ++i) player.advance(kFrame);
  EXPECT_NE(player.demo().hash(), start);
  player.key("r");
  EXPECT_EQ(player.demo().hash(), start);
  EXPECT_EQ(player.remembered(), 1u);
}

TEST(Player, SlowMotionIsATenth) {
  Player player = ball();
  player.key("s");
  for (int i = 0; i < 600; ++i) player.advance(kFrame);
  EXPECT_EQ(player.demo().step_count(), 60);
}

TEST(Player, KeysOpenTheNextAndThePrevious) {
  Player player = ball();
  player.key("[");
  EXPECT_EQ(player.place(), player.items().size() - 1);
  player.key("]");
  EXPECT_EQ(player.place(), 0u);
  player.key("]");
  EXPECT_EQ(player.demo().about().name, player.items()[1].name);
}

TEST(Player, CommandsOfTheCallerAreReturned) {
  Player player = ball();
  EXPECT_EQ(player.key("escape"), Command::Quit);
  EXPECT_EQ(player.key("f12"), Command::Picture);
  EXPECT_EQ(player.key("x"), std::nullopt);
}

// No demo has a key that the window takes for itself.
TEST(Player, KeysOfDemosAndOfTheWindowDiffer) {
  for (const demos::Entry& entry : demos::all())
    for (const demos::Key& key : entry.about.keys)
      for (const CommandKey& command : command_keys())
        EXPECT_NE(command.key, std::string(1, key.key)) << entry.about.name;
}

TEST(Player, SaysWhatIsWrongOrThrowsIt) {
  Player player = ball();
  EXPECT_THROW(player.set("gravity", 1e6), Error);
  player.strict = false;
  player.set("gravity", 1e6);
  EXPECT_NE(player.message.find("gravity"), std::string::npos);
}

TEST(Player, FiguresAreKeptAndTakenBack) {
  Player player = ball();
  for (int i = 0; i < 20; ++i) player.advance(kFrame);
  const Series& height = player.series()[1];
  ASSERT_EQ(height.name(), "height");
  EXPECT_EQ(height.values().size(), 21u);
  const double last = height.last();
  player.step();
  player.back();
  EXPECT_EQ(player.series()[1].values().size(), 21u);
  EXPECT_EQ(player.series()[1].last(), last);
}

TEST(History, ForgetsTheOldestWhenItIsFull) {
  History history(100);
  for (int i = 0; i < 10; ++i) history.push(std::vector<std::byte>(30, static_cast<std::byte>(i)));
  EXPECT_EQ(history.size(), 3u);
  EXPECT_EQ(history.back()[0], std::byte{8});
  EXPECT_EQ(history.back()[0], std::byte{7});
  EXPECT_TRUE(history.back().empty());
}

}  // namespace
}  // namespace plumb::window
