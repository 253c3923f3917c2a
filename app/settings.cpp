#include "app/settings.h"

#include <fmt/format.h>

#include "app/usage.h"

namespace plumb::app {

void SettingsOptions::add_to(CLI::App& command) {
  command
      .add_option("--dt", dt,
                  "step in s, like 0.01 or 1/240 (default 1/60); for an adaptive engine the sampling grid")
      ->type_name("DT");
  command.add_option("--substeps", substeps, "substeps per step")->type_name("N");
  command.add_option("--tolerance", tolerance, "tolerance of an adaptive engine, like 1e-9")->type_name("X");
  command.add_option("--set", set, "an engine's own option, see `plumb engines`; may be repeated")
      ->type_name("OPTION=VALUE")
      ->allow_extra_args(false);
}

reference::StepSettings SettingsOptions::settings(const reference::Backend& backend) const {
  reference::StepSettings settings;
  if (!dt.empty()) settings.dt = parse_positive("--dt", dt);
  if (!tolerance.empty()) settings.tolerance = parse_positive("--tolerance", tolerance);
  if (substeps && *substeps < 1)
    throw UsageError(fmt::format("--substeps is '{}': give a whole number from 1", *substeps));
  settings.substeps = substeps;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError(
          fmt::format("--set is '{}': give OPTION=VALUE, see `plumb engines` for the options", text));
    settings.options[text.substr(0, equals)] = text.substr(equals + 1);
  }
  backend.method(settings);  // throws for settings that the engine rejects
  return settings;
}

}  // namespace plumb::app
