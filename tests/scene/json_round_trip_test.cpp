#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/scene/json.h"
#include "engine/scene/json/json_document.h"
#include "engine/scene/json/json_emitter.h"
#include "tests/scene/sample.h"

namespace plumb {
namespace {

double written_and_read(double value) {
  json::Emitter emitter(-1);
  emitter.begin('[');
  emitter.number(value);
  emitter.end(']');
  json::Document document;
  json::parse(emitter.take(), document);
  EXPECT_FALSE(document.error.has_value()) << value;
  return document.root.items.at(0).number;
}

TEST(RoundTrip, EveryFiniteDoubleKeepsItsBits) {
  using Limits = std::numeric_limits<double>;
  std::vector<double> values{0.0,
                             -0.0,
                             1.0 / 3,
                             0.1,
                             1e22,
                             1e23,
                             5e-324,
                             2.2250738585072011e-308,
                             Limits::min(),
                             Limits::max(),
                             Limits::lowest(),
                             9007199254740993.0,
                             18446744073709551616.0,
                             -9223372036854775808.0,
                             1e15,
                             123456789012345678.0};
  std::mt19937_64 random(4);
  for (int i = 0; i < 50000; ++i) values.push_back(test::random_bits(random));
  for (int i = 0; i < 5000; ++i) values.push_back(std::bit_cast<double>(random() >> 12));  // denormal
  for (int i = 0; i < 5000; ++i) values.push_back(static_cast<double>(static_cast<std::int64_t>(random())));
  for (const double value : values) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(written_and_read(value)), std::bit_cast<std::uint64_t>(value))
        << value;
  }
}

TEST(RoundTrip, OneOfEverything) {
  const Scene scene = test::full_scene();
  for (const int indent : {-1, 0, 2, 4}) {
    EXPECT_TRUE(test::same_bits(scene_from_json(to_json(scene, indent)), scene)) << indent;
  }
}

TEST(RoundTrip, Defaults) {
  EXPECT_EQ(scene_from_json("{}"), Scene{});
  EXPECT_TRUE(test::same_bits(scene_from_json(to_json(Scene{})), Scene{}));
}

TEST(RoundTrip, RandomScenes) {
  std::mt19937_64 random(5);
  std::size_t numbers = 0;
  for (int i = 0; i < 2000; ++i) {
    const Scene scene = test::random_scene(random);
    const std::string text = to_json(scene, i % 4 - 1);
    const Scene again = scene_from_json(text);
    ASSERT_TRUE(test::same_bits(again, scene)) << text;
    ASSERT_EQ(hash(again), hash(scene));
    numbers += 10 * scene.bodies.size();
  }
  EXPECT_GT(numbers, 10000u);
}

/// Another reader and writer of JSON sees the same values, and all layouts are the same JSON.
TEST(Writer, IsPlainJson) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 200; ++i) {
    const Scene scene = test::random_scene(random);
    const auto parsed = nlohmann::ordered_json::parse(to_json(scene));
    EXPECT_EQ(parsed, nlohmann::ordered_json::parse(to_json(scene, -1)));
    EXPECT_EQ(parsed["name"], scene.name);
    EXPECT_EQ(parsed["gravity"][0].get<double>(), scene.gravity.x);
    for (std::size_t j = 0; j < scene.bodies.size(); ++j) {
      EXPECT_EQ(parsed["bodies"][j]["mass"].get<double>(), scene.bodies[j].mass);
      EXPECT_EQ(parsed["bodies"][j].contains("inertia"), scene.bodies[j].inertia.has_value());
    }
    EXPECT_TRUE(test::same_bits(scene_from_json(parsed.dump()), scene));
  }
}

TEST(Writer, LayoutAndOrderOfKeys) {
  Scene scene{.name = "a\t\"b\"", .gravity = {-0.0, 0.5}};
  scene.name = "a \"b\"";
  scene.bodies = {{.name = "p", .inertia = 2}};
  scene.forces = {Torque{.body = "p", .torque = 3}};
  EXPECT_EQ(to_json(scene), R"({
  "plumb_scene": 1,
  "name": "a \"b\"",
  "gravity": [-0.0, 0.5],
  "contact_rules": {
    "friction": "geometric_mean",
    "restitution": "maximum",
    "restitution_threshold": 0
  },
  "bodies": [
    {
      "name": "p",
      "type": "dynamic",
      "position": [0, 0],
      "angle": 0,
      "velocity": [0, 0],
      "angular_velocity": 0,
      "mass": 1,
      "inertia": 2,
      "fixed_rotation": false,
      "lock_x": false,
      "lock_y": false,
      "gravity_scale": 1,
      "linear_damping": 0,
      "angular_damping": 0,
      "shapes": []
    }
  ],
  "joints": [],
  "forces": [
    {
      "type": "torque",
      "body": "p",
      "torque": 3,
      "start": 0
    }
  ]
})");
}

TEST(Writer, EscapesWhatJsonWants) {
  std::string every;
  for (int c = 0; c < 128; ++c) every += static_cast<char>(c);
  json::Emitter emitter(-1);
  emitter.string(every);
  EXPECT_FALSE(emitter.failed());
  EXPECT_EQ(nlohmann::json::parse(emitter.take()), every);
}

TEST(Writer, RefusesWhatJsonCannotHold) {
  const auto refused = [](auto spoil) {
    Scene scene = test::full_scene();
    spoil(scene);
    return test::error_of([&] { to_json(scene); });
  };
  EXPECT_EQ(refused([](Scene& s) { s.bodies[0].mass = std::nan(""); }).field(), "mass");
  EXPECT_EQ(refused([](Scene& s) { s.bodies[1].name = "\xFF"; }).subject(), "body '\\xff'");
  EXPECT_EQ(refused([](Scene& s) { s.contact_rules.friction = static_cast<Combine>(7); }).value(), "7");
  EXPECT_EQ(refused([](Scene& s) { std::get<Torque>(s.forces[3]).duration = std::nan(""); }).field(),
            "duration");
}

TEST(Writer, WritesInvalidScenesThatJsonCanHold) {
  Scene scene = test::full_scene();
  scene.bodies[0].mass = -1;
  EXPECT_EQ(test::error_of([&] { scene_from_json(to_json(scene)); }).field(), "mass");
}

TEST(Reader, TakesNumbersInAnyNotation) {
  const Scene scene =
      scene_from_json(R"({"gravity": [-0, 1E1], "contact_rules": {"restitution_threshold": 25e-2},
    "bodies": [{"name": "a", "inertia": 1.0, "mass": 100000000000000000000000,
                "shapes": [{"type": "circle", "radius": 1, "filter": {"group": -2.0, "mask": 1e3}}]}]})");
  EXPECT_TRUE(std::signbit(scene.gravity.x));
  EXPECT_EQ(scene.gravity.y, 10);
  EXPECT_EQ(scene.contact_rules.restitution_threshold, 0.25);
  EXPECT_EQ(scene.bodies[0].mass, 1e23);
  EXPECT_EQ(scene.bodies[0].shapes[0].filter, (Filter{1, 1000, -2}));
}

}  // namespace
}  // namespace plumb
