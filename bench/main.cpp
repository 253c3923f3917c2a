// Cost of a step of every scenario on every engine at every size: one benchmark for each, from the
// registries.
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/environment.h"
#include "harness/truth_table.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::bench {
namespace {

using reference::Backend;
using scenarios::Instance;

/// Steps from the start of the run to its end, then again from the start. The time is the engine's own
/// figure: without set-up and, if the engine runs as a program, without transport.
void step(benchmark::State& state, const Instance& instance, const Backend& backend) {
  try {
    const reference::Identity identity = backend.identity();
    if (!identity.available)
      return state.SkipWithError(fmt::format("not installed: {}", identity.reason).c_str());
    const scenarios::Problem problem = instance.build();
    const reference::StepSettings settings;
    const std::string unsupported = backend.unsupported(problem.scene, settings);
    if (!unsupported.empty()) return state.SkipWithError(fmt::format("skipped: {}", unsupported).c_str());
    const int steps = harness::step_count(problem.duration, settings.dt);
    while (state.KeepRunningBatch(steps)) {
      const auto simulator = backend.create(problem.scene, settings);
      state.SetIterationTime(simulator->advance(steps) * 1e-9);
    }
    state.counters["simulated_s"] = benchmark::Counter(static_cast<double>(state.iterations()) * settings.dt,
                                                       benchmark::Counter::kIsRate);
  } catch (const Error& error) {
    state.SkipWithError(error.what());
  }
}

void register_all() {
  for (const scenarios::Scenario& scenario : scenarios::all()) {
    for (const Instance& instance : scenarios::select(scenario.name)) {
      for (const Backend* backend : reference::backends()) {
        const std::string name = fmt::format("{}/{}", instance.label(), backend->name());
        benchmark::RegisterBenchmark(
            name.c_str(), [instance, backend](benchmark::State& state) { step(state, instance, *backend); })
            ->UseManualTime()
            ->Unit(benchmark::kMicrosecond);
      }
    }
  }
}

}  // namespace
}  // namespace plumb::bench

int main(int argc, char** argv) {
  plumb::bench::register_all();
  const plumb::harness::Environment where = plumb::harness::environment();
  benchmark::AddCustomContext("plumb", where.plumb_version);
  benchmark::AddCustomContext("commit", where.commit);
  benchmark::AddCustomContext("compiler", where.compiler);
  benchmark::AddCustomContext("flags", where.flags);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  if (std::cout.flush() && std::fflush(stdout) == 0) return 0;
  std::fputs("plumb: stdout: cannot be written: the medium is full, or broken\n", stderr);
  return 2;
}
