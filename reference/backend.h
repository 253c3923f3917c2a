#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/scene.h"
#include "reference/simulator.h"

namespace plumb::reference {

/// Step settings of a run. The engine uses its own default for each one that is absent.
struct StepSettings {
  double dt = 1.0 / 60;                          ///< s, > 0; also the sampling grid of an adaptive engine
  std::optional<int> substeps{};                 ///< equal parts of dt, >= 1
  std::optional<double> tolerance{};             ///< for an adaptive engine, > 0
  std::map<std::string, std::string> options{};  ///< the engine's own options by name; see `Backend::options`
};

/// An engine's own option, for help and for checking.
struct Option {
  std::string name;
  std::string fallback;
  std::string help;
};

/// A setting that trades accuracy for cost, for sweeps.
struct Knob {
  std::string name;                 ///< "substeps", "tolerance", or one of the engine's options
  std::vector<std::string> values;  ///< worth trying; if they are ordered, from cheap to accurate
  bool ordered = true;              ///< false: kinds, like integrators
};

/// Name/value pairs for people and reports, most important first.
using Settings = std::vector<std::pair<std::string, std::string>>;

struct Identity {
  std::string version{};    ///< "2.4.1"
  std::string precision{};  ///< "float" or "double"
  bool available = true;
  std::string reason{};    ///< why it is not available and what to install
  std::string own_name{};  ///< name that a program gives itself; "" for engines that are built in

  /// A guest's misses are reported but are not failures, because its versions come and go outside this
  /// project.
  bool guest = false;
  std::string limits{};  ///< for a guest: known reason for its misses, as a sentence

  /// Its costs are those of another platform (WebAssembly, JavaScript), and are never ranked with native
  /// ones.
  bool foreign_cost = false;
};

/// An engine's time stepping method, from which error bounds are derived. `SoftStep`: semi-implicit Euler
/// with constraints as damped springs; bodies without active constraints move by the midpoint method.
enum class Scheme { ExplicitEuler, SemiImplicitEuler, VelocityVerlet, RungeKutta4, SoftStep, Adaptive };

struct Method {
  Scheme scheme = Scheme::SemiImplicitEuler;
  int order = 1;              ///< order of the global error in the substep; 0: adaptive, meets a tolerance
  double substep = 1.0 / 60;  ///< s
  double epsilon = 1.1920929e-7;  ///< unit roundoff of its state
  bool follows_springs = false;   ///< shortens substeps for stiff force laws, so that every spring is stable
};

/// An adapter: translates a Scene to one engine. Adapters hold no state of their own.
class Backend {
 public:
  virtual ~Backend() = default;

  virtual std::string_view name() const = 0;  ///< "box2d"; lower case, unique
  virtual std::string_view summary() const = 0;
  virtual Identity identity() const = 0;
  virtual std::vector<Option> options() const { return {}; }

  /// Returns the settings that a sweep varies besides dt. Its first run always uses the engine's defaults.
  virtual std::vector<Knob> knobs() const { return {}; }

  /// Throws `Error` for settings that this engine cannot take.
  virtual Method method(const StepSettings& settings) const = 0;

  /// Returns the reason why this engine cannot run `scene`, or empty. Such scenes are skipped, never
  /// approximated.
  virtual std::string unsupported(const Scene& scene, const StepSettings& settings) const = 0;

  /// Returns the settings in effect, defaults included: equalised rules, thresholds, iterations.
  virtual Settings effective_settings(const Scene& scene, const StepSettings& settings) const = 0;

  /// Sets up the engine with a valid and supported `scene`. Throws `Error`.
  virtual std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const = 0;
};

/// Returns every adapter linked in: plumb's first, then by name. An adapter adds itself with a
/// `Registration`.
std::vector<const Backend*> backends();

/// Returns the adapter called `name`, or a guest in a given version: "rapier@0.19.3" (see node_engines.h).
/// Throws `Error` (Name) that suggests the nearest name.
const Backend& find_backend(std::string_view name);

/// Adds an adapter that lives as long as the program: `static const Registration r{std::make_unique<X>()};`
struct Registration {
  explicit Registration(std::unique_ptr<Backend> backend);
};

}  // namespace plumb::reference
