#include "app/selection.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/command_line.h"
#include "app/usage.h"
#include "harness/case_file/case_file.h"
#include "harness/text_file.h"
#include "reference/guests.h"
#include "reference/process_backend.h"

namespace plumb::app {

void EngineOptions::add_to(CLI::App& command) {
  command
      .add_option("--engine", names,
                  "engines, separated by commas, with @VERSION for those from npm; linked: all native ones; "
                  "all: also those from npm")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("E");
  add_engine_command(command, commands);
}

void add_engine_command(CLI::App& command, std::vector<std::string>& commands) {
  command
      .add_option("--engine-command", commands,
                  "add an engine: a program that speaks the line protocol (docs/protocol.md); may be "
                  "repeated. --engine then selects it by its NAME")
      ->allow_extra_args(false)
      ->type_name("NAME=COMMAND");
}

std::vector<std::unique_ptr<reference::Backend>> programs_of(const std::vector<std::string>& commands) {
  std::vector<std::unique_ptr<reference::Backend>> out;
  for (const std::string& text : commands) {
    const std::size_t equals = text.find('=');
    const std::vector<std::string> command =
        equals == std::string::npos ? std::vector<std::string>{} : split_command(text.substr(equals + 1));
    if (equals == 0 || command.empty())
      throw UsageError(
          fmt::format("--engine-command is '{}': give NAME=COMMAND, see docs/protocol.md", text));
    const std::string name = text.substr(0, equals);
    std::vector<const reference::Backend*> others = reference::backends();
    for (const auto& program : out) others.push_back(program.get());
    for (const reference::Backend* other : others)
      if (other->name() == name)
        throw UsageError(
            fmt::format("--engine-command: there is an engine '{}' already; choose another name", name));
    out.push_back(reference::make_process_backend(name, command));
    if (const reference::Identity identity = out.back()->identity(); !identity.available)
      throw UsageError(fmt::format("--engine-command {}: {}", text, identity.reason));
  }
  return out;
}

const reference::Backend& one_engine(const std::string& name,
                                     const std::vector<std::unique_ptr<reference::Backend>>& programs) {
  if (name.empty() && !programs.empty()) return *programs.front();
  for (const auto& program : programs)
    if (program->name() == name) return *program;
  return reference::find_backend(name.empty() ? "plumb" : name);
}

std::string with_alternative(const std::string& reason, const Scene& scene) {
  if (reason.find("'plumb") != std::string::npos) return reason;
  for (const char* name : {"plumb", "plumb-precise"})
    if (reference::find_backend(name).unsupported(scene, {}).empty())
      return fmt::format("{}; '{}' runs it", reason, name);
  return reason;
}

namespace {

/// Returns true if --engine-command defines the engine.
bool is_given(const std::vector<std::string>& commands, const std::string& name) {
  return std::any_of(commands.begin(), commands.end(),
                     [&](const std::string& text) { return text.starts_with(name + '='); });
}

}  // namespace

std::vector<std::string> case_files(const std::string& name) {
  if (harness::case_file::is_case(name)) return {name};
  // Says why a case file cannot be read, instead of taking its name for that of a scenario or family.
  if (name.ends_with(".json")) harness::read_text(name);
  return harness::case_file::cases_in(name);
}

namespace {

// Results and reports identify a case by its name.
void append_case(const std::string& file, std::vector<scenarios::Instance>& out) {
  scenarios::Instance instance = harness::case_file::case_instance(file);
  for (const scenarios::Instance& other : out)
    if (other.label() == instance.label())
      throw UsageError(
          fmt::format("'{}': another case is also named '{}'; rename one", file, instance.label()));
  out.push_back(std::move(instance));
}

}  // namespace

std::vector<scenarios::Instance> chosen_instances(const std::vector<std::string>& wanted, int size) {
  std::vector<scenarios::Instance> out;
  const auto append = [&](const std::string& name) {
    if (const std::vector<std::string> files = case_files(name); !files.empty()) {
      if (size > 0) throw UsageError(fmt::format("--size needs the name of a scenario, not '{}'", name));
      for (const std::string& file : files) append_case(file, out);
      return;
    }
    for (scenarios::Instance& instance : scenarios::select(name, size)) out.push_back(std::move(instance));
  };
  for (const std::string& name : wanted) append(name);
  if (!wanted.empty()) return out;
  for (const scenarios::Scenario& scenario : scenarios::all())
    if (size == 0 || scenario.scales) append(scenario.name);
  if (out.empty()) throw UsageError("--size is given, but none of the scenarios has sizes");
  return out;
}

std::vector<const reference::Backend*> chosen_engines(
    const EngineOptions& options, std::vector<std::unique_ptr<reference::Backend>>& programs) {
  std::vector<const reference::Backend*> out;
  for (const std::string& name : options.names) {
    if (is_given(options.commands, name)) continue;  // added below
    if (name == "all" || name == "linked") {
      std::vector<const reference::Backend*> list = reference::backends();
      for (const reference::Backend* guest : name == "all" ? reference::guests() : reference::linked_guests())
        if (name == "all" || !guest->name().ends_with("-default")) list.push_back(guest);
      for (const reference::Backend* each : list)
        if (std::find(out.begin(), out.end(), each) == out.end()) out.push_back(each);
      continue;
    }
    const reference::Backend* backend = &reference::find_backend(name);
    if (std::find(out.begin(), out.end(), backend) == out.end()) out.push_back(backend);
  }
  if (options.names.empty()) out = reference::backends();
  for (auto& program : programs_of(options.commands)) {
    programs.push_back(std::move(program));
    out.push_back(programs.back().get());
  }
  return out;
}

}  // namespace plumb::app
