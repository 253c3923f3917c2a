#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "scenarios/scenario.h"

namespace CLI {
class App;
}

namespace plumb::app {

/// A scene to run, with its default duration.
struct Source {
  Scene scene;
  double duration = 10;                           ///< s
  std::optional<scenarios::Instance> instance{};  ///< of the scenario that the scene belongs to
};

/// Adds --size, the size of a scenario that scales.
void add_size(CLI::App& command, int& size);

/// Returns the instance that `name` selects. If it selects several, returns the first and names the others on
/// stderr.
scenarios::Instance one_instance(const std::string& name, int size);

/// Adds --duration, which applies only to scenes from files.
void add_file_duration(CLI::App& command, std::string& duration);

/// Returns true if `text` means a file instead of a scenario: it is an existing file or "-", ends in ".json",
/// or starts with "/", "./" or "../".
bool is_file(const std::string& text);

/// Returns the scene of a file as an instance without a known answer, kept in `kept`. `duration` is the
/// option's text; if empty, that of the scenario with the same name, else 10 s. Throws `Error`, `UsageError`.
scenarios::Instance file_instance(const std::string& path, const std::string& duration,
                                  std::vector<std::unique_ptr<scenarios::Scenario>>& kept);

/// Loads a scenario by name, or a scene from a file, as `is_file` decides ("-": stdin). A file's scene with a
/// scenario's name takes that scenario's duration. Throws `Error`.
Source load(const std::string& name_or_file, int size);

}  // namespace plumb::app
