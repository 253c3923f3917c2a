#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/scene/json.h"
#include "engine/scene/names.h"
#include "tests/scene/sample.h"
#include "tests/scene/schema.h"

/// docs/scene.md and docs/scene.schema.json say what the reader does.
namespace plumb {
namespace {

using nlohmann::json;

std::string read_docs(const std::string& name) {
  std::ifstream file(std::string(PLUMB_DOCS "/") + name, std::ios::binary);
  EXPECT_TRUE(file) << name;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const json& schema() {
  static const json parsed = json::parse(read_docs("scene.schema.json"));
  return parsed;
}

/// The fenced blocks of docs/scene.md that are marked as `language`.
std::vector<std::string> blocks(const std::string& language) {
  std::istringstream text(read_docs("scene.md"));
  std::vector<std::string> out;
  bool inside = false, wanted = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      wanted = inside && line.substr(3) == language;
      if (wanted) out.emplace_back();
    } else if (wanted) {
      out.back() += line + "\n";
    }
  }
  return out;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Docs, ExamplesAreScenes) {
  const std::vector<std::string> examples = blocks("json");
  ASSERT_FALSE(examples.empty());
  for (const std::string& example : examples) {
    const Scene scene = scene_from_json(example);
    EXPECT_FALSE(scene.bodies.empty() || scene.joints.empty() || scene.forces.empty());
    EXPECT_TRUE(test::same_bits(scene_from_json(to_json(scene)), scene));
    EXPECT_TRUE(test::valid(schema(), schema(), json::parse(example)));
  }
}

TEST(Docs, ExamplesOfErrorsAreWhatTheReaderSays) {
  const std::string example = blocks("json").at(0);
  const std::string wrong[] = {
      replaced(example, "\"mass\": 10", "\"mass\": -10"),
      replaced(example, "\"radius\"", "\"radus\""),
      replaced(example, "\"body_b\": \"ball\"", "\"body_b\": \"bal\""),
      replaced(example, "\"duration\"", "\"start\": -1, \"duration\""),
      replaced(example, "\"plumb_scene\": 1,", "\"plumb_scene\": 1"),
  };
  std::string said;
  for (const std::string& text : wrong)
    said += std::string(test::error_of([&] { scene_from_json(text); }).what()) + "\n";
  EXPECT_EQ(blocks("").at(0), said);
}

/// Rows of the tables of docs/scene.md: | `field`, `field` | unit | default | what |
TEST(Docs, TablesAgreeWithTheSchema) {
  std::map<std::string, std::vector<json>> defaults;
  std::map<std::string, bool> required, seen;
  const auto collect = [&](const json& object) {
    for (const auto& [name, property] : object["properties"].items()) {
      seen[name] = false;
      if (property.contains("default")) defaults[name].push_back(property["default"]);
      if (object.contains("required") &&
          object["required"].dump().find('"' + name + '"') != std::string::npos) {
        required[name] = true;
      }
    }
  };
  collect(schema());
  for (const auto& [name, definition] : schema()["$defs"].items()) {
    if (definition.contains("properties")) collect(definition);
  }

  std::istringstream text(read_docs("scene.md"));
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("| `")) continue;
    const std::size_t second = line.find('|', 1), third = line.find('|', second + 1),
                      fourth = line.find('|', third + 1);
    const std::string fields = line.substr(0, second), value = line.substr(third + 2, fourth - third - 3);
    for (std::size_t at = fields.find('`'); at != std::string::npos;
         at = fields.find('`', fields.find('`', at + 1) + 1)) {
      const std::string name = fields.substr(at + 1, fields.find('`', at + 1) - at - 1);
      ASSERT_TRUE(seen.contains(name)) << line;
      seen[name] = true;
      if (value == "required") {
        EXPECT_TRUE(required[name]) << line;
      }
      if (value.starts_with('`')) {
        const auto& known = defaults[name];
        const json documented = json::parse(value.substr(1, value.size() - 2));
        EXPECT_TRUE(std::count(known.begin(), known.end(), documented) > 0) << line;
      }
    }
  }
  for (const auto& [name, is_seen] : seen) EXPECT_TRUE(is_seen) << name << " is not in scene.md";
}

TEST(Schema, TakesWhatTheWriterWrites) {
  EXPECT_TRUE(test::valid(schema(), schema(), json::parse(to_json(test::full_scene()))));
  std::mt19937_64 random(9);
  for (int i = 0; i < 300; ++i) {
    const std::string text = to_json(test::random_scene(random));
    ASSERT_TRUE(test::valid(schema(), schema(), json::parse(text))) << text;
  }
}

template <std::size_t kCount>
json list_of(const std::array<std::string_view, kCount>& names) {
  json out = json::array();
  for (const std::string_view name : names) out.push_back(std::string(name));
  return out;
}

TEST(Schema, ListsTheSameChoices) {
  const json& definitions = schema()["$defs"];
  EXPECT_EQ(definitions["combine"]["enum"], list_of(kCombineNames));
  EXPECT_EQ(definitions["body"]["properties"]["type"]["enum"], list_of(kBodyTypeNames));
  EXPECT_EQ(definitions["point_force"]["properties"]["frame"]["enum"], list_of(kFrameNames));
  const auto types = [&](const char* name) {
    json out = json::array();
    for (const json& one : definitions[name]["oneOf"]) {
      const std::string target = one["$ref"].get<std::string>().substr(1);
      out.push_back(schema().at(json::json_pointer(target))["properties"]["type"]["const"]);
    }
    return out;
  };
  EXPECT_EQ(types("shape"), list_of(kGeometryNames));
  EXPECT_EQ(types("joint"), list_of(kJointNames));
  EXPECT_EQ(types("force"), list_of(kForceNames));
}

/// A scene with nothing but what is required, written out: all else stands at its default.
TEST(Schema, StatesTheDefaults) {
  const Scene scene = scene_from_json(R"({"bodies": [{"name": "a", "shapes": [{"type": "circle", "radius": 1},
      {"type": "box", "width": 1, "height": 1}, {"type": "capsule", "start": [0, 0], "end": [1, 0], "radius": 1},
      {"type": "polygon", "points": [[0, 0], [1, 0], [0, 1]]}, {"type": "segment", "start": [0, 0], "end": [1, 0]},
      {"type": "chain", "points": [[0, 0], [1, 0]]}]}],
    "joints": [{"type": "revolute", "name": "r", "body_a": "world", "body_b": "a"},
               {"type": "distance", "name": "d", "body_a": "world", "body_b": "a", "length": 1},
               {"type": "prismatic", "name": "p", "body_a": "world", "body_b": "a"},
               {"type": "weld", "name": "we", "body_a": "world", "body_b": "a"},
               {"type": "wheel", "name": "wh", "body_a": "world", "body_b": "a"},
               {"type": "motor", "name": "mo", "body_a": "world", "body_b": "a"},
               {"type": "mouse", "name": "m", "body_a": "world", "body_b": "a", "target": [0, 0], "max_force": 1},
               {"type": "gear", "name": "g", "body_a": "world", "body_b": "a"},
               {"type": "pulley", "name": "pu", "body_a": "world", "body_b": "a", "ground_a": [0, 0], "ground_b": [0, 0]},
               {"type": "ratchet", "name": "ra", "body_a": "world", "body_b": "a"},
               {"type": "friction", "name": "f", "body_a": "world", "body_b": "a"}],
    "forces": [{"type": "linear_drag", "body": "a", "coefficient": 1},
               {"type": "quadratic_drag", "body": "a", "coefficient": 1},
               {"type": "point_force", "body": "a", "force": [1, 0]}, {"type": "torque", "body": "a", "torque": 1},
               {"type": "spring", "body_a": "world", "body_b": "a", "stiffness": 1},
               {"type": "attraction", "body": "a", "strength": 1},
               {"type": "sinusoidal_force", "body": "a", "amplitude": [1, 0], "angular_frequency": 1},
               {"type": "formula_force", "body": "a"},
               {"type": "formula_spring", "body_a": "world", "body_b": "a", "tension": "length"}]})");
  const json written = json::parse(to_json(scene));
  const std::pair<const char*, const char*> parts[] = {
      {"", ""},
      {"/$defs/contact_rules", "/contact_rules"},
      {"/$defs/body", "/bodies/0"},
      {"/$defs/circle", "/bodies/0/shapes/0"},
      {"/$defs/box", "/bodies/0/shapes/1"},
      {"/$defs/capsule", "/bodies/0/shapes/2"},
      {"/$defs/polygon", "/bodies/0/shapes/3"},
      {"/$defs/segment", "/bodies/0/shapes/4"},
      {"/$defs/chain", "/bodies/0/shapes/5"},
      {"/$defs/filter", "/bodies/0/shapes/0/filter"},
      {"/$defs/revolute", "/joints/0"},
      {"/$defs/distance", "/joints/1"},
      {"/$defs/prismatic", "/joints/2"},
      {"/$defs/weld", "/joints/3"},
      {"/$defs/wheel", "/joints/4"},
      {"/$defs/motor_joint", "/joints/5"},
      {"/$defs/mouse", "/joints/6"},
      {"/$defs/gear", "/joints/7"},
      {"/$defs/pulley", "/joints/8"},
      {"/$defs/ratchet", "/joints/9"},
      {"/$defs/friction_joint", "/joints/10"},
      {"/$defs/linear_drag", "/forces/0"},
      {"/$defs/quadratic_drag", "/forces/1"},
      {"/$defs/point_force", "/forces/2"},
      {"/$defs/torque", "/forces/3"},
      {"/$defs/spring", "/forces/4"},
      {"/$defs/attraction", "/forces/5"},
      {"/$defs/sinusoidal_force", "/forces/6"},
      {"/$defs/formula_force", "/forces/7"},
      {"/$defs/formula_spring", "/forces/8"},
  };
  const json defaults_of_lists = {{"bodies", 0}, {"joints", 0}, {"forces", 0}, {"shapes", 0}};
  for (const auto& [definition, pointer] : parts) {
    const json& properties = schema().at(json::json_pointer(definition))["properties"];
    for (const auto& [name, property] : properties.items()) {
      if (!property.contains("default") || defaults_of_lists.contains(name)) continue;
      EXPECT_EQ(written.at(json::json_pointer(pointer)).value(name, json()), property["default"])
          << pointer << "/" << name;
    }
  }
}

/// Rules that tie one part of the scene to another, which a schema cannot say. It does refuse what is no name
/// at all.
bool beyond_schema(const Error& error) {
  if (error.value().empty() || error.value() == "\"\"" || error.value().find("\\x") != std::string::npos)
    return false;
  for (const char* rule :
       {"must be unique", "must be the name of a body", "must differ from", "must be dynamic when",
        "must not lie on a line", "must not be zero: it is a direction", "must be at least the lower bound",
        "densities", "another shape of the body", "weigh nothing", "when closed", "is not a formula",
        "must be the name of a joint", "must have a motor", "one drive at most"}) {
    if (error.problem().find(rule) != std::string::npos) return true;
  }
  return false;
}

void expect_agreement(const json& scene) {
  bool accepted = true;
  std::string message = "accepted";
  try {
    scene_from_json(scene.dump());
  } catch (const Error& error) {
    accepted = beyond_schema(error);
    message = error.what();
  }
  ASSERT_EQ(test::valid(schema(), schema(), scene), accepted) << message << "\n" << scene.dump();
}

void collect_pointers(const json& value, const json::json_pointer& here,
                      std::vector<json::json_pointer>& out) {
  out.push_back(here);
  if (value.is_object()) {
    for (const auto& [name, member] : value.items()) collect_pointers(member, here / name, out);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) collect_pointers(value[i], here / i, out);
  }
}

/// Every value of a scene in turn is taken out, replaced by values of every kind, and given an unknown
/// member: schema and reader accept and refuse the same.
TEST(Schema, AcceptsAndRefusesWithTheReader) {
  const json whole = json::parse(to_json(test::full_scene()));
  const json others =
      json::parse(R"([null, true, false, "x", "", "static", "world", "a\u0001", -1, 0, -0.0, 0.5, 1, 1.5,
    2, 1e-101, 1e-100, 1e100, 1.1e100, -1.1e100, 4294967295, 4294967296, -2147483648, -2147483649, [], [0], [0, 0],
    [1, 1.1e100], [0, 0, 0], [0, "y"], [{}], {}, {"type": "circle"}])");
  std::vector<json::json_pointer> pointers;
  collect_pointers(whole, json::json_pointer(), pointers);
  EXPECT_GT(pointers.size(), 140u);
  ASSERT_NO_FATAL_FAILURE(expect_agreement(whole));
  for (const auto& pointer : pointers) {
    for (const json& other : others) {
      json scene = whole;
      scene[pointer] = other;
      ASSERT_NO_FATAL_FAILURE(expect_agreement(scene)) << pointer.to_string();
    }
    if (whole[pointer].is_object()) {
      json scene = whole;
      scene[pointer]["surprise"] = 1;
      ASSERT_NO_FATAL_FAILURE(expect_agreement(scene));
    }
    if (pointer.empty()) continue;
    json scene = whole;
    json& parent = scene[pointer.parent_pointer()];
    if (parent.is_object()) {
      parent.erase(pointer.back());
    } else {
      parent.erase(std::stoul(pointer.back()));
    }
    ASSERT_NO_FATAL_FAILURE(expect_agreement(scene)) << pointer.to_string();
  }
}

}  // namespace
}  // namespace plumb
