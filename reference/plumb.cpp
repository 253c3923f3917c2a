// plumb's own engine, as three backends: its fixed-step driver in both precisions, and its adaptive one.
#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "engine/core/text.h"
#include "engine/realtime/stages.h"
#include "engine/simulation/simulation.h"
#include "reference/backend.h"
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
    if (const Error* doubt = world_.doubt()) out.emplace_back("doubt", doubt->what());
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

class RealtimeBackend final : public PlumbBackend {
 public:
  using PlumbBackend::PlumbBackend;

  std::vector<Option> options() const override {
    return {{"integrator", std::string(name_of(kRealtime.integrator)),
             "velocity_verlet, semi_implicit_euler or explicit_euler"},
            {"joint_solver", std::string(name_of(kRealtime.joint_solver)), "direct or iterative"},
            {"iterations", std::to_string(kRealtime.iterations),
             "sweeps over contacts and iterative joints a substep"},
            {"on_doubt", std::string(name_of(kRealtime.on_doubt)),
             "stop or report: what becomes of a run that broke a promise"}};
  }

  std::vector<Knob> knobs() const override {
    return {{"substeps", {"1", "2", "4", "8", "16"}},
            {"integrator",
             {std::string(name_of(Integrator::VelocityVerlet)),
              std::string(name_of(Integrator::SemiImplicitEuler))},
             false},
            {"joint_solver",
             {std::string(name_of(JointSolver::Direct)), std::string(name_of(JointSolver::Iterative))},
             false},
            {"iterations", {"1", "2", "4", "8", "16"}}};
  }

  Method method(const StepSettings& settings) const override {
    const Realtime chosen = realtime(settings);
    Method out{.substep = chosen.dt / chosen.substeps, .epsilon = epsilon()};
    switch (chosen.integrator) {
      case Integrator::VelocityVerlet:
        out.scheme = Scheme::VelocityVerlet;
        out.order = 2;
        out.follows_springs = true;
        break;
      case Integrator::SemiImplicitEuler:
        out.scheme = Scheme::SemiImplicitEuler;
        out.order = 1;
        break;
      case Integrator::ExplicitEuler:
        out.scheme = Scheme::ExplicitEuler;
        out.order = 1;
        break;
    }
    return out;
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const Realtime chosen = realtime(settings);
    // The run may raise this for towers, which it detects later.
    Settings out{{"dt", shortest(chosen.dt)},
                 {"substeps", std::to_string(plan_realtime(scene, chosen, false).substeps)},
                 {"integrator", std::string(name_of(chosen.integrator))},
                 {"joint_solver", std::string(name_of(chosen.joint_solver))},
                 {"iterations", std::to_string(chosen.iterations)},
                 {"on_doubt", std::string(name_of(chosen.on_doubt))},
                 {"precision", std::string(name_of(chosen.precision))}};
    append_contact_rules(out, scene);
    return out;
  }

 protected:
  Accuracy accuracy(const StepSettings& settings) const override { return realtime(settings); }

 private:
  Realtime realtime(const StepSettings& settings) const {
    check_steps(name_, settings, Stepping::Fixed);
    const OptionReader given(name_, settings, options());
    Realtime out;
    out.dt = settings.dt;
    out.substeps = settings.substeps.value_or(kRealtime.substeps);
    out.iterations = given.integer("iterations", 1);
    out.precision = precision_;
    out.integrator = given.choice<Integrator>(
        "integrator", {named(Integrator::VelocityVerlet), named(Integrator::SemiImplicitEuler),
                       named(Integrator::ExplicitEuler)});
    out.joint_solver = given.choice<JointSolver>("joint_solver",
                                                 {named(JointSolver::Direct), named(JointSolver::Iterative)});
    out.on_doubt = given.choice<OnDoubt>("on_doubt", {named(OnDoubt::Stop), named(OnDoubt::Report)});
    plumb::validate(Accuracy(out));
    return out;
  }
};

class PreciseBackend final : public PlumbBackend {
 public:
  using PlumbBackend::PlumbBackend;

  std::vector<Option> options() const override {
    return {
        {"method", std::string(name_of(kPrecise.method)), "automatic, explicit, implicit or symplectic"},
        {"estimate_error", "no", "yes: a second run at a tenth of the tolerance beside, to compare with"}};
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

const Registration realtime_double{
    std::make_unique<RealtimeBackend>("plumb", "plumb with fixed steps in double", Precision::Double)};
const Registration realtime_float{
    std::make_unique<RealtimeBackend>("plumb-float", "plumb with fixed steps in float", Precision::Float)};
const Registration precise_double{std::make_unique<PreciseBackend>(
    "plumb-precise", "plumb with adaptive steps that meet a tolerance", Precision::Double)};

}  // namespace
}  // namespace plumb::reference
