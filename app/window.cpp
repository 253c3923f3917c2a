#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include "app/commands.h"
#include "engine/scene/error.h"

namespace plumb::app {
namespace {

constexpr const char* kMissing =
    "this build has no window: install libimgui-dev libsdl2-dev libpng-dev and configure again with "
    "-DPLUMB_WINDOW=ON (./plumb demo does all that)";

}  // namespace

void add_window(CLI::App& app) {
  app.add_subcommand("demo", "play the demos of the course in a window")->prefix_command();
  app.add_subcommand("view", "show a scenario or a scene in a window, beside its truth and other engines")
      ->prefix_command();
}

int run_window(int, char** argv) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plumb_window";
  const std::string name = program.string();
  execv(name.c_str(), argv);
  const std::string subject = "program '" + name + "'";
  if (errno == ENOENT)
    throw Error(Error::Kind::Io, subject, "", "", std::string("is not there; ") + kMissing);
  throw Error(Error::Kind::Io, subject, "", "", std::string("cannot be started: ") + std::strerror(errno));
}

}  // namespace plumb::app
