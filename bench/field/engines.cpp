#include "bench/field/engines.h"

#include <vector>

#include "bench/field/adapters.h"

namespace plumb::field {

std::span<const Engine> engines() {
  static const std::vector<Engine> all{
#ifdef PLUMB_FIELD_BOX2D
      {"box2d", PLUMB_FIELD_BOX2D, "", create_box2d},
#else
      {"box2d", "2.4", "install libbox2d-dev and build again", nullptr},
#endif
#ifdef PLUMB_FIELD_BOX2D_V3
      {"box2d-v3", PLUMB_BOX2D_V3_VERSION, "", create_box2d_v3},
#else
      {"box2d-v3", "3", "find_package(box2d 3) found none; docs/adding-an-engine.md builds it", nullptr},
#endif
#ifdef PLUMB_FIELD_CHIPMUNK
      {"chipmunk", chipmunk_version(), "", create_chipmunk},
#else
      {"chipmunk", "7", "install libchipmunk-dev and build again", nullptr},
#endif
#ifdef PLUMB_FIELD_PLUMB
      {"plumb", PLUMB_FIELD_PLUMB, "", create_plumb, plumb_solvers(), "", true},
#else
      {"plumb", "", "this checkout has no engine/world/world.h", nullptr},
#endif
  };
  return all;
}

Engine with_solver(const Engine& engine, const std::string& solver) {
  Engine out = engine;
  out.name += ":" + solver;
  out.solver = solver;
  return out;
}

Engine with_threads(const Engine& engine, int threads) {
  Engine out = engine;
  if (threads > 1) out.name += ":" + std::to_string(threads);
  out.threads = threads;
  return out;
}

}  // namespace plumb::field
