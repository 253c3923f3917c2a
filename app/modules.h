#pragma once

namespace plumb::app {

/// Loads the modules of scenarios that the environment's PLUMB_SCENARIOS names, paths with ':' between them.
/// Throws Error (Io) for one that cannot be loaded, (Unsupported) for one of another version.
void load_scenario_modules();

}  // namespace plumb::app
