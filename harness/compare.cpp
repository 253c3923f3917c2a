#include "harness/compare.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <memory>

#include <fmt/format.h>

#include "harness/interrupt.h"
#include "harness/isolated_run.h"
#include "harness/track.h"

namespace plumb::harness {
namespace {

using reference::Backend;

struct Entrant {
  const Backend* backend;
  IsolatedRun run;
  std::unique_ptr<Track> track;
  std::vector<CostSample> samples{};
};

void measure_costs(const Case& scene_case, const CompareOptions& options, std::vector<Entrant>& entrants) {
  for (int round = 0; round < options.cost.repetitions; ++round) {
    for (Entrant& entrant : entrants) {
      if (entrant.run.result.status != Status::Ok) continue;
      const double expected = entrant.run.nanoseconds / scene_case.truth.steps();
      const IsolatedCost cost = measure_cost_isolated(scene_case, *entrant.backend, options.settings,
                                                      expected, options.cost, options.seconds_a_run);
      if (cost.interrupted) return;
      if (cost.sample) entrant.samples.push_back(*cost.sample);
      entrant.run.result.cost_reason = cost.problem;
    }
  }
}

// Compares each engine with every other: two agree if their distance never exceeds the sum of their bounds on
// the distance from the truth.
void find_agreement(std::vector<Entrant>& entrants) {
  for (Entrant& a : entrants) {
    for (const Entrant& b : entrants) {
      if (&a == &b || a.run.result.status != Status::Ok || b.run.result.status != Status::Ok) continue;
      const auto difference = a.track->worst_difference(*b.track);
      if (!difference) continue;
      auto& list = difference->agrees() ? a.run.result.agrees_with : a.run.result.disagrees_with;
      list.push_back(b.run.result.engine);
    }
  }
}

std::vector<Result> all_failed(const scenarios::Instance& instance, const CompareOptions& options,
                               const char* why) {
  std::vector<Result> results;
  for (const Backend* backend : options.engines) {
    Result result;
    result.scenario = instance.scenario->name;
    result.variant = instance.variant;
    result.size = instance.size;
    result.label = instance.label();
    result.engine = backend->name();
    result.dt = options.settings.dt;
    result.asked = options.settings;
    result.status = Status::Failed;
    result.reason = fmt::format("the scenario itself: {}", why);
    judge(result, is_default(options.settings));
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace

bool is_default(const reference::StepSettings& settings) {
  return settings.dt == reference::StepSettings{}.dt && !settings.substeps && !settings.tolerance &&
         settings.options.empty();
}

bool Comparison::as_expected() const {
  return std::all_of(results.begin(), results.end(),
                     [](const Result& result) { return result.unexpected.empty(); });
}

std::vector<Result> compare_on(const scenarios::Instance& instance, const CompareOptions& options,
                               const std::function<void(const Backend&)>& starting) {
  std::unique_ptr<Case> scene_case;
  try {
    scene_case = std::make_unique<Case>(instance, options.settings.dt);
  } catch (const std::exception& error) {
    return interrupted() ? std::vector<Result>{} : all_failed(instance, options, error.what());
  }
  std::vector<Entrant> entrants;
  for (const Backend* backend : options.engines) {
    if (starting) starting(*backend);
    auto track = std::make_unique<Track>(scene_case->truth.steps(), scene_case->problem.scene.bodies.size());
    IsolatedRun run =
        run_isolated(*scene_case, *backend, options.settings, track.get(), options.seconds_a_run);
    if (run.interrupted) break;
    entrants.push_back({backend, std::move(run), std::move(track)});
  }
  if (options.measure_cost) measure_costs(*scene_case, options, entrants);
  find_agreement(entrants);
  std::vector<Result> results;
  for (Entrant& entrant : entrants) {
    Result& result = entrant.run.result;
    if (!entrant.samples.empty()) {
      result.cost = summarise(entrant.samples, options.settings.dt);
      result.cost_reason.clear();
    }
    judge(result, is_default(options.settings));
    results.push_back(std::move(result));
  }
  return results;
}

Comparison compare(const CompareOptions& options, const CompareEvents& events) {
  Comparison comparison;
  Progress progress{0, options.instances.size() * options.engines.size(), ""};
  for (const scenarios::Instance& instance : options.instances) {
    const std::size_t before = progress.done;
    const auto starting = [&](const Backend& backend) {
      progress.what = fmt::format("{} on {}", instance.label(), backend.name());
      if (events.progress) events.progress(progress);
      ++progress.done;
    };
    std::vector<Result> results = compare_on(instance, options, starting);
    if (events.finished) events.finished(results);
    std::move(results.begin(), results.end(), std::back_inserter(comparison.results));
    progress.done = before + options.engines.size();
    comparison.interrupted = interrupted();
    if (comparison.interrupted) break;
  }
  return comparison;
}

}  // namespace plumb::harness
