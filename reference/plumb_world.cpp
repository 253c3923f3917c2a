// plumb's World, the game world, in both precisions: soft steps, small islands solved directly.
#include "engine/world/world.h"

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>

#include "engine/core/text.h"
#include "engine/world/add_scene.h"
#include "engine/world/scene/scene_forces.h"
#include "reference/backend.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

constexpr int kSubsteps = 4;

struct WorldSettings {
  double dt = 0;  ///< s
  int substeps = kSubsteps;
  bool continuous = true, sleeping = false;
  Solver solver = Solver::SoftSteps;
};

template <class Real>
class WorldSimulator final : public Simulator {
 public:
  WorldSimulator(const Scene& scene, const WorldSettings& settings)
      : settings_(settings),
        world_(definition_of(scene, settings)),
        parts_(add_scene(world_, scene)),
        forces_(scene, parts_) {}

  double advance(int steps) override {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps; ++i) {
      forces_.apply(world_, settings_.dt);
      world_.step(settings_.dt, settings_.substeps);
    }
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }

  double time() const override { return static_cast<double>(world_.step_count()) * settings_.dt; }

  void read(std::span<BodyState> out) const override {
    for (std::size_t i = 0; i < parts_.bodies.size(); ++i) out[i] = world_.state(parts_.bodies[i]);
  }

 private:
  static WorldDefinition definition_of(const Scene& scene, const WorldSettings& settings) {
    WorldDefinition definition = world_definition(scene);
    definition.sleeping = settings.sleeping;
    definition.continuous = settings.continuous;
    definition.quarantine = false;  // all bodies must take part in the answer
    definition.solver = settings.solver;
    return definition;
  }

  WorldSettings settings_;
  BasicWorld<Real> world_;
  SceneParts parts_;
  SceneForces<Real> forces_;
};

template <class Real>
class WorldBackend final : public Backend {
 public:
  WorldBackend(std::string_view name, std::string_view summary) : name_(name), summary_(summary) {}

  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return summary_; }
  Identity identity() const override { return {.version = PLUMB_VERSION, .precision = precision()}; }

  std::vector<Option> options() const override {
    return {{"continuous", "on", "on or off: continuous collision"},
            {"sleep", "off", "on or off: islands at rest stop being computed"},
            {"solver", name_of(Solver::SoftSteps),
             "soft_steps, sequential_impulses, jakobsen, xpbd or direct (islands with joints as a whole)"}};
  }

  std::vector<Knob> knobs() const override {
    return {{"substeps", {"1", "2", "4", "8", "16", "32"}}, {"continuous", {"off", "on"}, false}};
  }

  Method method(const StepSettings& settings) const override {
    const WorldSettings chosen = read_settings(settings);
    return {.scheme = Scheme::SoftStep,
            .order = 1,
            .substep = chosen.dt / chosen.substeps,
            .epsilon = static_cast<double>(std::numeric_limits<Real>::epsilon())};
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    read_settings(settings);
    if (const std::string reason = world_unsupported(scene); !reason.empty()) return reason;
    return out_of_range(scene, kWorldRange);
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const WorldSettings chosen = read_settings(settings);
    Settings out{{"dt", shortest(chosen.dt)},
                 {"substeps", std::to_string(chosen.substeps)},
                 {"solver", name_of(chosen.solver)},
                 {"continuous", chosen.continuous ? "on" : "off"},
                 {"sleep", chosen.sleeping ? "on" : "off"},
                 {"forces", "at the middle of each step, for the whole step"},
                 {"inertia", "the scene's"},
                 {"precision", precision() + ", positions double"}};
    append_contact_rules(out, scene);
    return out;
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return std::make_unique<WorldSimulator<Real>>(scene, read_settings(settings));
  }

 private:
  // A World rejects numbers outside these limits.
  static constexpr Range kWorldRange{
      .smallest = 1e-12, .largest = 1e12, .smallest_inertia = 1e-30, .largest_inertia = 1e30};

  static std::string precision() { return std::is_same_v<Real, float> ? "float" : "double"; }

  WorldSettings read_settings(const StepSettings& settings) const {
    check_steps(name_, settings, Stepping::Fixed);
    const OptionReader given(name_, settings, options());
    std::vector<std::pair<std::string, Solver>> solvers;
    for (const char* name : kSolverNames) solvers.emplace_back(name, *solver_of(name));
    return {settings.dt, settings.substeps.value_or(kSubsteps), given.toggle("continuous"),
            given.toggle("sleep"), given.choice<Solver>("solver", solvers)};
  }

  std::string_view name_, summary_;
};

const Registration world_float{std::make_unique<WorldBackend<float>>(
    "plumb-world", "plumb's game world in float: soft steps, small islands directly")};
const Registration world_double{
    std::make_unique<WorldBackend<double>>("plumb-world-double", "plumb's game world in double")};

}  // namespace
}  // namespace plumb::reference
