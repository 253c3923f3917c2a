// plumb's own engine, as three backends: the world in both precisions, and the adaptive integration.
#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "engine/core/text.h"
#include "engine/simulation/simulation.h"
#include "reference/backend.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

constexpr Realtime kRealtime;
constexpr Precise kPrecise;

class PlumbSimulator final : public Simulator {
 public:
  explicit PlumbSimulator(Simulation world) : world_(std::move(world)) {}

  double advance(int steps) override {
    const auto start = std::chrono::steady_clock::now();
    world_.step(steps);
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }
  double time() const override { return world_.time(); }
  void read(std::span<BodyState> out) const override { world_.read(out); }
  Reactions forces() const override { return world_.forces(); }

  std::vector<std::pair<std::string, std::string>> report() const override {
    const Statistics did = world_.statistics();
    std::vector<std::pair<std::string, std::string>> out{{"steps", std::to_string(did.steps)}};
    const auto count = [&](const char* name, std::int64_t number) {
      if (number > 0) out.emplace_back(name, std::to_string(number));
    };
    count("rejected", did.rejected);
    count("evaluations", did.evaluations);
    count("implicit_steps", did.implicit);
    count("leaps", did.leaps);
    count("redundant_joints", did.redundant_joints);
    count("impacts", did.impacts);
    constexpr std::pair<ContactEvent, const char*> kEvents[] = {
        {ContactEvent::Rest, "comes_to_rest"},     {ContactEvent::Hold, "contacts_begin"},
        {ContactEvent::Separation, "separations"}, {ContactEvent::SlipStart, "slips_begin"},
        {ContactEvent::SlipEnd, "slips_end"},      {ContactEvent::Change, "changes_of_feature"},
        {ContactEvent::Paradox, "paradoxes"}};
    for (const auto& [event, name] : kEvents) count(name, did.of(event).count);
    if (const Error* found = world_.violation()) out.emplace_back("violation", found->what());
    if (did.error.known) {
      out.emplace_back("estimated_error", fmt::format("{:.1e} m, {:.1e} rad, {:.1e} m/s", did.error.position,
                                                      did.error.angle, did.error.velocity));
    }
    return out;
  }

 private:
  Simulation world_;
};

/// Base of the three backends: converts settings to an Accuracy, with which a Simulation runs the scene.
class PlumbBackend : public Backend {
 public:
  PlumbBackend(std::string_view name, std::string_view summary, Precision precision)
      : name_(name), summary_(summary), precision_(precision) {}

  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return summary_; }
  Identity identity() const override {
    return {.version = PLUMB_VERSION, .precision = std::string(name_of(precision_))};
  }
  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    return plumb::unsupported(scene, accuracy(settings));
  }
  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return std::make_unique<PlumbSimulator>(compile(scene, accuracy(settings)));
  }

 protected:
  virtual Accuracy accuracy(const StepSettings& settings) const = 0;

  template <class Value>
  static std::pair<std::string, Value> named(Value value) {
    return {std::string(name_of(value)), value};
  }

  double epsilon() const {
    return precision_ == Precision::Float ? std::numeric_limits<float>::epsilon()
                                          : std::numeric_limits<double>::epsilon();
  }

  std::string_view name_, summary_;
  Precision precision_;
};

/// The world. Sleeping and the monitor are off by default, so that every body takes part and misses are
/// results.
class WorldBackend final : public PlumbBackend {
 public:
  using PlumbBackend::PlumbBackend;

  std::vector<Option> options() const override {
    return {
        {"solver", name_of(kRealtime.solver),
         "soft_steps, sequential_impulses, jakobsen, xpbd or direct (direct solve of islands with joints)"},
        {"integrator", std::string(name_of(kRealtime.integrator)),
         "velocity_verlet, semi_implicit_euler or explicit_euler; for soft_steps and direct"},
        {"iterations", std::to_string(kRealtime.iterations),
         "iterations per substep; for sequential_impulses and jakobsen"},
        {"continuous", "on", "on or off: continuous collision"},
        {"sleep", "off", "on or off: sleep of islands at rest"},
        {"on_violation", std::string(name_of(kRealtime.on_violation)),
         "ignore, report or stop: reaction to a violation (joint gaps, overlaps or energy beyond their "
         "bounds)"}};
  }

  std::vector<Knob> knobs() const override {
    return {{"substeps", {"1", "2", "4", "8", "16", "32"}}, {"continuous", {"off", "on"}, false}};
  }

  Method method(const StepSettings& settings) const override {
    const Realtime chosen = realtime(settings);
    Method out{
        .scheme = Scheme::SoftStep, .order = 1, .substep = chosen.dt / chosen.substeps, .epsilon = epsilon()};
    if (chosen.integrator == Integrator::SemiImplicitEuler) out.scheme = Scheme::SemiImplicitEuler;
    if (chosen.integrator == Integrator::ExplicitEuler) out.scheme = Scheme::ExplicitEuler;
    return out;
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    if (const std::string reason = PlumbBackend::unsupported(scene, settings); !reason.empty()) return reason;
    return out_of_range(scene, kWorldRange);
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const Realtime chosen = realtime(settings);
    Settings out{{"dt", shortest(chosen.dt)},
                 {"substeps", std::to_string(chosen.substeps)},
                 {"solver", name_of(chosen.solver)},
                 {"integrator", std::string(name_of(chosen.integrator))},
                 {"iterations", std::to_string(chosen.iterations)},
                 {"continuous", chosen.continuous ? "on" : "off"},
                 {"sleep", chosen.sleeping ? "on" : "off"},
                 {"on_violation", std::string(name_of(chosen.on_violation))},
                 {"forces", chosen.integrator == Integrator::VelocityVerlet ? "at the middle of each substep"
                                                                            : "at the start of each substep"},
                 {"precision", std::string(name_of(chosen.precision)) + ", positions double"}};
    append_contact_rules(out, scene);
    return out;
  }

 protected:
  Accuracy accuracy(const StepSettings& settings) const override { return realtime(settings); }

 private:
  // A world rejects numbers outside these limits.
  static constexpr Range kWorldRange{
      .smallest = 1e-12, .largest = 1e12, .smallest_inertia = 1e-30, .largest_inertia = 1e30};

  Realtime realtime(const StepSettings& settings) const {
    check_steps(name_, settings, Stepping::Fixed);
    const OptionReader given(name_, settings, options());
    std::vector<std::pair<std::string, Solver>> solvers;
    for (const char* name : kSolverNames) solvers.emplace_back(name, *solver_of(name));
    Realtime out;
    out.dt = settings.dt;
    out.substeps = settings.substeps.value_or(kRealtime.substeps);
    out.iterations = given.integer("iterations", 1);
    out.precision = precision_;
    out.integrator = given.choice<Integrator>(
        "integrator", {named(Integrator::VelocityVerlet), named(Integrator::SemiImplicitEuler),
                       named(Integrator::ExplicitEuler)});
    out.solver = given.choice<Solver>("solver", solvers);
    out.continuous = given.toggle("continuous");
    out.sleeping = given.toggle("sleep");
    out.on_violation = given.choice<OnViolation>(
        "on_violation", {named(OnViolation::Ignore), named(OnViolation::Report), named(OnViolation::Stop)});
    plumb::validate(Accuracy(out));
    return out;
  }
};

class PreciseBackend final : public PlumbBackend {
 public:
  using PlumbBackend::PlumbBackend;

  std::vector<Option> options() const override {
    return {{"method", std::string(name_of(kPrecise.method)), "automatic, explicit, implicit or symplectic"},
            {"estimate_error", "no", "yes: estimate the error by a second run at a tenth of the tolerance"}};
  }

  std::vector<Knob> knobs() const override {
    return {{"tolerance",
             {"1e2", "1e1", "1", "1e-1", "1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-8", "1e-9",
              "1e-10", "1e-11", "1e-12"}},
            {"method",
             {std::string(name_of(MotionMethod::Automatic)), std::string(name_of(MotionMethod::Explicit)),
              std::string(name_of(MotionMethod::Symplectic))},
             false}};
  }

  Method method(const StepSettings& settings) const override {
    const Precise chosen = precise(settings);
    return {.scheme = Scheme::Adaptive, .order = 0, .substep = chosen.max_dt, .epsilon = epsilon()};
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const Precise chosen = precise(settings);
    Settings out{{"tolerance", shortest(chosen.tolerance)},
                 {"max_dt", shortest(chosen.max_dt)},
                 {"method", std::string(name_of(chosen.method))},
                 {"estimate_error", chosen.estimate_error ? "yes" : "no"},
                 {"precision", std::string(name_of(precision_))}};
    append_contact_rules(out, scene);
    return out;
  }

 protected:
  Accuracy accuracy(const StepSettings& settings) const override { return precise(settings); }

 private:
  Precise precise(const StepSettings& settings) const {
    check_steps(name_, settings, Stepping::Adaptive);
    const OptionReader given(name_, settings, options());
    Precise out{.tolerance = settings.tolerance.value_or(kPrecise.tolerance), .max_dt = settings.dt};
    out.method = given.choice<MotionMethod>("method",
                                            {named(MotionMethod::Automatic), named(MotionMethod::Explicit),
                                             named(MotionMethod::Implicit), named(MotionMethod::Symplectic)});
    out.estimate_error = given.choice<bool>("estimate_error", {{"no", false}, {"yes", true}});
    plumb::validate(Accuracy(out));
    return out;
  }
};

const Registration world_double{
    std::make_unique<WorldBackend>("plumb", "plumb's world in double: fixed steps", Precision::Double)};
const Registration world_float{
    std::make_unique<WorldBackend>("plumb-float", "plumb's world in float", Precision::Float)};
const Registration precise_double{std::make_unique<PreciseBackend>(
    "plumb-precise", "plumb with adaptive steps that meet a tolerance", Precision::Double)};

}  // namespace
}  // namespace plumb::reference
