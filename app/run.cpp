#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/force_writer.h"
#include "app/guard.h"
#include "app/output.h"
#include "app/report_error.h"
#include "app/selection.h"
#include "app/sensitivity_writer.h"
#include "app/settings.h"
#include "app/source.h"
#include "app/trajectory_writer.h"
#include "app/usage.h"
#include "engine/precise/dynamics/initial_joint_errors.h"
#include "engine/scene/error.h"
#include "engine/simulation/simulation.h"
#include "harness/interrupt.h"
#include "harness/truth_table.h"

namespace plumb::app {
namespace {

struct RunOptions {
  std::string name, engine, format = "csv", duration, rate;
  int size = 0;
  bool forces = false;
  std::vector<std::string> commands, parameters;
  SettingsOptions settings;
};

/// Joints with larger initial errors, m or rad and per second, are reported. Rounding errors are smaller,
/// even those of numbers with six digits.
constexpr double kOpenJoint = 1e-5;

/// Thrown if the user has stopped the run.
struct Interrupted {};

// Returns the steps of dt from one sample to the next.
int steps_a_sample(const std::string& rate, double dt) {
  if (rate.empty()) return 1;
  const double wanted = parse_positive("--rate", rate), steps = 1 / (wanted * dt), whole = std::round(steps);
  if (whole < 1 || whole > 1e9 || std::abs(steps - whole) > 1e-6 * steps) {
    throw UsageError(fmt::format(
        "--rate is '{}', but samples lie on steps: with this dt give {:g}, {:g}, {:g}, ... (or change --dt)",
        rate, 1 / dt, 1 / (2 * dt), 1 / (3 * dt)));
  }
  return static_cast<int>(whole);
}

int sample_count(double duration, double dt, int every) {
  if (duration / dt > 1e9)
    throw UsageError(fmt::format("{:g} s at dt = {:g} s are too many steps", duration, dt));
  return harness::step_count(duration, dt) / every;
}

// Ends the run before a non-finite state is written.
void require_finite(const RunOptions& options, const Scene& scene, double time,
                    std::span<const BodyState> states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BodyState& s = states[i];
    const double values[] = {s.position.x, s.position.y, s.angle,
                             s.velocity.x, s.velocity.y, s.angular_velocity};
    if (std::all_of(std::begin(values), std::end(values), [](double value) { return std::isfinite(value); }))
      continue;
    throw Error(Error::Kind::Run, fmt::format("engine '{}'", options.engine), "", "",
                fmt::format("the state of body '{}' is not finite at t = {:g} s; the samples until then are "
                            "on stdout. Try a smaller --dt or more --substeps",
                            scene.bodies[i].name, time));
  }
}

int run(const RunOptions& options, const reference::Backend& backend, const reference::StepSettings& settings,
        const Source& source, int every, int samples) {
  const auto simulator = backend.create(source.scene, settings);
  const auto format =
      options.format == "json" ? TrajectoryWriter::Format::Json : TrajectoryWriter::Format::Csv;
  std::function<void(double, std::span<const BodyState>)> write;
  if (options.forces) {
    (void)simulator->forces();  // throws before anything is printed if the engine reports no forces
    write = [&simulator, writer = ForceWriter(source.scene, format)](
                double time, std::span<const BodyState>) { writer.write(time, simulator->forces()); };
  } else {
    write = [writer = TrajectoryWriter(source.scene, format)](double time, std::span<const BodyState> now) {
      writer.write(time, now);
    };
  }
  for (const std::string& complaint : describe_joint_errors(source.scene, kOpenJoint, kOpenJoint))
    notice(fmt::format("{}: {}", options.engine, complaint));
  std::vector<BodyState> states(source.scene.bodies.size());
  simulator->read(states);
  require_finite(options, source.scene, 0, states);
  write(0, states);
  long step = 0;
  const auto sink = [&](double, std::span<const BodyState> now) {
    if (harness::interrupted()) throw Interrupted{};
    step += every;
    const double time = static_cast<double>(step) * settings.dt;
    require_finite(options, source.scene, time, now);
    write(time, now);
  };
  try {
    simulator->record(samples, every, states.size(), sink);
  } catch (const Interrupted&) {
    flush();
    return kInterrupted;
  }
  std::string did;
  for (const auto& [name, value] : simulator->report())
    did += fmt::format("{}{} {}", did.empty() ? "" : ", ", name, value);
  if (!did.empty()) notice(fmt::format("{}: {}", options.engine, did));
  return kOk;
}

/// Prints derivatives in place of the motion: of Precise itself, as no other engine has them.
int run_derived(const RunOptions& options, const reference::StepSettings& settings, const Source& source,
                int every, int samples) {
  Simulation simulation =
      compile(source.scene,
              plumb::Precise{.tolerance = settings.tolerance.value_or(plumb::Precise{}.tolerance),
                             .max_dt = settings.dt},
              {.parameters = options.parameters});
  SensitivityWriter writer(
      source.scene, options.parameters,
      options.format == "json" ? TrajectoryWriter::Format::Json : TrajectoryWriter::Format::Csv);
  writer.write(simulation);
  for (int i = 0; i < samples; ++i) {
    if (harness::interrupted()) {
      flush();
      return kInterrupted;
    }
    simulation.step(every);
    writer.write(simulation);
  }
  return kOk;
}

int start_run(RunOptions options) {
  if (!options.parameters.empty()) {
    if (options.engine.empty()) options.engine = "plumb-precise";
    if (options.engine != "plumb-precise" || options.forces)
      throw UsageError("--sensitivities needs plumb-precise, and cannot be combined with --forces");
  }
  const auto programs = programs_of(options.commands);
  const reference::Backend& backend = one_engine(options.engine, programs);
  options.engine = backend.name();
  const Source source = load(options.name, options.size);
  const reference::Identity identity = backend.identity();
  if (!identity.available)
    throw UsageError(fmt::format("engine '{}' is not installed: {}", options.engine, identity.reason));
  const reference::StepSettings settings = options.settings.settings(backend);
  if (const std::string reason = backend.unsupported(source.scene, settings); !reason.empty())
    throw Error(Error::Kind::Unsupported, fmt::format("engine '{}'", options.engine), "", "",
                with_alternative(reason, source.scene));
  const int every = steps_a_sample(options.rate, settings.dt);
  const double duration =
      options.duration.empty() ? source.duration : parse_positive("--duration", options.duration);
  const int samples = sample_count(duration, settings.dt, every);
  return guarded(options.engine, [&] {
    return reporting_errors([&] {
      return options.parameters.empty() ? run(options, backend, settings, source, every, samples)
                                        : run_derived(options, settings, source, every, samples);
    });
  });
}

}  // namespace

void add_run(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("run", "run a scene on an engine, and write the trajectory to stdout");
  auto options = std::make_shared<RunOptions>();
  command->add_option("name", options->name, "a scenario or a scene file (- reads stdin)")
      ->required()
      ->type_name("NAME|FILE");
  command->add_option("--engine", options->engine,
                      "see `plumb engines` (default: the first --engine-command, else plumb)");
  add_engine_command(*command, options->commands);
  add_size(*command, options->size);
  options->settings.add_to(*command);
  command
      ->add_option(
          "--duration", options->duration,
          "duration in s, rounded to whole steps (default: the scenario's, 10 for a scene from a file)")
      ->type_name("T");
  command->add_option("--rate", options->rate, "samples per second (default: every step)")->type_name("HZ");
  command->add_option("--format", options->format, "csv or json, one line per sample (default csv)")
      ->check(CLI::IsMember({"csv", "json"}));
  command->add_flag("--forces", options->forces,
                    "print the forces of joints and contacts instead of the motion (plumb-precise)");
  command
      ->add_option(
          "--sensitivities", options->parameters,
          "print d state / d parameter for these numbers of the scene instead of the motion (plumb-precise): "
          "gravity.y, bodies.NAME.mass, bodies.NAME.shapes.friction, joints.NAME.length, forces[0].stiffness")
      ->delimiter(',')
      ->type_name("PARAM,...");
  command->footer(
      "Examples:\n  plumb run free_fall/vacuum --engine box2d --rate 10\n"
      "  plumb run pendulum_chain[20] --engine plumb-precise --tolerance 1e-10 --format json\n"
      "  plumb scene pendulum_chain --size 5 > chain.json && plumb run chain.json --dt 1/240\n"
      "  plumb run free_fall --set integrator=explicit_euler --substeps 1\n"
      "  plumb run bounce/e_1 --engine-command mine='python3 my_engine.py'");
  command->callback([&chosen, options] { chosen = [options] { return start_run(*options); }; });
}

}  // namespace plumb::app
