#include "harness/hunt/motion.h"

#include <cmath>
#include <ctime>
#include <exception>

#include "engine/scene/error.h"
#include "harness/hunt/processor_time.h"
#include "harness/hunt/world_run.h"

namespace plumb::harness::hunt {
namespace {

bool finite(const BodyState& s) {
  return std::isfinite(s.position.x) && std::isfinite(s.position.y) && std::isfinite(s.angle) &&
         std::isfinite(s.velocity.x) && std::isfinite(s.velocity.y) && std::isfinite(s.angular_velocity);
}

reference::StepSettings settings_of(const Case& one, const Engine& engine, int refine) {
  reference::StepSettings out{.dt = one.dt / refine};
  if (engine.kind != Engine::Kind::Precise) out.substeps = one.substeps;
  return out;
}

Motion run_backend(const Engine& engine, const Case& one, const RunOptions& options) {
  Motion out{.dt = one.dt};
  const std::size_t count = one.scene.bodies.size();
  const double begin = processor_seconds();
  try {
    const auto simulator = engine.backend->create(one.scene, settings_of(one, engine, options.refine));
    for (int step = 0; step <= one.steps; ++step) {
      if (step > 0) simulator->advance(options.refine);
      Sample sample{std::vector<BodyState>(count), std::vector<bool>(count, true),
                    std::vector<bool>(count, false)};
      simulator->read(sample.states);
      for (const BodyState& state : sample.states)
        if (!finite(state)) throw Error(Error::Kind::Run, "state", "", "", "is not finite");
      out.samples.push_back(std::move(sample));
      if (processor_seconds() - begin > options.seconds) break;
    }
  } catch (const std::exception& error) {
    out.failure = error.what();
  }
  return out;
}

Engine::Kind kind_of(const std::string_view name) {
  if (name == "plumb-world") return Engine::Kind::World;
  if (name == "plumb-world-double") return Engine::Kind::DoubleWorld;
  if (name == "plumb-precise") return Engine::Kind::Precise;
  return Engine::Kind::Other;
}

}  // namespace

Engine::Engine(const reference::Backend& of) : backend(&of), kind(kind_of(of.name())) {}

double Engine::epsilon() const { return kind == Kind::DoubleWorld || kind == Kind::Precise ? 1.2e-16 : 6e-8; }

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string unsupported(const Engine& engine, const Case& one) {
  if (engine.is_world()) return engine.backend->unsupported(one.scene, settings_of(one, engine, 1));
  if (one.world_only()) return "things are done to its bodies while it runs";
  return engine.backend->unsupported(one.scene, settings_of(one, engine, 1));
}

Motion run(const Engine& engine, const Case& one, const RunOptions& options) {
  if (engine.kind == Engine::Kind::World) return run_world<float>(one, options);
  if (engine.kind == Engine::Kind::DoubleWorld) return run_world<double>(one, options);
  return run_backend(engine, one, options);
}

}  // namespace plumb::harness::hunt
