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

/// A scene to run, and for how long if nothing else is said.
struct Source {
  Scene scene;
  double duration = 10;                           ///< s
  std::optional<scenarios::Instance> instance{};  ///< of a scenario, that the scene is
};

/// Adds --size: how large a scenario that scales is.
void add_size(CLI::App& command, int& size);

/// The one instance that `name` means. Where it means several, the first, with a word about the others on
/// stderr.
scenarios::Instance one_instance(const std::string& name, int size);

/// Adds --duration, which only scenes from files take.
void add_file_duration(CLI::App& command, std::string& duration);

/// Whether `text` means a file and no scenario: what exists as a file, ends in ".json", starts with "/", "./"
/// or "../", or is "-".
bool is_file(const std::string& text);

/// The scene of a file as an instance without a known answer, kept in `kept`. `duration` is the option's
/// text; empty: as long as the scenario whose name it bears, else 10 s. Throws `Error`, `UsageError`.
scenarios::Instance file_instance(const std::string& path, const std::string& duration,
                                  std::vector<std::unique_ptr<scenarios::Scenario>>& kept);

/// A scenario by name, or a scene from a file ("-": stdin). A file is what exists as one, has a '/' before a
/// name that is no scenario's, or ends in ".json". A scene that bears a scenario's name runs as long as that
/// does. Throws `Error`.
Source load(const std::string& name_or_file, int size);

}  // namespace plumb::app
