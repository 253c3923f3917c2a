#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reference/backend.h"

/// Engines from npm, run by Node over docs/protocol.md: one script an engine in reference/node. They are
/// guests (guests.h), run when asked for by name, in any version that is installed.
namespace plumb::reference {

/// A script, as the lines at its top describe it.
struct NodeEngine {
  std::string name;     ///< "rapier", after its file
  std::string package;  ///< npm's name
  std::string version;  ///< that `plumb engines --install NAME` takes
  std::string script;   ///< path
};

/// Returns every script of the folder PLUMB_NODE_SCRIPTS, of `../share/plumb/node` beside the program, or of
/// the checkout that the program was built in; by name.
std::vector<NodeEngine> node_engines();

/// Folder that versions are installed into: PLUMB_ENGINES, else `plumb/engines` in XDG_DATA_HOME or
/// ~/.local/share.
std::string engines_folder();

/// Returns the folder of one version of an engine, installed or not.
std::string folder_of(const NodeEngine& engine, const std::string& version);

/// Returns the versions of an engine that are installed, oldest first.
std::vector<std::string> installed_versions(const NodeEngine& engine);

/// Returns true if `a` is an older version than `b`, by their numbers.
bool older(std::string_view a, std::string_view b);

}  // namespace plumb::reference
