// Every subcommand that reads a file, with every bad file.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/app/program.h"

namespace plumb::app {
namespace {

/// Texts that are no scene, and no results either.
std::map<std::string, std::string> bad_files() {
  using namespace std::string_literals;
  std::mt19937 random(5);
  std::string bytes;
  for (int i = 0; i < 10000; ++i) bytes += static_cast<char>(random());
  const std::string scene = "{\"name\": \"s\", \"bodies\": [{\"name\": \"b\", \"inertia\": 1}]}";
  return {{"empty", ""},
          {"white", " \r\n\t\n"},
          {"zero bytes", std::string(1000, '\0')},
          {"zero byte within", "{\"name\": \"a\0b\"}"s},
          {"byte order mark", "\xEF\xBB\xBF" + scene},
          {"two byte characters", "\xFF\xFE{\0}\0"s},
          {"not UTF-8", "{\"name\": \"\xC0\x80\"}"},
          {"random", bytes},
          {"deep", std::string(100000, '[')},
          {"deep and closed", std::string(100000, '[') + std::string(100000, ']')},
          {"cut off", scene.substr(0, scene.size() / 2)},
          {"twice", scene + "\r\n" + scene},
          {"a key twice", "{\"name\": \"s\", \"name\": \"s\"}"},
          {"an unknown key", "{\"nmae\": \"s\"}"},
          {"not finite", "{\"gravity\": [0, NaN]}"},
          {"huge", "{\"gravity\": [0, 1e400]}"},
          {"wrong type", "{\"bodies\": 7}"},
          {"a list", "[1, 2, 3]"}};
}

TEST(Files, BadScenesAreRefusedInOneLineByAllThatReadThem) {
  const Folder folder;
  for (const std::string subcommand : {"run", "explain", "scene", "compare", "sweep", "tune", "view"}) {
    if (plumb({subcommand, "--help"}).code != 0) continue;
    int number = 0;
    for (const auto& [name, text] : bad_files()) {
      const std::string file = folder.write("bad" + std::to_string(number++) + ".json", text);
      std::vector<std::string> arguments{subcommand, file};
      if (subcommand == "tune") arguments.insert(arguments.end(), {"--tolerance", "1e-3"});
      if (subcommand == "compare" || subcommand == "sweep")
        arguments.insert(arguments.end(), {"--out", folder.path("out")});
      if (subcommand == "view") arguments.push_back("--headless");
      expect_refused(plumb(arguments), subcommand + " of a file that is " + name);
    }
  }
}

TEST(Files, BadScenesOnStandardInputAreRefusedInOneLine) {
  for (const auto& [name, text] : bad_files()) expect_refused(plumb({"run", "-"}, {}, text), name);
}

TEST(Files, BadResultsAreRefusedInOneLine) {
  const Folder folder;
  for (const auto& [name, text] : bad_files()) {
    if (name == "empty" || name == "white") continue;  // results that nothing has come of yet
    const std::string file = folder.write("results.jsonl", text + "\n{\n");
    expect_refused(plumb({"front", file}), "front: " + name);
    expect_refused(plumb({"report", file, "--out", folder.path("report.html")}), "report: " + name);
    expect_refused(plumb({"compare", file, file}), "compare: " + name);
  }
}

}  // namespace
}  // namespace plumb::app
