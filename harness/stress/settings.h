#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reference/backend.h"

namespace plumb::harness::stress {

/// A way to run an engine that its users are told of: "default", or one for extremes.
struct Setting {
  std::string name{};
  std::string summary{};
  std::optional<int> substeps{};
  std::optional<double> tolerance{};
  std::map<std::string, std::string> options{};

  reference::StepSettings with(double dt) const;
};

/// "default" first, then those for extremes: of plumb's engines as docs/stress.md advises, of the others a
/// quarter of the step with four times the sweeps. What an engine does not know is not among them.
std::vector<Setting> settings_of(const reference::Backend& backend);

}  // namespace plumb::harness::stress
