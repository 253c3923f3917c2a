// Measures the field's scenes on every engine, the engines taking turns, with time and quality.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <span>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "bench/field/measure.h"
#include "bench/field/report.h"
#include "engine/core/suggest.h"
#include "harness/interrupt.h"
#include "harness/style.h"

namespace plumb::field {
namespace {

enum Exit { kOk = 0, kFailed = 1, kUsage = 2, kMissing = 3, kOutput = 4, kInterrupted = 130 };

constexpr const char* kFooter =
    "Examples:\n  plumb_field                                        all scenes on all engines; this takes a "
    "while\n  plumb_field --quick                                small scenes and few steps, to test that "
    "all work\n  plumb_field large_pyramid tumbler --repeat 5\n  plumb_field joint_grid --engine box2d "
    "--engine chipmunk --format csv\n  plumb_field chain_10 --engine plumb --solver soft_steps,direct,xpbd\n "
    " plumb_field tumbler --engine plumb --threads 1,2\n  plumb_field tumbler --engine plumb --profile       "
    "the time of each stage of a step\nTimes are medians over the repetitions; speed is Box2D's time "
    "(version 3 if it is in this build) / the engine's.\nOverlaps and joint gaps are the maximum and the "
    "mean of ten samples of the run, heights and speeds those at its end.\nSee docs/speed.md.\nExit codes: 0 "
    "ok, 1 an engine failed, 2 usage, 3 an engine that is not in this build, 4 stdout cannot be\nwritten, "
    "130 interrupted.";

/// Ends the program with a message and an exit code.
struct Stop : std::runtime_error {
  Stop(Exit exit, const std::string& text) : std::runtime_error(text), code(exit) {}
  Exit code;
};

struct Options {
  std::vector<std::string> scenes, engines, solvers;
  std::string format = "table", continuous = "scene", clock = "wall";
  std::vector<int> threads;
  int steps = 0;
  bool list = false, sleeping = false;
};

/// Writes to stderr; ignores failures, because they cannot be reported anywhere.
void say(const std::string& text) { std::fputs(text.c_str(), stderr); }

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw Stop(errno == EPIPE ? kOk : kOutput, fmt::format("stdout: {}", std::strerror(errno)));
}

/// Returns the entries of `all` that `names` contains, in the order of `all`; all entries if there are no
/// names.
template <class Entry>
std::vector<const Entry*> select(std::span<const Entry> all, const std::vector<std::string>& names,
                                 const char* what) {
  std::vector<std::string> known;
  for (const Entry& entry : all) known.push_back(entry.name);
  for (const std::string& name : names)
    if (std::ranges::find(known, name) == known.end())
      throw Stop(kUsage, fmt::format("there is no {} '{}'{}; see `plumb_field --list`", what, name,
                                     did_you_mean(name, known)));
  std::vector<const Entry*> out;
  for (const Entry& entry : all)
    if (names.empty() || std::ranges::find(names, entry.name) != names.end()) out.push_back(&entry);
  return out;
}

std::vector<const Engine*> select_engines(const std::vector<std::string>& names) {
  std::vector<const Engine*> chosen = select(engines(), names, "engine");
  for (const Engine* engine : chosen) {
    if (engine->missing.empty()) continue;
    const std::string text =
        fmt::format("engine '{}' is not in this build: {}", engine->name, engine->missing);
    if (!names.empty()) throw Stop(kMissing, text);
    say(fmt::format("plumb_field: {}\n", text));
  }
  std::erase_if(chosen, [](const Engine* engine) { return !engine->missing.empty(); });
  if (chosen.empty()) throw Stop(kMissing, "no engine is in this build");
  return chosen;
}

/// Returns each engine that has solvers once for each named solver ("all": every one), the others unchanged.
std::vector<Engine> by_solver(const std::vector<const Engine*>& chosen,
                              const std::vector<std::string>& names) {
  std::vector<Engine> out;
  for (const Engine* engine : chosen) {
    if (names.empty() || engine->solvers.empty()) {
      out.push_back(*engine);
      continue;
    }
    for (const std::string& name : names)
      if (name != "all" && std::ranges::find(engine->solvers, name) == engine->solvers.end())
        throw Stop(kUsage, fmt::format("{} has no solver '{}'{}; see `plumb_field --list`", engine->name,
                                       name, did_you_mean(name, engine->solvers)));
    const bool all = std::ranges::find(names, "all") != names.end();
    for (const std::string& solver : all ? engine->solvers : names)
      out.push_back(with_solver(*engine, solver));
  }
  return out;
}

/// Returns each engine that shares steps once for each number of threads, the others unchanged.
std::vector<Engine> by_threads(const std::vector<Engine>& chosen, const std::vector<int>& numbers) {
  std::vector<Engine> out;
  for (const Engine& engine : chosen) {
    if (numbers.empty() || !engine.shares_steps) {
      out.push_back(engine);
      continue;
    }
    for (const int threads : numbers) out.push_back(with_threads(engine, threads));
  }
  return out;
}

std::string list_text() {
  std::string out = "Scenes:\n";
  for (const Scene& scene : scenes())
    out += fmt::format("  {:<15} {}{}\n", scene.name, scene.summary, scene.on_request ? " (when named)" : "");
  out += "Engines:\n";
  for (const Engine& engine : engines())
    out += fmt::format("  {:<15} {}\n", engine.name,
                       engine.missing.empty() ? engine.version : "not in this build: " + engine.missing);
  out += "Solvers:\n";
  for (const Engine& engine : engines())
    if (!engine.solvers.empty())
      out += fmt::format("  {:<15} {}\n", engine.name, fmt::join(engine.solvers, ", "));
  return out;
}

/// One line on stderr if it is a terminal; nothing elsewhere.
class ProgressLine {
 public:
  void show(const Progress& progress) {
    if (!on_) return;
    say(fmt::format("\r\x1b[K{}/{} {}", progress.done, progress.total, progress.what));
    std::fflush(stderr);
  }
  void clear() {
    if (!on_) return;
    say("\r\x1b[K");
    std::fflush(stderr);
  }

 private:
  bool on_ = isatty(STDERR_FILENO) != 0;
};

int run(const Plan& plan, const std::string& format) {
  const harness::Style style = harness::Style::of_file(STDOUT_FILENO);
  ProgressLine line;
  std::vector<Measurement> all;
  if (format == "csv") print(csv_header());
  const auto done = [&](std::vector<Measurement>& row) {
    line.clear();
    if (format == "table") print(table(row, style));
    if (format == "csv")
      for (const Measurement& m : row) print(csv_row(m, yardstick_of(row, *m.scene)));
    all.insert(all.end(), row.begin(), row.end());
  };
  measure(
      plan, [&](const Progress& progress) { line.show(progress); }, done, harness::interrupted);
  line.clear();
  if (format == "table") print(settings_text(all, style));
  if (format == "json") print(json(all, plan));
  if (harness::interrupted()) return kInterrupted;
  const bool failed = std::ranges::any_of(all, [](const Measurement& m) { return !m.failure.empty(); });
  return failed ? kFailed : kOk;
}

void describe(CLI::App& app, Options& options, Plan& plan) {
  app.footer(kFooter);
  app.add_option("scene", options.scenes, "scenes to run (default: all)")->type_name("SCENE");
  app.add_option("--engine", options.engines, "engines to run (default: all)")
      ->delimiter(',')
      ->type_name("NAME");
  app.add_option("--steps", options.steps, "number of measured steps (default: each scene's own)")
      ->check(CLI::Range(10, 10000000))
      ->type_name("N");
  app.add_option("--repeat", plan.repeat, "repetitions, each in a new world (3)")
      ->check(CLI::Range(1, 1000))
      ->type_name("R");
  app.add_option("--clock", options.clock,
                 "wall, or cpu for processor time, on machines that other programs use too (wall)")
      ->check(CLI::IsMember({"wall", "cpu"}));
  app.add_option("--limit", plan.limit, "time limit of a run in seconds (600)")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  app.add_option("--substeps", plan.settings.substeps, "number of substeps, for engines that have them (4)")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  app.add_option("--threads", options.threads,
                 "numbers of threads of plumb, each in its own row (1); --clock cpu adds their times")
      ->delimiter(',')
      ->check(CLI::Range(1, 64))
      ->type_name("N");
  app.add_option("--solver", options.solvers,
                 "solvers of plumb, each in its own row; all: every solver (default: plumb's own)")
      ->delimiter(',')
      ->type_name("NAME");
  app.add_option("--iterations", plan.settings.iterations, "iterations of solvers that iterate (10)")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  app.add_option("--continuous", options.continuous,
                 "continuous collision: on, off, or as the scene has it (scene)")
      ->check(CLI::IsMember({"on", "off", "scene"}));
  app.add_flag("--sleeping", options.sleeping, "let bodies at rest sleep");
  app.add_option("--format", options.format, "table, json or csv (table)")
      ->check(CLI::IsMember({"table", "json", "csv"}));
  app.add_flag("--profile", plan.settings.profiling,
               "print the wall time of each stage of plumb's step; the timers cost about 100 ns per step");
  app.add_flag("--quick", plan.quick, "small scenes and few steps; the figures are not meaningful");
  app.add_flag("--list", options.list, "list the scenes and the engines");
}

int parse_and_run(int argc, char** argv) {
  CLI::App app("Benchmark scenes of well-known engines, on every engine in turn", "plumb_field");
  Options options;
  Plan plan;
  describe(app, options, plan);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    throw Stop(kUsage, fmt::format("{}; see `plumb_field --help`", error.what()));
  }
  if (options.list) return print(list_text()), kOk;
  plan.scenes = select(std::span<const Scene>(scenes()), options.scenes, "scene");
  if (options.scenes.empty())
    std::erase_if(plan.scenes, [](const Scene* scene) { return scene->on_request; });
  const std::vector<Engine> engines =
      by_threads(by_solver(select_engines(options.engines), options.solvers), options.threads);
  for (const Engine& engine : engines) plan.engines.push_back(&engine);
  if (options.steps > 0) plan.steps = options.steps;
  if (options.continuous != "scene") plan.continuous = options.continuous == "on";
  if (options.clock == "cpu") plan.clock = CLOCK_PROCESS_CPUTIME_ID;
  plan.settings.sleeping = options.sleeping;
  return run(plan, options.format);
}

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  harness::catch_interrupts();
  try {
    return parse_and_run(argc, argv);
  } catch (const Stop& stop) {
    if (stop.code != kOk) say(fmt::format("plumb_field: {}\n", stop.what()));
    return stop.code;
  } catch (const std::exception& error) {
    say(fmt::format("plumb_field: {}\n", error.what()));
    return kFailed;
  }
}

}  // namespace
}  // namespace plumb::field

int main(int argc, char** argv) { return plumb::field::main(argc, argv); }
