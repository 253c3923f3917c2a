#pragma once

#include <string>
#include <vector>

#include "reference/node_engines.h"

namespace plumb::app {

/// Returns the engine and version that "rapier@0.19.3" or "rapier" (with the script's default version) names.
/// Throws `UsageError` for an unknown engine or an invalid version.
struct NamedVersion {
  reference::NodeEngine engine;
  std::string version;
};
NamedVersion named_version(const std::string& text);

/// Installs one version with npm, without its install scripts, into `reference::folder_of`; does nothing if
/// it is installed. npm's output goes to stderr. Throws `Error` (Io) if npm is missing or fails; nothing is
/// left behind then.
void install(const NamedVersion& wanted);

/// Returns the released versions of a package that npm knows, oldest first. Throws `Error` (Io).
std::vector<std::string> published_versions(const reference::NodeEngine& engine);

}  // namespace plumb::app
