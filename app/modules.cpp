#include "app/modules.h"

#include <cstdlib>
#include <string>
#include <string_view>

#include <dlfcn.h>

#include "engine/scene/error.h"
#include "harness/environment.h"

namespace plumb::app {
namespace {

// A module's scenarios register themselves when it is loaded. It stays until the program ends.
void load(const std::string& path) {
  // Without a slash the system's folders would be searched.
  const std::string place = path.find('/') == std::string::npos ? "./" + path : path;
  void* const module = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) {
    const char* const problem = dlerror();
    throw Error(Error::Kind::Io, "PLUMB_SCENARIOS", "", path,
                std::string("cannot be loaded: ") + (problem == nullptr ? "" : problem));
  }
  using Version = const char* (*)();
  const auto version = reinterpret_cast<Version>(dlsym(module, "plumb_scenarios_version"));
  if (version == nullptr || harness::version() != std::string_view(version())) {
    throw Error(Error::Kind::Unsupported, "PLUMB_SCENARIOS", "", path,
                "was not built by plumb_add_scenarios of version " + std::string(harness::version()));
  }
}

}  // namespace

void load_scenario_modules() {
  const char* const named = std::getenv("PLUMB_SCENARIOS");
  std::string_view rest = named == nullptr ? "" : named;
  while (!rest.empty()) {
    const std::size_t end = rest.find(':');
    if (end != 0) load(std::string(rest.substr(0, end)));
    rest.remove_prefix(end == rest.npos ? rest.size() : end + 1);
  }
}

}  // namespace plumb::app
