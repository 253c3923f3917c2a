#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "reference/backend.h"

namespace plumb::app {

/// Options for an engine's step settings, as given.
struct SettingsOptions {
  std::string dt, tolerance;
  std::optional<int> substeps;
  std::vector<std::string> set;  ///< "option=value"

  void add_to(CLI::App& command);

  /// Throws `UsageError` or `Error` for settings that `backend` rejects.
  reference::StepSettings settings(const reference::Backend& backend) const;
};

}  // namespace plumb::app
