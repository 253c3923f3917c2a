#pragma once

#include <memory>
#include <string>
#include <vector>

#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace CLI {
class App;
}

namespace plumb::app {

/// Options that select engines, as given.
struct EngineOptions {
  std::vector<std::string> names;     ///< --engine; none: all
  std::vector<std::string> commands;  ///< --engine-command, "NAME=COMMAND"

  void add_to(CLI::App& command);
};

/// Adds --engine-command alone.
void add_engine_command(CLI::App& command, std::vector<std::string>& commands);

/// Returns the programs of --engine-command, "NAME=COMMAND" each. Throws `UsageError`.
std::vector<std::unique_ptr<reference::Backend>> programs_of(const std::vector<std::string>& commands);

/// Returns the engine named `name`: one of `programs`, or one that is built in. An empty name means the first
/// of the programs, or plumb. Throws `Error`.
const reference::Backend& one_engine(const std::string& name,
                                     const std::vector<std::unique_ptr<reference::Backend>>& programs);

/// Adds to the reason for which an engine refuses a scene the first engine of plumb's own that runs it,
/// unless the reason names one or there is none.
std::string with_alternative(const std::string& reason, const Scene& scene);

/// Returns the case files that `name` means: itself, or those in the folder; empty if it means none.
std::vector<std::string> case_files(const std::string& name);

/// Returns the instances that `wanted` names, or all: scenarios, case files and folders of them. `size` > 0
/// overrides the sizes of scenarios. Throws `UsageError`, `Error`.
std::vector<scenarios::Instance> chosen_instances(const std::vector<std::string>& wanted, int size);

/// Returns the selected engines, or all; programs given with --engine-command come last and are kept in
/// `programs`. Throws `UsageError`, `Error`.
std::vector<const reference::Backend*> chosen_engines(
    const EngineOptions& options, std::vector<std::unique_ptr<reference::Backend>>& programs);

}  // namespace plumb::app
