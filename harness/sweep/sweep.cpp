#include "harness/sweep/sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/isolated_run.h"
#include "harness/sweep/cases.h"
#include "harness/sweep/explorer.h"
#include "harness/sweep/front.h"
#include "harness/sweep/importance.h"
#include "harness/sweep/journal.h"
#include "harness/sweep/record.h"
#include "harness/sweep/rows.h"

namespace plumb::harness::sweep {
namespace {

using Clock = std::chrono::steady_clock;

// Largest fraction of an instance's time for one run.
constexpr double kDearest = 0.04;
constexpr std::size_t kAtOnce = 2;  // number of runs between two evaluations of the fronts
constexpr CostBudget kRough{.repetitions = 1, .at_most_ns = 10e6, .at_least_ns = 0.3e6};
constexpr CostBudget kMeasured{.repetitions = 9, .at_most_ns = 15e6, .at_least_ns = 1e6};
// Overhead of a repetition besides stepping: starting and ending a process, and its page faults.
constexpr double kProcess = 4e6;  // ns

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// An engine of an instance that is being explored.
struct Entrant {
  const reference::Backend* backend;
  Explorer explorer;
  bool finished = false;
};

/// One instance's part of the sweep.
class InstanceSweep {
 public:
  InstanceSweep(const SweepOptions& options, const scenarios::Instance& instance, Record& record,
                double seconds)
      : options_(options),
        instance_(instance),
        label_(instance.label()),
        record_(record),
        known_(record.of(label_)),
        cases_(instance, options.ladder, kDearest * seconds),
        seconds_(seconds) {}

  /// Both return false after an interrupt.
  bool explore(const std::function<void(double share, const std::string& what)>& progress);
  bool measure(const std::function<void(double share, const std::string& what)>& progress);

  /// Returns how many settings on the front have no measured cost, because time ran out.
  int dropped() const { return dropped_; }

 private:
  void set_up();
  double exploring_time();
  std::vector<RunRequest> next_runs();
  bool run(const std::vector<RunRequest>& requests);
  void tell_all();
  std::optional<RunRequest> request(Entrant& entrant, const Space::Place& place);
  bool repeat(const std::string& key, int round);
  std::vector<std::string> choose(double seconds);
  double repetition_ns(const Trial& trial) const;

  const SweepOptions& options_;
  const scenarios::Instance& instance_;
  std::string label_;
  Record& record_;
  InstanceRecord& known_;
  Cases cases_;
  double seconds_;
  int dropped_ = 0;
  double explored_ = 0;  // s, spent on exploring
  std::vector<Entrant> entrants_;
  std::size_t turn_ = 0;
};

// Engines that cannot run the scene get one row with the reason.
void InstanceSweep::set_up() {
  for (const reference::Backend* backend : options_.engines) {
    const reference::Identity identity = backend->identity();
    const scenarios::Problem problem = instance_.build();
    std::string reason = identity.available ? "" : "not installed: " + identity.reason;
    Status status = Status::Skipped;
    const reference::StepSettings plain;
    if (identity.available) reason = backend->unsupported(problem.scene, plain);
    if (reason.empty() && !cases_.has_truth() && !cases_.limit(*backend).problem.empty()) {
      reason = fmt::format("{}{}", kNoLimit, cases_.limit(*backend).problem);
      status = Status::Failed;
    }
    if (reason.empty()) {
      entrants_.push_back({backend, Explorer(Space(*backend, options_.ladder)), false});
      continue;
    }
    Trial trial;
    Result& result = trial.result;
    result.scenario = instance_.scenario->name;
    result.variant = instance_.variant;
    result.size = instance_.size;
    result.label = label_;
    result.engine = backend->name();
    result.engine_version = identity.version;
    result.precision = identity.precision;
    result.dt = plain.dt;
    result.duration = problem.duration;
    result.truth = problem.truth.source;
    result.status = status;
    result.reason = reason;
    if (known_.find(key_of(result)) == nullptr) record_.ran(label_, trial);
  }
}

// Passes every run to its explorer, in the headline metric of the rows so far.
void InstanceSweep::tell_all() {
  std::vector<Result> rows;
  for (const Trial& trial : known_.trials) rows.push_back(trial.result);
  const MetricField& metric = headline_metric(rows);
  for (Entrant& entrant : entrants_) {
    for (const Trial& trial : known_.trials) {
      if (trial.result.engine != entrant.backend->name()) continue;
      const auto place = entrant.explorer.space().find(trial.result.asked);
      if (!place) continue;
      const auto error = known_error(trial.result, metric);
      if (trial.result.status == Status::Ok && error && trial.rough.steps > 0) {
        entrant.explorer.tell(*place, *error, trial.rough.ns_per_step / trial.result.dt);
      } else {
        entrant.explorer.fail(*place);
      }
    }
  }
}

std::optional<RunRequest> InstanceSweep::request(Entrant& entrant, const Space::Place& place) {
  const reference::StepSettings settings = entrant.explorer.space().settings(place);
  const Case& scene_case = cases_.at(*entrant.backend, settings.dt);
  // Settings that an engine refuses are not run.
  try {
    entrant.backend->method(settings);
    if (!entrant.backend->unsupported(scene_case.problem.scene, settings).empty()) {
      entrant.explorer.fail(place);
      return {};
    }
  } catch (const Error&) {
    entrant.explorer.fail(place);
    return {};
  }
  return RunRequest{&scene_case, entrant.backend, settings, nullptr, kRough};
}

// Returns a few runs; the engines take turns.
std::vector<RunRequest> InstanceSweep::next_runs() {
  std::vector<RunRequest> out;
  const double duration = instance_.build().duration;
  const double dearest = kDearest * seconds_ * 1e9 / duration;  // ns per simulated second
  for (std::size_t looked = 0; looked < entrants_.size() && out.size() < kAtOnce; ++looked) {
    Entrant& entrant = entrants_[turn_++ % entrants_.size()];
    if (entrant.finished) continue;
    std::optional<Space::Place> place;
    if (entrant.explorer.tried() < options_.most_points) place = entrant.explorer.next(dearest);
    entrant.finished = !place;
    if (!place) continue;
    if (std::optional<RunRequest> next = request(entrant, *place)) {
      out.push_back(std::move(*next));
    }
  }
  return out;
}

bool InstanceSweep::run(const std::vector<RunRequest>& requests) {
  bool interrupted = false;
  const double seconds = std::min(options_.seconds_a_run, std::max(1.0, 5 * kDearest * seconds_));
  run_isolated_all(requests, 1, seconds, [&](std::size_t i, IsolatedRun run) {
    interrupted = interrupted || run.interrupted;
    if (run.interrupted) return;
    if (!cases_.has_truth()) hold_against(run.result, cases_.limit(*requests[i].backend));
    record_.ran(label_, {std::move(run.result), run.rough.value_or(CostSample{}), {}});
  });
  return !interrupted;
}

// Returns the time for exploring, in s. Engines whose runs were taken over from another sweep need none.
double InstanceSweep::exploring_time() {
  if (options_.only_explore > 0)
    return options_.only_explore / static_cast<double>(options_.instances.size());
  if (options_.from.empty()) return kExploring * seconds_;
  std::size_t missing = 0;
  for (Entrant& entrant : entrants_) {
    entrant.finished = std::any_of(known_.trials.begin(), known_.trials.end(), [&](const Trial& trial) {
      return trial.result.engine == entrant.backend->name();
    });
    missing += entrant.finished ? 0 : 1;
  }
  return kExploring * seconds_ * static_cast<double>(missing) /
         static_cast<double>(std::max<std::size_t>(1, entrants_.size()));
}

bool InstanceSweep::explore(const std::function<void(double, const std::string&)>& progress) {
  if (known_.explored) return true;
  const Clock::time_point start = Clock::now();
  set_up();
  const auto open = [&] {
    return std::any_of(entrants_.begin(), entrants_.end(), [](const Entrant& e) { return !e.finished; });
  };
  const double limit = exploring_time();
  while (open() && seconds_since(start) < limit) {
    if (interrupted()) return false;
    tell_all();
    const std::vector<RunRequest> requests = next_runs();
    if (!requests.empty())
      progress(std::min(kExploring, seconds_since(start) / seconds_),
               fmt::format("{} on {}", label_, requests.front().backend->name()));
    if (!run(requests)) return false;
  }
  explored_ = seconds_since(start);
  if (options_.only_explore > 0) {
    record_.explored(label_, {});
    return true;
  }
  record_.explored(label_, choose(std::max((1 - kExploring) * seconds_, seconds_ - explored_)));
  return true;
}

// Returns the expected time of one repetition of a cost, in ns.
double InstanceSweep::repetition_ns(const Trial& trial) const {
  const double whole = trial.rough.ns_per_step * step_count(trial.result.duration, trial.result.dt);
  const double stepping = std::clamp(2 * whole, 2 * kMeasured.at_least_ns, 2 * kMeasured.at_most_ns);
  return kProcess + 2 * trial.rough.setup_ns + stepping;
}

// Chooses the points whose cost will be measured within `seconds`, one engine after another in turn, so that
// none is left out.
std::vector<std::string> InstanceSweep::choose(double seconds) {
  std::vector<Result> rows;
  for (const Trial& trial : known_.trials) {
    rows.push_back(trial.result);
    if (trial.rough.steps > 0) rows.back().cost = summarise({trial.rough}, trial.result.dt);
  }
  const std::vector<Point> all = points_of(rows, headline_metric(rows));
  std::vector<std::vector<Point>> engines;
  for (const std::string& engine : engines_of(rows)) {
    std::vector<Point> own;
    std::copy_if(all.begin(), all.end(), std::back_inserter(own),
                 [&](const Point& point) { return point.row->engine == engine; });
    engines.push_back(by_importance(std::move(own)));
  }
  std::vector<std::string> out;
  double spent = 0;
  for (std::size_t turn = 0; turn < known_.trials.size(); ++turn) {
    for (const std::vector<Point>& points : engines) {
      if (turn >= points.size()) continue;
      const std::string key = key_of(*points[turn].row);
      const double cost = 1e-9 * options_.repetitions * repetition_ns(known_.trials[known_.places.at(key)]);
      if (spent + cost > seconds && !out.empty()) {
        ++dropped_;
        continue;
      }
      spent += cost;
      out.push_back(key);
    }
  }
  return out;
}

// Runs one repetition of one setting; false after an interrupt.
bool InstanceSweep::repeat(const std::string& key, int round) {
  const Trial* trial = known_.find(key);
  if (trial == nullptr || static_cast<int>(trial->samples.size()) > round) return true;
  const Result& result = trial->result;
  const auto backend = std::find_if(options_.engines.begin(), options_.engines.end(),
                                    [&](const auto* engine) { return engine->name() == result.engine; });
  const IsolatedCost cost =
      measure_cost_isolated(cases_.at(**backend, result.dt), **backend, result.asked,
                            trial->rough.ns_per_step, kMeasured, options_.seconds_a_run);
  if (cost.interrupted) return false;
  if (cost.sample) record_.costed(label_, key, *cost.sample);
  return true;
}

bool InstanceSweep::measure(const std::function<void(double, const std::string&)>& progress) {
  if (known_.done) return true;
  const Clock::time_point start = Clock::now();
  const double allowed = std::max(seconds_ - explored_, 0.3 * seconds_);
  for (int round = 0; round < options_.repetitions; ++round) {
    // A copy, because points that no time is left for are removed below.
    const std::vector<std::string> chosen = known_.chosen;
    const double each = (1 - kExploring) / options_.repetitions;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const double share = round + static_cast<double>(i) / static_cast<double>(chosen.size());
      progress(kExploring + each * share, fmt::format("{}: costs, round {}", label_, round + 1));
      if (!repeat(chosen[i], round)) return false;
    }
    const double needed = seconds_since(start) * (options_.repetitions - round) / (round + 1.0);
    const double left = allowed - seconds_since(start);
    if (round > 0 || needed <= left) continue;
    // If the machine is slower than expected, drops the least important points.
    const auto fit =
        static_cast<std::size_t>(static_cast<double>(chosen.size()) * std::max(left, 0.0) / needed);
    const std::size_t least = std::min(chosen.size(), options_.engines.size());
    record_.explored(label_,
                     {chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(std::max(fit, least))});
  }
  record_.done(label_);
  return true;
}

// Returns the rows in the order of the engines, from coarse to fine.
std::vector<Result> rows_of(const InstanceRecord& record, const std::vector<std::string>& engines) {
  std::vector<Result> rows;
  for (const Trial& trial : record.trials) {
    rows.push_back(trial.result);
    const bool chosen =
        std::find(record.chosen.begin(), record.chosen.end(), key_of(trial.result)) != record.chosen.end();
    if (chosen && !trial.samples.empty()) rows.back().cost = summarise(trial.samples, trial.result.dt);
  }
  const auto place = [&](const Result& row) {
    return std::pair(std::find(engines.begin(), engines.end(), row.engine) - engines.begin(), -row.dt);
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const Result& a, const Result& b) { return place(a) < place(b); });
  return rows;
}

// Appends the rows of a complete instance to the results; those already there are skipped.
void append_rows(Journal& results, std::span<const Result> rows) {
  std::set<std::string> there;
  for (const std::string& line : results.lines()) there.insert(key_of(result_from_json(line)));
  for (const Result& row : rows)
    if (!there.contains(key_of(row))) results.append(to_json_with_environment(row));
}

// Returns the settings that must be the same when a sweep resumes. A scene without a known answer comes from
// a file, which may have been edited, so the scene is included.
std::string settings_of(const SweepOptions& options) {
  std::string out =
      fmt::format("{} repetitions, dt {} and finer", options.repetitions, options.ladder.coarsest);
  for (const scenarios::Instance& instance : options.instances)
    if (const scenarios::Problem problem = instance.build(); !problem.truth.exact)
      out +=
          fmt::format(", {} is {:016x} for {:g} s", instance.label(), hash(problem.scene), problem.duration);
  return out;
}

std::set<std::string> labels_of(const std::vector<scenarios::Instance>& instances) {
  std::set<std::string> out;
  for (const scenarios::Instance& instance : instances) out.insert(instance.label());
  return out;
}

std::vector<std::string> names_of(const std::vector<const reference::Backend*>& engines) {
  std::vector<std::string> names;
  for (const reference::Backend* backend : engines) names.emplace_back(backend->name());
  return names;
}

}  // namespace

Swept sweep(const SweepOptions& options, const SweepEvents& events) {
  const std::vector<std::string> engines = names_of(options.engines);
  Record record(options.folder, engines, settings_of(options));
  for (const std::string& folder : options.from) record.take_over(folder, labels_of(options.instances));
  std::optional<Journal> results;
  if (options.only_explore == 0) results.emplace(options.folder + "/results.jsonl");
  Swept out;
  const auto count = [&](bool done) {
    return std::count_if(options.instances.begin(), options.instances.end(),
                         [&](const auto& instance) { return record.of(instance.label()).done == done; });
  };
  const double each = 1.0 / static_cast<double>(options.instances.size());
  // The remaining instances share the budget evenly; unused time goes to the next ones.
  double left = options.budget * each * static_cast<double>(count(false));
  long before = count(true);
  for (const scenarios::Instance& instance : options.instances) {
    const std::string label = instance.label();
    if (!record.of(label).done) {
      const Clock::time_point start = Clock::now();
      const double seconds = left / static_cast<double>(count(false));
      InstanceSweep part(options, instance, record, seconds);
      const auto progress = [&](double share, const std::string& what) {
        const double all = (static_cast<double>(before) + share) * each;
        if (events.progress) events.progress({static_cast<std::size_t>(1000 * all), 1000, what});
      };
      out.interrupted = !part.explore(progress) || (options.only_explore == 0 && !part.measure(progress));
      if (out.interrupted) return out;
      out.dropped += part.dropped();
      left = std::max(left - seconds_since(start), 0.1 * seconds);
      ++before;
    }
    if (!results) continue;
    const std::vector<Result> rows = rows_of(record.of(label), engines);
    append_rows(*results, rows);
    if (events.finished) events.finished(rows);
    out.rows.insert(out.rows.end(), rows.begin(), rows.end());
  }
  return out;
}

}  // namespace plumb::harness::sweep
