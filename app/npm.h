#pragma once

#include <string>
#include <vector>

#include "reference/node_engines.h"

namespace plumb::app {

/// Returns the engine and version that "rapier" or "rapier@0.19.3" names, and the script's version where none
/// is given. Throws `UsageError` for an unknown engine or a text that is no version.
struct NamedVersion {
  reference::NodeEngine engine;
  std::string version;
};
NamedVersion named_version(const std::string& text);

/// Installs one version with npm, without its install scripts, into `reference::folder_of`; nothing if it is
/// there. What npm says goes to stderr. Throws `Error` (Io) if there is no npm or it fails; nothing is then
/// left behind.
void install(const NamedVersion& wanted);

/// Returns the released versions that npm knows of a package, oldest first. Throws `Error` (Io).
std::vector<std::string> published_versions(const reference::NodeEngine& engine);

}  // namespace plumb::app
