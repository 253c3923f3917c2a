#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "reference/backend.h"

namespace plumb::app {

/// The options that say how an engine is to step, as they were given.
struct SettingsOptions {
  std::string dt, tolerance;
  std::optional<int> substeps;
  std::vector<std::string> set;  ///< "option=value"

  void add_to(CLI::App& command);

  /// Throws `UsageError` or `Error` for what `backend` cannot take.
  reference::StepSettings settings(const reference::Backend& backend) const;
};

}  // namespace plumb::app
