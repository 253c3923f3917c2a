// JSON as scenes: what can be read is valid, is written and read back as the same scene, and runs, in a
// simulation and in a world; what cannot is refused with a typed error.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "engine/scene/validate.h"
#include "engine/simulation/simulation.h"
#include "engine/world/add_scene.h"
#include "engine/world/scene/scene_forces.h"
#include "tests/fuzz/support/require.h"
#include "tests/fuzz/support/world_checks.h"

namespace plumb::fuzz {
namespace {

constexpr int kSteps = 3, kMostSubsteps = 1000;
constexpr std::size_t kMostParts = 30;  // of scenes that are run: milliseconds each

bool is_finite(const BodyState& state) {
  return std::isfinite(state.position.x) && std::isfinite(state.position.y) && std::isfinite(state.angle) &&
         std::isfinite(state.velocity.x) && std::isfinite(state.velocity.y) &&
         std::isfinite(state.angular_velocity);
}

void check_round_trip(const Scene& scene) {
  try {
    validate(scene);
    for (const int indent : {2, -1}) {
      const Scene again = scene_from_json(to_json(scene, indent));
      require(again == scene && hash(again) == hash(scene), "a scene that is written reads back the same");
    }
  } catch (const Error& error) {
    fail("a scene that was read can be written and read", error.what());
  }
}

void run_simulation(const Scene& scene, const Accuracy& accuracy) {
  try {
    const std::string reason = unsupported(scene, accuracy);
    Simulation simulation = compile(scene, accuracy);
    require(reason.empty(), "what is not supported is not compiled");
    // If springs or joints need more, a step takes seconds.
    const bool quick = simulation.plan().substeps <= kMostSubsteps;
    for (int i = 0; quick && i < kSteps; ++i) simulation.step();
    for (std::size_t body = 0; body < simulation.body_count(); ++body)
      require(is_finite(simulation.state(body)), "states are finite");
    const auto saved = simulation.save();
    simulation.restore(saved);
    require(simulation.save() == saved, "a simulation restores what it saved");
  } catch (const Error&) {
    // Numbers beyond what a run can take.
  }
}

template <class Real>
void run_world(const Scene& scene) {
  try {
    BasicWorld<Real> world(world_definition(scene));
    const SceneParts parts = add_scene(world, scene);
    require(parts.bodies.size() == scene.bodies.size(), "every body of the scene is in the world");
    SceneForces<Real> forces(scene, parts);
    for (int i = 0; i < kSteps; ++i) {
      forces.apply(world, 1.0 / 60);
      world.step();
      check_world(world);
    }
  } catch (const Error&) {
    // Numbers beyond what a world can take.
  }
}

std::size_t parts_of(const Scene& scene) {
  std::size_t count = scene.bodies.size() + scene.joints.size() + scene.forces.size();
  for (const Body& body : scene.bodies) {
    for (const Shape& shape : body.shapes) {
      ++count;
      if (const Chain* chain = std::get_if<Chain>(&shape.geometry)) count += chain->points.size();
    }
  }
  return count;
}

}  // namespace
}  // namespace plumb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumb;
  Scene scene;
  try {
    scene = scene_from_json({reinterpret_cast<const char*>(data), size});
  } catch (const Error&) {
    return 0;
  }
  fuzz::check_round_trip(scene);
  if (fuzz::parts_of(scene) > fuzz::kMostParts) return 0;
  fuzz::run_simulation(scene, Realtime{});
  fuzz::run_simulation(scene, Realtime{.precision = Precision::Float,
                                       .integrator = Integrator::SemiImplicitEuler,
                                       .solver = Solver::SequentialImpulses});
  fuzz::run_world<float>(scene);
  fuzz::run_world<double>(scene);
  return 0;
}
