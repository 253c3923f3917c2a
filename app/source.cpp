#include "app/source.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/output.h"
#include "app/usage.h"
#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "harness/case_file/case_file.h"
#include "harness/text_file.h"

namespace plumb::app {
namespace {

std::string read_file(const std::string& path) {
  if (path == "-") return harness::read_text(std::cin, "standard input");
  return harness::read_text(path, "give a scene as JSON, like `plumb scene NAME` prints");
}

// Returns the duration of a scene from a file: that of the scenario with the same name, if there is one.
double duration_of(const Scene& scene, double otherwise) {
  try {
    return scenarios::select(scene.name).front().build().duration;
  } catch (const Error&) {
    return otherwise;
  }
}

}  // namespace

void add_size(CLI::App& command, int& size) {
  command.add_option("--size", size, "size, if the scenario has sizes")
      ->type_name("N")
      ->check([](const std::string& text) -> std::string {
        int number = 0;
        const bool whole = CLI::detail::lexical_cast(text, number);
        return whole && number > 0 ? ""
                                   : fmt::format("'{}' is not a size; give a whole number above 0", text);
      });
}

scenarios::Instance one_instance(const std::string& name, int size) {
  const std::vector<scenarios::Instance> members = scenarios::select(name, size);
  if (members.size() > 1) {
    std::string others;
    for (const auto& member : members) others += (others.empty() ? "" : ", ") + member.label();
    notice(fmt::format("'{}' has {} scenes: {}; the first is used", name, members.size(), others));
  }
  return members.front();
}

bool is_file(const std::string& text) {
  std::error_code code;
  return text == "-" || text.ends_with(".json") || std::filesystem::is_regular_file(text, code) ||
         text.starts_with("/") || text.starts_with("./") || text.starts_with("../");
}

void add_file_duration(CLI::App& command, std::string& duration) {
  command
      .add_option(
          "--duration", duration,
          "duration in s of a scene from a file, rounded to whole steps (default: its scenario's, else 10)")
      ->type_name("T")
      ->check([](const std::string& text) -> std::string {
        try {
          parse_positive("--duration", text);
          return "";
        } catch (const UsageError&) {
          return fmt::format("'{}' is not a time; give a number of seconds above 0", text);
        }
      });
}

scenarios::Instance file_instance(const std::string& path, const std::string& duration,
                                  std::vector<std::unique_ptr<scenarios::Scenario>>& kept) {
  if (harness::case_file::is_case(path)) {
    if (!duration.empty())
      throw UsageError("--duration needs a scene file: a case file has its own duration");
    return harness::case_file::case_instance(path);
  }
  Source source = load(path, 0);
  if (!duration.empty()) source.duration = parse_positive("--duration", duration);
  auto scenario = std::make_unique<scenarios::Scenario>();
  scenario->name = source.scene.name.empty() ? path : source.scene.name;
  scenario->summary = "from the file " + plumb::quoted(path);
  scenario->build = [source](std::string_view, int) {
    return scenarios::Problem{.scene = source.scene, .duration = source.duration};
  };
  kept.push_back(std::move(scenario));
  return {kept.back().get(), "", 1};
}

namespace {

/// Reads the scene of a file. Errors are prefixed by the file's name, because there may be several files.
Scene scene_in(const std::string& path) {
  const std::string text = read_file(path);
  try {
    return scene_from_json(text);
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("file '{}': {}", path, error.subject()), error.field(),
                error.value(), error.problem(), error.line());
  }
}

}  // namespace

Source load(const std::string& name_or_file, int size) {
  if (!is_file(name_or_file)) {
    const scenarios::Instance instance = one_instance(name_or_file, size);
    scenarios::Problem problem = instance.build();
    return {std::move(problem.scene), problem.duration, instance};
  }
  if (size > 0)
    throw Error(Error::Kind::Value, "--size", "", std::to_string(size),
                "needs the name of a scenario, not a file");
  if (harness::case_file::is_case(name_or_file)) {
    harness::case_file::CaseFile file = harness::case_file::read_case(name_or_file);
    return {std::move(file.problem.scene), file.problem.duration, {}};
  }
  Source source;
  source.scene = scene_in(name_or_file);
  source.duration = duration_of(source.scene, source.duration);
  return source;
}

}  // namespace plumb::app
