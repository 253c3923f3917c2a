#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reference/backend.h"

namespace plumb::harness::stress {

/// A documented way to run an engine: "default", or one for extremes.
struct Setting {
  std::string name{};
  std::string summary{};
  std::optional<int> substeps{};
  std::optional<double> tolerance{};
  std::map<std::string, std::string> options{};

  reference::StepSettings with(double dt) const;
};

/// Returns "default" first, then the settings for extremes: for plumb's engines those of docs/stress.md, for
/// the others a quarter of the step with four times the iterations. Options that an engine lacks are left
/// out.
std::vector<Setting> settings_of(const reference::Backend& backend);

}  // namespace plumb::harness::stress
