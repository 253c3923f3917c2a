#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reference/backend.h"

/// Engines from npm, run by Node over docs/protocol.md: one script per engine in reference/node. They are
/// guests (guests.h) and run when they are asked for by name, in any installed version.
namespace plumb::reference {

/// A script, as described by the lines at its top.
struct NodeEngine {
  std::string name;     ///< "rapier", after its file
  std::string package;  ///< npm's name
  std::string version;  ///< the version that `plumb engines --install NAME` installs
  std::string script;   ///< path
};

/// Returns every script in the folder PLUMB_NODE_SCRIPTS, in `../share/plumb/node` next to the program, or in
/// the checkout from which the program was built; by name.
std::vector<NodeEngine> node_engines();

/// Returns the folder into which versions are installed: PLUMB_ENGINES, else `plumb/engines` in XDG_DATA_HOME
/// or ~/.local/share.
std::string engines_folder();

/// Returns the folder of one version of an engine, installed or not.
std::string folder_of(const NodeEngine& engine, const std::string& version);

/// Returns the versions of an engine that are installed, oldest first.
std::vector<std::string> installed_versions(const NodeEngine& engine);

/// Returns true if `a` is an older version than `b`, by their numbers.
bool older(std::string_view a, std::string_view b);

}  // namespace plumb::reference
