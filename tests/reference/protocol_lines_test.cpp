// The messages of the protocol, cut off, garbled, of the wrong types and too deep: refused as what they are,
// or understood.
#include "reference/support/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/scene/json.h"
#include "tests/reference/process_fixture.h"

namespace plumb::reference {
namespace {

using Json = nlohmann::ordered_json;

Json good_hello() {
  return Json::parse(R"({"protocol": 1, "name": "test", "version": "1", "precision": "double", "summary": "s",
      "method": {"scheme": "velocity_verlet", "order": 2, "epsilon": 2.2e-16}, "shapes": ["circle", "box"],
      "joints": ["revolute"], "forces": ["torque"], "features": ["contacts"], "substeps": 2,
      "options": [{"name": "iterations", "fallback": 4, "range": "from 1", "meaning": "sweeps"}]})");
}

/// Reader of each kind of message.
struct Message {
  const char* name;
  Json good;
  std::function<void(const Json&)> read;
};

std::vector<Message> messages() {
  return {{"hello", good_hello(), [](const Json& m) { protocol::hello_from_json(m); }},
          {"settings", Json::parse(R"({"dt": 0.1, "substeps": 4, "tolerance": 1e-9, "options": {"a": "b"}})"),
           [](const Json& m) { protocol::settings_from_json(m); }},
          {"effective settings", Json::parse(R"({"dt": 0.1, "sleeping": false, "name": "x"})"),
           [](const Json& m) { protocol::effective_from_json(m); }},
          {"error",
           Json::parse(R"({"kind": "value", "subject": "s", "field": "f", "value": "v", "problem": "p"})"),
           [](const Json& m) { protocol::error_from_json(m, "test"); }},
          {"sample", Json::parse(R"({"t": 0.25, "states": [[1, 2, 3, 4, 5, 6], [7, 8, 9, 10, 11, 12]]})"),
           [](const Json& m) {
             std::vector<BodyState> states(2);
             const double t = protocol::sample_from_json(m, states);
             EXPECT_TRUE(std::isfinite(t));
             for (const BodyState& s : states) EXPECT_TRUE(std::isfinite(s.position.x + s.angular_velocity));
           }}};
}

/// Returns what is said of a message that is refused; empty if it is understood.
std::string complaint(const std::function<void()>& read) {
  try {
    read();
  } catch (const std::exception& problem) {
    return problem.what();
  }
  return "";
}

TEST(ProtocolLines, AHelloOutOfItsRangesIsRefusedByName) {
  const auto of_method = [](const char* name, const Json& value) {
    Json hello = good_hello();
    hello["method"][name] = value;
    return complaint([&] { protocol::hello_from_json(hello); });
  };
  EXPECT_EQ(of_method("order", 20), "");
  EXPECT_THAT(of_method("order", 99), ::testing::HasSubstr("\"order\" is 99, not 0 to 20"));
  EXPECT_EQ(of_method("epsilon", 0.0078125), "");
  for (const double epsilon : {1e9, 0.02, 0.0, -1.0})
    EXPECT_THAT(of_method("epsilon", epsilon), ::testing::HasSubstr("\"epsilon\" is ")) << epsilon;
}

TEST(ProtocolLines, TheMemberThatIsNotFiniteIsNamed) {
  const auto said = [](const char* line) { return complaint([&] { protocol::parse_line(line); }); };
  EXPECT_EQ(said(R"({"protocol": 1, "method": {"order": 1, "epsilon": NaN}})"), "'epsilon' is not finite");
  EXPECT_EQ(said(R"({"t": 1, "states": [[0, -Infinity, 0, 0, 0, 0]]})"), "a state is not finite");
  EXPECT_THAT(said(R"({"name": "info", )"), ::testing::HasSubstr("it is not JSON"));
}

TEST(ProtocolLines, SettingsAreTextNumbersOrBooleans) {
  for (const char* value : {R"({"a": 1})", "[1]", "null"}) {
    const Json settings{{"dt", Json::parse(value)}};
    EXPECT_THAT(complaint([&] { protocol::effective_from_json(settings); }),
                ::testing::HasSubstr("its setting 'dt' is "))
        << value;
  }
}

/// True when it was understood; whatever is thrown has to be one of the protocol's own.
bool understood(const Message& message, const std::string& line) {
  try {
    message.read(protocol::parse_line(line));
    return true;
  } catch (const protocol::Malformed& problem) {
    EXPECT_STRNE(problem.what(), "");
  } catch (const protocol::NotFinite& problem) {
    EXPECT_STRNE(problem.what(), "");
  } catch (const Error& error) {
    EXPECT_FALSE(error.problem().empty());
  }
  return false;
}

TEST(ProtocolLines, EveryTruncationIsRefused) {
  for (const Message& message : messages()) {
    const std::string line = message.good.dump();
    EXPECT_TRUE(understood(message, line)) << message.name;
    for (std::size_t size = 0; size < line.size(); ++size)
      EXPECT_FALSE(understood(message, line.substr(0, size))) << message.name << " cut at " << size;
  }
}

/// Calls visit(value) for each value below `root`, with the value in its place.
void for_each_value(Json& root, const std::function<void(Json&)>& visit) {
  for (auto& child : root) {
    visit(child);
    if (child.is_structured()) for_each_value(child, visit);
  }
}

TEST(ProtocolLines, WrongTypesAndNumbersAreRefusedOrUnderstood) {
  const Json wrong = Json::parse(
      R"([null, true, -1, 0, 1e300, 4294967296, -9223372036854775808, 1.5, "", "x", "\u0000", [], {}, [[]], {"a": 1}, [1, 2, 3, 4, 5]])");
  for (const Message& message : messages()) {
    Json sample = message.good;
    int count = 0;
    for_each_value(sample, [&](Json&) { ++count; });
    for (int place = 0; place < count; ++place) {
      for (const Json& other : wrong) {
        Json spoilt = message.good;
        int at = 0;
        Json* target = nullptr;
        for_each_value(spoilt, [&](Json& value) {
          if (at++ == place) target = &value;
        });
        *target = other;
        SCOPED_TRACE(std::string(message.name) + ": " + spoilt.dump());
        understood(message, spoilt.dump());
      }
    }
    // A member that is not there, and one that is there twice.
    for (const auto& [key, value] : message.good.items()) {
      Json without = message.good;
      without.erase(key);
      understood(message, without.dump());
      const std::string line = message.good.dump();
      understood(message, line.substr(0, line.size() - 1) + ",\"" + key + "\":[]}");
    }
  }
}

TEST(ProtocolLines, RandomBytesAreRefusedOrUnderstood) {
  std::mt19937_64 random(11);
  for (const Message& message : messages()) {
    const std::string whole = message.good.dump();
    int same = 0;
    for (int i = 0; i < 4000; ++i) {
      std::string line = whole;
      for (std::uint64_t n = 1 + random() % 3; n > 0; --n)
        line[random() % line.size()] = static_cast<char>(random());
      same += understood(message, line) ? 1 : 0;
    }
    EXPECT_GT(same, 0) << message.name;  // texts that became other texts
  }
}

TEST(ProtocolLines, LinesThatAreNoMessageAreRefused) {
  using namespace std::string_literals;
  const Message hello = messages()[0];
  std::string deep_list = "{\"a\":", deep_object;
  for (int i = 0; i < 100000; ++i) deep_list += "[", deep_object += "{\"a\":";
  for (const std::string& line :
       {""s, " "s, "\0"s, "{}\0"s, "\xEF\xBB\xBF{"s, "\xFF\xFE{\0}\0"s, "{\"name\": \"\xFF\"}"s,
        "{\"name\": \"\xC0\x80\"}"s, "{}{}"s, "[]"s, "1"s, "null"s, "{\"a\": 1e999}"s, deep_list, deep_object,
        deep_list + std::string(100000, ']') + "}", deep_object + "1" + std::string(100000, '}')})
    EXPECT_FALSE(understood(hello, line)) << line.substr(0, 80);
  // Brackets in texts are no nesting, and a carriage return is space.
  EXPECT_NO_THROW(protocol::parse_line("{\"a\":\"" + std::string(1000, '[') + "\\\"[[\"}\r"));
}

// ---- A worker whose host is not to be trusted

/// Sends lines to the worker; what it answered, line by line. It has to end by itself.
std::vector<Json> answers_to(const std::vector<std::string>& lines, bool end_cut_off = false) {
  const testing::TemporaryFolder folder;
  const std::string in = (folder.path() / "in").string(), out = (folder.path() / "out").string();
  {
    std::ofstream file(in, std::ios::binary);
    for (std::size_t i = 0; i < lines.size(); ++i)
      file << lines[i] << (end_cut_off && i + 1 == lines.size() ? "" : "\n");
  }
  const std::string command =
      std::string("timeout 60 ") + PLUMB_TEST_WORKER + " plumb < " + in + " > " + out + " 2> /dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0) << "it did not end well";
  std::vector<Json> answers;
  std::ifstream file(out);
  for (std::string line; std::getline(file, line);) {
    answers.push_back(Json::parse(line, nullptr, false));
    EXPECT_TRUE(answers.back().is_object()) << line;
  }
  return answers;
}

const std::string kHello = R"({"request": "hello", "protocol": 1})";

std::string load(const std::string& scene, const std::string& settings = R"({"dt": 0.1})") {
  return R"({"request": "load", "scene": )" + scene + R"(, "settings": )" + settings + "}";
}

TEST(ServedWorker, AnswersEveryBadLineWithAnErrorAndGoesOn) {
  using namespace std::string_literals;
  const std::string good = load(R"({"name": "s", "bodies": [{"name": "b", "inertia": 1}]})");
  const std::vector<std::string> bad = {"",
                                        "garbage",
                                        "[]",
                                        "{}",
                                        "\0"s,
                                        "\xFF\xFE",
                                        R"({"request": 1})",
                                        R"({"request": null})",
                                        R"({"request": "walk"})",
                                        R"({"request": "load"})",
                                        load("null"),
                                        load("[]"),
                                        load("{}", "null"),
                                        load("{}", R"({"dt": 0})"),
                                        load("{}", R"({"dt": "x"})"),
                                        load("{}", R"({"dt": 1e300})"),
                                        load("{}", R"({"dt": -1})"),
                                        load("{}", R"({"dt": 0.1, "substeps": 1e300})"),
                                        load("{}", R"({"dt": 0.1, "substeps": 0})"),
                                        load(R"({"bodies": [{"name": "b", "mass": -1}]})"),
                                        load(R"({"bodies": 7})"),
                                        load(std::string(100000, '[') + std::string(100000, ']')),
                                        R"({"request": "run", "samples": 1, "every": 1})",
                                        R"({"request": "run"})",
                                        std::string(100000, '{'),
                                        good.substr(0, good.size() / 2)};
  std::vector<std::string> lines = bad;
  lines.push_back(good);
  lines.push_back(R"({"request": "run", "samples": "x", "every": 1})");
  lines.push_back(R"({"request": "run", "samples": 2, "every": 1})");
  lines.push_back(kHello + "\r");
  const std::vector<Json> answers = answers_to(lines);
  ASSERT_EQ(answers.size(), bad.size() + 6);
  for (std::size_t i = 0; i < bad.size(); ++i)
    EXPECT_TRUE(answers[i].contains("error")) << bad[i].substr(0, 200) << "\n" << answers[i].dump();
  const Json* next = &answers[bad.size()];
  EXPECT_TRUE(next[0].contains("effective_settings")) << next[0].dump();
  EXPECT_TRUE(next[1].contains("error"));
  EXPECT_TRUE(next[2].contains("t") && next[3].contains("t") && next[4].contains("done"));
  EXPECT_EQ(next[5]["protocol"], 1);
}

TEST(ServedWorker, EndsWithItsInput) {
  EXPECT_TRUE(answers_to({}).empty());
  EXPECT_EQ(answers_to({kHello, R"({"request": "quit"})", kHello}).size(), 1u);
  EXPECT_EQ(answers_to({kHello, kHello.substr(0, 20)}, true).size(), 2u);
  EXPECT_EQ(answers_to({std::string(1 << 22, 'x')}, true).size(), 1u);
}

}  // namespace
}  // namespace plumb::reference
