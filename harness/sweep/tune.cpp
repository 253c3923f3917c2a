#include "harness/sweep/tune.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/isolated_run.h"
#include "harness/sweep/cases.h"
#include "harness/sweep/explorer.h"
#include "harness/sweep/front.h"

namespace plumb::harness::sweep {
namespace {

using Clock = std::chrono::steady_clock;

constexpr CostBudget kRough{.repetitions = 1, .at_most_ns = 10e6, .at_least_ns = 0.3e6};
constexpr CostBudget kMeasured{.repetitions = 9, .at_most_ns = 15e6, .at_least_ns = 1e6};
// Largest fraction of the search's time for one run.
constexpr double kDearest = 0.06;
// Number of best settings whose costs are measured well, because rough costs do not rank them reliably.
constexpr std::size_t kFinalists = 3;
constexpr int kRungs = 11;
// Fraction of the time that the search may take; the rest is for measuring costs and for the last runs.
constexpr double kSearching = 0.6;
// Minimum number of rounds of a cost's measurement: fewer cannot show the noise.
constexpr int kFewestRounds = 3;
constexpr std::size_t kMostTried = 64;

struct Trial {
  Result row;
  double error = 0, rough_ns = 0;  // a step of dt
  std::vector<CostSample> samples{};

  double ns_a_second() const {
    return samples.empty() ? rough_ns / row.dt : summarise(samples, row.dt).ns_per_simulated_second;
  }
};

struct Entrant {
  const reference::Backend* backend = nullptr;
  Explorer explorer;
  std::vector<Trial> trials{};  // that ran to their end
  std::string problem{};
  std::string last_failure{};
  bool finished = false;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Tuner {
 public:
  explicit Tuner(const TuneOptions& options)
      : options_(options),
        ladder_{.coarsest = options.step, .rungs = kRungs},
        cases_(options.instance, ladder_, kDearest * options.seconds) {
    if (options.tolerance) goal_.error = std::max(*options.tolerance, kErrorFloor);
    if (options.budget_ns) goal_.cost = *options.budget_ns / options.step;
  }

  Tuned run(const std::function<void(const std::string&)>& progress);

 private:
  void enter();
  bool search(const std::function<void(const std::string&)>& progress);
  bool measure(const std::function<void(const std::string&)>& progress);
  std::vector<std::pair<Entrant*, RunRequest>> next_runs();
  void take(Entrant& entrant, IsolatedRun run);
  bool meets(const Trial& trial) const;
  bool better(const Trial& a, const Trial& b) const;
  void fill(TuneAnswer& answer, const Trial& trial) const;
  TuneAnswer answer(Entrant& entrant);
  void confirm(const Entrant& entrant, TuneAnswer& answer);

  const TuneOptions& options_;
  Ladder ladder_;
  Cases cases_;
  Explorer::Goal goal_;
  std::vector<Entrant> entrants_;
  Clock::time_point start_ = Clock::now();
};

void Tuner::enter() {
  const scenarios::Problem problem = options_.instance.build();
  for (const reference::Backend* backend : options_.engines) {
    const reference::Identity identity = backend->identity();
    std::string why = identity.available ? "" : "not installed: " + identity.reason;
    if (why.empty()) why = backend->unsupported(problem.scene, {.dt = options_.step});
    if (why.empty() && !cases_.has_truth()) {
      const OwnLimit& limit = cases_.limit(*backend);
      why = limit.problem.empty() ? "" : "its solutions do not converge: " + limit.problem;
      // The uncertainty of the limit is also an uncertainty of the errors.
      const double within = (limit.within.*options_.metric->value).value_or(0);
      if (why.empty() && goal_.error && within > *goal_.error / 2)
        why = fmt::format("{}: not accurate enough for this tolerance", limit.source);
    }
    entrants_.push_back({.backend = backend, .explorer = Explorer(Space(*backend, ladder_))});
    entrants_.back().problem = why;
    entrants_.back().finished = !why.empty();
  }
}

std::vector<std::pair<Entrant*, RunRequest>> Tuner::next_runs() {
  std::vector<std::pair<Entrant*, RunRequest>> out;
  const double dearest = kDearest * options_.seconds * 1e9 / options_.instance.build().duration;
  for (Entrant& entrant : entrants_) {
    if (entrant.finished) continue;
    std::optional<Space::Place> place;
    if (entrant.explorer.tried() < kMostTried) place = entrant.explorer.next_towards(goal_, dearest);
    entrant.finished = !place;
    if (!place) continue;
    const reference::StepSettings settings = entrant.explorer.space().settings(*place);
    const Case& scene_case = cases_.at(*entrant.backend, settings.dt);
    out.push_back({&entrant, RunRequest{&scene_case, entrant.backend, settings, nullptr, kRough}});
  }
  return out;
}

void Tuner::take(Entrant& entrant, IsolatedRun run) {
  const auto place = entrant.explorer.space().find(run.result.asked);
  if (!cases_.has_truth()) hold_against(run.result, cases_.limit(*entrant.backend));
  const auto error = known_error(run.result, *options_.metric);
  if (run.result.status != Status::Ok || !error || !std::isfinite(*error) || !run.rough) {
    entrant.explorer.fail(*place);
    entrant.last_failure = run.result.status == Status::Ok
                               ? fmt::format("{} does not apply to this scene", options_.metric->name)
                               : fmt::format("{}: {}", name_of(run.result.status), run.result.reason);
    return;
  }
  entrant.explorer.tell(*place, *error, run.rough->ns_per_step / run.result.dt);
  entrant.trials.push_back({std::move(run.result), *error, run.rough->ns_per_step});
}

bool Tuner::search(const std::function<void(const std::string&)>& progress) {
  while (seconds_since(start_) < kSearching * options_.seconds) {
    if (interrupted()) return false;
    const auto runs = next_runs();
    if (runs.empty()) break;
    std::vector<RunRequest> requests;
    for (const auto& [entrant, request] : runs) requests.push_back(request);
    if (progress) progress(fmt::format("searching: {} engines left", runs.size()));
    bool stopped = false;
    run_isolated_all(requests, options_.jobs, options_.seconds_a_run, [&](std::size_t i, IsolatedRun run) {
      stopped = stopped || run.interrupted;
      if (!run.interrupted) take(*runs[i].first, std::move(run));
    });
    if (stopped) return false;
  }
  return true;
}

// Compares a trial with the goal itself, even if that is below the error floor of the search.
bool Tuner::meets(const Trial& trial) const {
  return options_.tolerance ? trial.error <= *options_.tolerance : trial.ns_a_second() <= *goal_.cost;
}

// Returns true if `a` is nearer to the goal. If both meet it, that is the cheaper or the more accurate one,
// else the one that misses by less.
bool Tuner::better(const Trial& a, const Trial& b) const {
  const bool a_meets = meets(a);
  if (a_meets != meets(b)) return a_meets;
  const bool by_cost = options_.tolerance.has_value() == a_meets;
  return by_cost || a.error == b.error ? a.ns_a_second() < b.ns_a_second() : a.error < b.error;
}

bool Tuner::measure(const std::function<void(const std::string&)>& progress) {
  std::vector<std::pair<const Entrant*, Trial*>> finalists;
  for (Entrant& entrant : entrants_) {
    std::stable_sort(entrant.trials.begin(), entrant.trials.end(),
                     [&](const Trial& a, const Trial& b) { return better(a, b); });
    for (std::size_t i = 0; i < std::min(kFinalists, entrant.trials.size()); ++i)
      finalists.push_back({&entrant, &entrant.trials[i]});
  }
  // Collects the samples separately first, because a trial's rough cost orders the trials until all are
  // measured.
  std::vector<std::vector<CostSample>> samples(finalists.size());
  // Keeps to the total time: the search leaves a part of it, and a round begins only if it will probably end
  // in time.
  const Clock::time_point begin = Clock::now();
  for (int round = 0; round < options_.repetitions; ++round) {
    const double each = round == 0 ? 0 : seconds_since(begin) / round;
    if (round >= kFewestRounds && seconds_since(start_) + each > options_.seconds) break;
    if (progress) progress(fmt::format("measuring: {} of {} rounds", round, options_.repetitions));
    for (std::size_t i = 0; i < finalists.size(); ++i) {
      const auto& [entrant, trial] = finalists[i];
      const IsolatedCost cost =
          measure_cost_isolated(cases_.at(*entrant->backend, trial->row.dt), *entrant->backend,
                                trial->row.asked, trial->rough_ns, kMeasured, options_.seconds_a_run);
      if (cost.interrupted) return false;
      if (cost.sample) samples[i].push_back(*cost.sample);
    }
  }
  for (std::size_t i = 0; i < finalists.size(); ++i) finalists[i].second->samples = std::move(samples[i]);
  return true;
}

// Repeats the answer's run. An answer that misses the goal in the second run is rejected.
void Tuner::confirm(const Entrant& entrant, TuneAnswer& answer) {
  const Case& scene_case = cases_.at(*entrant.backend, answer.row.dt);
  IsolatedRun again =
      run_isolated(scene_case, *entrant.backend, answer.row.asked, nullptr, options_.seconds_a_run);
  if (!cases_.has_truth()) hold_against(again.result, cases_.limit(*entrant.backend));
  const auto error = known_error(again.result, *options_.metric);
  const bool ran = again.result.status == Status::Ok && error && std::isfinite(*error);
  answer.confirmed =
      ran && std::bit_cast<std::uint64_t>(*error) == std::bit_cast<std::uint64_t>(answer.error);
  answer.found = answer.confirmed;
  if (answer.found) return;
  if (ran) answer.error = std::max(answer.error, *error);
  answer.found = ran && (!options_.tolerance || *error <= *options_.tolerance);
  if (answer.found) return;
  const std::string what =
      ran ? fmt::format("reached {}", figure(*error))
      : again.result.status == Status::Ok
          ? fmt::format("gave no {}", options_.metric->name)
          : fmt::format("ended as {}: {}", name_of(again.result.status), again.result.reason);
  answer.problem = fmt::format("{}: these settings met it once, but a second run {}",
                               settings_text(answer.row.asked), what);
}

void Tuner::fill(TuneAnswer& answer, const Trial& trial) const {
  answer.row = trial.row;
  answer.row.cost = summarise(trial.samples, trial.row.dt);
  answer.error = trial.error;
  answer.ns_a_step = trial.ns_a_second() * options_.step;
}

TuneAnswer Tuner::answer(Entrant& entrant) {
  TuneAnswer out;
  out.engine = entrant.backend->name();
  out.problem = entrant.problem;
  out.tried = static_cast<int>(entrant.explorer.tried());
  std::vector<const Trial*> measured;
  for (const Trial& trial : entrant.trials)
    if (!trial.samples.empty()) measured.push_back(&trial);
  std::stable_sort(measured.begin(), measured.end(),
                   [&](const Trial* a, const Trial* b) { return better(*a, *b); });
  for (const Trial* trial : measured) {
    if (!meets(*trial)) break;
    fill(out, *trial);
    confirm(entrant, out);
    if (out.found || interrupted()) return out;
  }
  if (measured.empty()) {
    if (out.problem.empty())
      out.problem = entrant.last_failure.empty() ? "no run finished in time" : entrant.last_failure;
    return out;
  }
  if (meets(*measured.front())) return out;  // none of the settings that met the goal met it twice
  fill(out, *measured.front());
  out.problem =
      options_.tolerance
          ? fmt::format("the most accurate of {} settings reaches {}", out.tried, figure(out.error))
          : fmt::format("the cheapest of {} settings costs {}", out.tried, duration_text(out.ns_a_step));
  return out;
}

Tuned Tuner::run(const std::function<void(const std::string&)>& progress) {
  Tuned out;
  out.has_truth = cases_.has_truth();
  enter();
  if (!search(progress) || !measure(progress)) {
    out.interrupted = true;
    return out;
  }
  for (Entrant& entrant : entrants_) out.answers.push_back(answer(entrant));
  out.interrupted = interrupted();
  if (out.interrupted) return out;
  std::stable_sort(out.answers.begin(), out.answers.end(), [&](const TuneAnswer& a, const TuneAnswer& b) {
    if (a.found != b.found) return a.found;
    if (!a.found) return false;
    return goal_.error || a.error == b.error ? a.ns_a_step < b.ns_a_step : a.error < b.error;
  });
  return out;
}

}  // namespace

Tuned tune(const TuneOptions& options, const std::function<void(const std::string&)>& progress) {
  return Tuner(options).run(progress);
}

}  // namespace plumb::harness::sweep
