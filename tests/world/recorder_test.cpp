#include "engine/world/recorder.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "engine/scene/error.h"
#include "engine/world/replay.h"
#include "engine/world/snapshot.h"
#include "tests/world/busy_world.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;

// A file of this test's own, gone afterwards.
class RecordedFile {
 public:
  RecordedFile()
      : path_(fs::temp_directory_path() /
              (std::string("plumb_") + testing::UnitTest::GetInstance()->current_test_info()->name() + "_" +
               std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".rec")) {}
  ~RecordedFile() { fs::remove(path_); }
  operator const fs::path&() const { return path_; }

  std::string read() const {
    std::ifstream in(path_, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

 private:
  fs::path path_;
};

struct Played {
  BodyId ground, a, b, kinematic;
  JointId joint;
};

// Every call that changes a world, at least once: on a recorded one or a plain one.
template <class Recorded>
Played play(Recorded& world) {
  Played it;
  it.ground = world.create_body({.type = BodyType::Static}, {.geometry = Box{20, 1}, .position = {0, -0.5}});
  it.a = world.create_body({.name = "a", .position = {0, 2}}, {.geometry = Box{1, 1}});
  const ShapeDefinition parts[] = {{.geometry = Circle{0.3}},
                                   {.geometry = Polygon{{{0, 0}, {1, 0}, {0.5, 1}}, 0.01}},
                                   {.geometry = Capsule{{0, 0}, {-1, 0}, 0.2}}};
  it.b =
      world.create_body({.name = "b", .position = {2, 3}, .mass = MassProperties{2, {0.1, 0}, 0.5}}, parts);
  it.kinematic =
      world.create_body({.type = BodyType::Kinematic, .position = {-5, 1}}, {.geometry = Box{1, 1}});
  const ShapeId extra = world.create_shape(it.a, {.geometry = Segment{{-1, 0}, {1, 0}}});
  const ChainId chain = world.create_chain(it.ground, {.points = {{9, 3}, {9, 1}, {9, 0}}});
  it.joint = world.create_joint(it.a, it.b, {.kind = DistanceDefinition{.length = 3, .range = Range{}}});
  const JointId other = world.create_joint(it.ground, it.a, {.kind = FrictionDefinition{.max_force = 1}});
  world.step();
  world.change(it.joint, DistanceDefinition{.length = 2, .spring = Spring{2, 0.5}});
  world.set_gravity({0.5, -9});
  world.set_sleeping(false), world.set_sleeping(true);
  world.set_continuous(false), world.set_continuous(true);
  world.set_solver(Solver::Xpbd), world.set_solver(Solver::SoftSteps);
  world.set_iterations(7), world.set_direct_islands(false), world.set_direct_islands(true);
  world.set_position(it.kinematic, {-4, 1}, 0.1);
  world.move_towards(it.kinematic, {-3, 1}, 0.2, 0.5);
  world.set_velocity(it.a, {1, 2});
  world.set_angular_velocity(it.a, 3);
  world.apply_force(it.b, {1, 10}), world.apply_force(it.b, {1, 10}, {2, 3});
  world.apply_torque(it.b, 2);
  world.step(1.0 / 120, 2);
  world.apply_impulse(it.b, {0.1, 0}), world.apply_impulse(it.b, {0.1, 0}, {2, 4});
  world.apply_angular_impulse(it.b, 0.3);
  world.set_type(it.kinematic, BodyType::Dynamic);
  world.set_mass(it.a, {3, {0, 0.1}, 1});
  world.use_densities(it.b);
  world.set_gravity_scale(it.a, 0.5);
  world.set_damping(it.a, 0.1, 0.2);
  world.set_locks(it.b, false, false, true);
  world.step();
  world.set_awake(it.b, false);
  world.set_may_sleep(it.a, false);
  world.set_material(extra, {.friction = 0.1, .restitution = 0.5});
  world.set_filter(extra, {.category = 2, .mask = 0xFF, .group = 0});
  world.step();
  world.destroy(extra);
  world.destroy(chain);
  world.destroy(other);
  world.on_pre_solve([](const ContactReading&) { return true; });
  for (int i = 0; i < 60; ++i) world.step();
  world.destroy(it.b);
  if constexpr (requires { world.edit({}); }) {
    world.edit([&](auto& inside) { inside.apply_impulse(it.a, {3, 0}); });
  } else {
    world.apply_impulse(it.a, {3, 0});
  }
  for (int i = 0; i < 10; ++i) world.step();
  return it;
}

template <class Real>
class Recorder : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Recorder, Precisions);

TYPED_TEST(Recorder, EveryCallIsRepeated) {
  const RecordedFile file;
  std::uint64_t hash = 0;
  {
    RecordedWorld<TypeParam> world(file, {.gravity = {0, -10}});
    play(world);
    hash = world->hash();
    // Its recording holds what a plain world does.
    BasicWorld<TypeParam> plain({.gravity = {0, -10}});
    play(plain);
    EXPECT_EQ(save(plain), save(*world));
  }
  const ReplayReport report = replay<TypeParam>(file, [](const ContactReading&) { return true; });
  EXPECT_EQ(report.steps, 74);
  EXPECT_FALSE(report.first_difference);
  EXPECT_EQ(report.message, "");
  EXPECT_EQ(report.hash, hash);
  EXPECT_EQ(report.recorded_hash, hash);
  EXPECT_GT(report.calls, 74 + 30);
}

// The busy world is made first: the recording begins with its state.
TYPED_TEST(Recorder, GoesOnWithAWorldThatThereIs) {
  const RecordedFile file;
  test::BusyWorld<TypeParam> busy = test::make_busy_world<TypeParam>();
  test::run(busy, 50);
  RecordedWorld<TypeParam> world(file, std::move(busy.world), {.bodies = false});
  for (int i = 0; i < 60; ++i) {
    world.apply_impulse(busy.links[5], {0.2, 0});
    world.step();
  }
  // The recorder is still there: whatever was finished is in the file.
  Replay<TypeParam> again(file);
  while (again.step()) {
  }
  EXPECT_FALSE(again.report().first_difference);
  EXPECT_EQ(again.report().steps, 60);
  EXPECT_EQ(save(again.world()), save(*world));
}

TYPED_TEST(Recorder, RefusedCallsAreNotRecorded) {
  const RecordedFile file;
  RecordedWorld<TypeParam> world(file);
  const BodyId body = world.create_body({}, {.geometry = Circle{1}});
  EXPECT_THROW(world.create_shape(body, {.geometry = Circle{-1}}), Error);
  EXPECT_THROW(world.set_velocity({}, {1, 0}), Error);
  EXPECT_THROW(world.step(-1), Error);
  world.step();
  const ReplayReport report = replay<TypeParam>(file);
  EXPECT_FALSE(report.first_difference);
  EXPECT_EQ(report.calls, 2);
  EXPECT_EQ(report.message, "");
}

// A hook that decides otherwise than the recorded one: the replay finds the step in which a box goes through
// the floor, and names the box.
TYPED_TEST(Recorder, FindsTheFirstStepThatDiffers) {
  const RecordedFile file;
  std::int64_t landed = -1;
  {
    RecordedWorld<TypeParam> world(file);
    world.on_pre_solve([](const ContactReading&) { return true; });
    world.create_body({.type = BodyType::Static},
                      {.geometry = Box{20, 1}, .position = {0, -0.5}, .pre_solve = true});
    const BodyId box = world.create_body({.name = "box", .position = {0, 1.5}}, {.geometry = Box{1, 1}});
    world.create_body({.name = "ball", .position = {3, 9}}, {.geometry = Circle{0.5}});
    for (int i = 0; i < 60; ++i) {
      world.step();
      if (landed < 0 && !world->contacts(box).empty()) landed = world->step_count();
    }
  }
  ASSERT_GT(landed, 10);
  const ReplayReport report = replay<TypeParam>(file, [](const ContactReading&) { return false; });
  ASSERT_TRUE(report.first_difference);
  // A contact is there a step before it has to press.
  EXPECT_GE(*report.first_difference, landed);
  EXPECT_LE(*report.first_difference, landed + 2);
  EXPECT_NE(report.hash, report.recorded_hash);
  ASSERT_EQ(report.bodies.size(), 1u);
  EXPECT_EQ(report.bodies[0].name, "box");
  EXPECT_EQ(report.bodies[0].body.index, 1u);
  // Without a hook it is told that there was one.
  EXPECT_NE(replay<TypeParam>(file).message.find("pre-solve hook"), std::string::npos);
}

// The hook that was recorded always held the box; the replay's lets go of it in step 40, and not before.
TEST(RecordingFile, TheFirstStepThatDiffersIsNamed) {
  const RecordedFile file;
  {
    RecordedWorld<float> world(file, {.sleeping = false});
    world.on_pre_solve([](const ContactReading&) { return true; });
    world.create_body({.type = BodyType::Static},
                      {.geometry = Box{20, 1}, .position = {0, -0.5}, .pre_solve = true});
    world.create_body({.position = {0, 0.5}}, {.geometry = Box{1, 1}});
    for (int i = 0; i < 60; ++i) world.step();
  }
  Replay<float>* playing = nullptr;
  Replay<float> again(file, [&](const ContactReading&) { return playing->world().step_count() < 39; });
  playing = &again;
  while (again.step()) {
  }
  EXPECT_EQ(again.report().first_difference, 40);
}

// The file of a program that was killed: cut anywhere, it gives all steps that it has whole, and says so.
TEST(RecordingFile, ACutEndIsTolerated) {
  const RecordedFile file;
  {
    RecordedWorld<float> world(file);
    world.create_body({.position = {0, 1}}, {.geometry = Circle{0.5}});
    for (int i = 0; i < 20; ++i) world.step();
  }
  const std::string bytes = file.read();
  std::int64_t before = 0;
  int messages = 0;
  for (std::size_t size = 16; size <= bytes.size(); ++size) {
    file.write(bytes.substr(0, size));
    const ReplayReport report = replay(file);
    EXPECT_FALSE(report.first_difference) << size;
    EXPECT_GE(report.steps, before) << size;
    before = report.steps;
    if (report.message.empty()) continue;
    ++messages;
    EXPECT_NE(report.message.find("cut off"), std::string::npos);
  }
  EXPECT_EQ(before, 20);
  // Whole records at the end: the definition, the body, 20 steps and 20 hashes.
  EXPECT_EQ(messages, static_cast<int>(bytes.size()) - 16 + 1 - 43);
}

// As the guide says: 22 bytes of the call and 18 of the hash.
TEST(RecordingFile, AStepTakesFortyBytes) {
  const RecordedFile file;
  RecordedWorld<float> world(file, WorldDefinition{}, {.bodies = false});
  world.create_body({}, {.geometry = Circle{1}});
  world.step();
  const std::size_t before = file.read().size();
  for (int i = 0; i < 10; ++i) world.step();
  EXPECT_EQ(file.read().size() - before, 400u);
}

// A flipped bit in the middle is refused; the sum of the first record's header is at 16 + 4.
TEST(RecordingFile, DamageIsRefused) {
  const RecordedFile file;
  {
    RecordedWorld<float> world(file);
    for (int i = 0; i < 5; ++i) world.step();
  }
  const std::string bytes = file.read();
  const auto message_of = [&] {
    try {
      replay(file);
    } catch (const Error& error) {
      EXPECT_EQ(error.subject(), "recording");
      return std::string(error.what());
    }
    return std::string();
  };
  int refused = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ (1 << (at % 8)));
    file.write(changed);
    refused += message_of().empty() ? 0 : 1;
  }
  // Sizes that say too much, and the last record, look like a cut end.
  EXPECT_GT(refused, static_cast<int>(bytes.size()) * 3 / 4);
  file.write("no recording at all, but a text");
  EXPECT_NE(message_of().find("header"), std::string::npos);
  file.write("");
  EXPECT_NE(message_of(), "");
  file.write(bytes);
  EXPECT_THROW(replay<double>(file), Error);
  EXPECT_THROW(replay("/nowhere/at/all.rec"), Error);
  EXPECT_THROW(RecordedWorld<float>("/nowhere/at/all.rec"), Error);
}

// A step that fails is in the file: its replay fails alike.
TEST(RecordingFile, LeadsToAStepThatFails) {
  const RecordedFile file;
  RecordedWorld<float> world(file);
  world.create_body({.name = "lost", .gravity_scale = 1e12}, {.geometry = Circle{0.5}});
  world.step();
  world.set_quarantine(false);
  world.set_gravity({0, -1e12});
  // 1e24 m/s^2 through 1e12 s: 1e48 m is beyond a float.
  EXPECT_THROW(world.step(1e12, 1), Error);
  const ReplayReport report = replay(file);
  EXPECT_NE(report.message.find("step"), std::string::npos);
  EXPECT_NE(report.message.find("lost"), std::string::npos);
  EXPECT_EQ(report.steps, 2);
}

// ---- The list of calls is complete

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  EXPECT_TRUE(in) << path << " cannot be read; this test needs the sources";
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::string without_comments(const std::string& text) {
  std::istringstream in(text);
  std::string out;
  for (std::string line; std::getline(in, line);) out += line.substr(0, line.find("//")) + "\n";
  return out;
}

// The name before a declaration's first parenthesis; empty for what is no function.
std::string name_in(const std::string& declaration) {
  const std::size_t end = declaration.find('(');
  if (end == std::string::npos) return "";
  std::size_t begin = end;
  while (begin > 0 && (std::isalnum(static_cast<unsigned char>(declaration[begin - 1])) != 0 ||
                       declaration[begin - 1] == '_'))
    --begin;
  return declaration.substr(begin, end - begin);
}

// Counts how often each member function that is not const is declared in the public part of a class.
std::map<std::string, int> changing_members(const fs::path& header, const std::string& name) {
  std::string text = without_comments(text_of(header));
  text = text.substr(text.find("class " + name + " {"));
  text = text.substr(0, text.find("\n private:"));
  std::map<std::string, int> members;
  std::istringstream declarations(text.substr(text.find("public:") + 7));
  for (std::string each; std::getline(declarations, each, ';');) {
    const std::string member = name_in(each);
    const bool is_const = each.find(") const") != std::string::npos;
    if (is_const || member.empty() || member == name || each.find("operator") != std::string::npos) continue;
    ++members[member];
  }
  return members;
}

TEST(RecordedCalls, AreAllThatChangeAWorld) {
  const fs::path folder = fs::path(PLUMB_ENGINE) / "world";
  std::map<std::string, int> world = changing_members(folder / "world.h", "BasicWorld");
  std::map<std::string, int> recorded = changing_members(folder / "recorder.h", "RecordedWorld");
  EXPECT_GT(world.size(), 25u);
  // Functions reached by edit() and restore().
  EXPECT_EQ(world.erase("data"), 1u);
  // Rules and filters are code that a replay could not know.
  for (const char* name : {"combine_with", "on_filter"}) EXPECT_EQ(world.erase(name), 1u) << name;
  for (const char* name : {"set_profiling", "set_threads", "set_task_system"})
    EXPECT_EQ(world.erase(name), 1u) << name;  // change nothing of the motion
  EXPECT_EQ(recorded.erase("edit"), 1u);
  EXPECT_EQ(recorded.erase("restore"), 1u);
  EXPECT_EQ(world, recorded);
  // The hook has a record of its own; a body that tells its shapes' handles is recorded as one that does not.
  std::map<std::string, int> table{{"on_pre_solve", 1}, {"create_body", 1}};
  for (const char* name : kWorldCallNames) ++table[name];
  EXPECT_EQ(world, table);
}

}  // namespace
}  // namespace plumb
