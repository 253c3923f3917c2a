// Every option of every subcommand that `--help` lists, with every bad value: new ones are tried as soon as
// the help names them.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "tests/app/program.h"

namespace plumb::app {
namespace {

/// The subcommands that the help names.
std::vector<std::string> subcommands() {
  std::vector<std::string> names;
  bool there = false;
  for (const std::string& line : lines_of(plumb({"--help"}).out)) {
    static const std::regex kName("  ([a-z]+) +\\S.*");
    std::smatch match;
    if (there && std::regex_match(line, match, kName)) names.push_back(match[1]);
    if (line == "Subcommands:") there = true;
    if (line.empty()) there = false;
  }
  return names;
}

struct Option {
  std::string name, type;
};

/// The options of a subcommand that take a value, as its help lists them.
std::vector<Option> options_of(const std::string& subcommand) {
  std::vector<Option> options;
  for (const std::string& line : lines_of(plumb({subcommand, "--help"}).out)) {
    static const std::regex kOption("  (--[a-z-]+) ([A-Z]\\S*)( .*)?");
    std::smatch match;
    if (std::regex_match(line, match, kOption)) options.push_back({match[1], match[2]});
  }
  return options;
}

/// Completes a subcommand, so that the bad value is all that is wrong.
std::vector<std::string> complete(const std::string& subcommand, const std::string& option,
                                  const Folder& folder) {
  static const std::map<std::string, std::vector<std::string>> kRest{
      {"explain", {"free_fall/vacuum"}},
      {"run", {"free_fall/vacuum"}},
      {"scene", {"pendulum_chain"}},
      {"compare", {"free_fall/vacuum"}},
      {"check", {"--engine", "plumb"}},
      {"sweep", {"free_fall/vacuum"}},
      {"tune", {"free_fall/vacuum"}},
      {"submit", {"work", "--on", "local"}},
      {"work", {"work", "--next"}},
      {"gather", {"work"}},
      {"status", {"work"}},
      {"demo", {"bouncing_ball", "--headless"}},
      {"view", {"free_fall/vacuum", "--headless"}}};
  std::vector<std::string> arguments{subcommand};
  if (const auto rest = kRest.find(subcommand); rest != kRest.end())
    arguments.insert(arguments.end(), rest->second.begin(), rest->second.end());
  if (subcommand == "tune" && option != "--tolerance" && option != "--cost-us")
    arguments.insert(arguments.end(), {"--tolerance", "1e-3"});
  for (const Option& each : options_of(subcommand)) {
    if (each.name == "--out" && option != "--out")
      arguments.insert(arguments.end(), {"--out", folder.path("out")});
  }
  return arguments;
}

bool is_number(const std::string& type) {
  static const std::set<std::string> kNumbers{"N", "X", "T", "S", "HZ", "US", "DT", "INT", "FLOAT", "UINT"};
  return kNumbers.count(type.substr(0, type.find(':'))) > 0;
}

// A length of a step is written alike wherever it is given.
TEST(Options, AnOptionHasOneTypeInEverySubcommand) {
  std::map<std::string, std::map<std::string, std::string>> types;  // option, type: a subcommand
  for (const std::string& subcommand : subcommands()) {
    if (plumb({subcommand, "--help"}).code != 0) continue;
    for (const Option& option : options_of(subcommand)) {
      types[option.name][option.type.substr(0, option.type.find(':'))] = subcommand;
    }
  }
  for (const std::string option : {"--dt", "--duration", "--budget", "--timeout", "--substeps"}) {
    EXPECT_EQ(types[option].size(), 1u) << option << " of " << types[option].begin()->second << " and others";
  }
}

TEST(Options, BadNumbersAreRefusedInOneLine) {
  const std::vector<std::string> bad{"nan", "-inf", "-1",  "1e400", "1/0", "",
                                     "abc", "1x",   "1,5", "0x",    "\xFF"};
  constexpr int kOfEach = 4;  // in turn: all of them for each option take 40 s
  int tried = 0;
  std::set<std::string> met;
  for (const std::string& subcommand : subcommands()) {
    // Without the window's libraries there is no such program.
    if (plumb({subcommand, "--help"}).code != 0) continue;
    for (const Option& option : options_of(subcommand)) {
      if (!is_number(option.type)) continue;
      met.insert(option.name);
      const Folder folder;
      const std::vector<std::string> rest = complete(subcommand, option.name, folder);
      for (int i = 0; i < kOfEach; ++i) {
        const std::string& value = bad[static_cast<std::size_t>(tried) % bad.size()];
        std::vector<std::string> arguments = rest;
        arguments.push_back(option.name + "=" + value);
        expect_refused(plumb(arguments), subcommand + " " + option.name + "='" + value + "'");
        ++tried;
      }
    }
  }
  EXPECT_GE(met.size(), 8u) << "the help was not understood";
  EXPECT_GT(tried, 100);
}

TEST(Options, ChoicesThatThereAreNotAreRefusedInOneLine) {
  const std::vector<std::string> bad{"", "x", "nan", "jso n", "\xFF", "../../etc"};
  constexpr int kOfEach = 3;  // in turn
  int tried = 0;
  for (const std::string& subcommand : subcommands()) {
    if (plumb({subcommand, "--help"}).code != 0) continue;
    for (const Option& option : options_of(subcommand)) {
      if (option.type.find(":{") == std::string::npos && option.name != "--engine") continue;
      const Folder folder;
      for (int i = 0; i < kOfEach; ++i) {
        const std::string& value = bad[static_cast<std::size_t>(tried) % bad.size()];
        std::vector<std::string> arguments = complete(subcommand, option.name, folder);
        if (subcommand == "check" && option.name == "--engine") arguments = {"check"};
        arguments.push_back(option.name + "=" + value);
        expect_refused(plumb(arguments), subcommand + " " + option.name + "='" + value + "'");
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 40);
}

}  // namespace
}  // namespace plumb::app
