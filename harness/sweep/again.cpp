#include "harness/sweep/again.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/isolated_run.h"
#include "harness/sweep/cases.h"
#include "harness/sweep/rows.h"

namespace plumb::harness::sweep {
namespace {

const reference::Backend* engine_of(const Result& row, const AgainOptions& options) {
  const auto found =
      std::ranges::find_if(options.engines, [&](const auto* engine) { return engine->name() == row.engine; });
  return found == options.engines.end() ? nullptr : *found;
}

const scenarios::Instance* instance_of(const Result& row, const AgainOptions& options) {
  const auto found = std::ranges::find_if(
      options.instances, [&](const scenarios::Instance& one) { return one.label() == row.label; });
  return found == options.instances.end() ? nullptr : &*found;
}

// Repeats the failure of a row whose reference cannot be computed (see `Cases::sampled`), with the same
// error.
Result failed_again(const Result& row, const Error& error) {
  Result out = row;
  out.cost.reset();
  out.status = Status::Failed;
  out.reason = error.what();
  return out;
}

}  // namespace

bool run_again(std::span<const Result> rows, const AgainOptions& options, const CompareEvents& events) {
  Progress progress{0, rows.size(), ""};
  for (const std::vector<Result>& scene : by_label(rows)) {
    const std::size_t before = progress.done;
    const scenarios::Instance* instance = instance_of(scene.front(), options);
    std::vector<Result> made;
    if (instance != nullptr) {
      Cases cases(*instance, Ladder{}, options.seconds_a_run);
      // Runs against the engine's own limit are repeated against the same run; others that have no truth,
      // against none.
      std::map<double, std::unique_ptr<Case>> without;  // by sample
      std::vector<RunRequest> requests;
      std::vector<bool> own;  // by request
      for (const Result& row : scene) {
        const reference::Backend* engine = engine_of(row, options);
        if (engine == nullptr) continue;
        const bool has_own = !cases.has_truth() && row.truth_asked.has_value();
        try {
          const Case* compared = nullptr;
          if (has_own) cases.take_limit(*engine, *row.truth_asked);
          if (has_own || cases.has_truth()) {
            compared = &cases.sampled(*engine, row.sample);
          } else {
            std::unique_ptr<Case>& mine = without[row.sample];
            if (!mine) mine = std::make_unique<Case>(*instance, row.sample);
            compared = mine.get();
          }
          requests.push_back({compared, engine, row.asked});
          own.push_back(has_own);
        } catch (const Error& error) {
          if (interrupted()) return false;
          made.push_back(failed_again(row, error));
        }
      }
      bool stopped = false;
      const auto show = [&] {
        progress.done = before + made.size();
        progress.what = fmt::format("{} again", scene.front().label);
        if (events.progress) events.progress(progress);
      };
      show();
      run_isolated_all(requests, options.jobs, options.seconds_a_run, [&](std::size_t i, IsolatedRun run) {
        stopped = stopped || run.interrupted;
        if (run.interrupted) return;
        if (own[i]) hold_against(run.result, cases.limit(*requests[i].backend));
        judge(run.result, is_default(run.result.asked));
        made.push_back(std::move(run.result));
        show();
      });
      if (stopped || interrupted()) return false;
    }
    if (events.finished && !made.empty()) events.finished(made);
    progress.done = before + scene.size();
  }
  return true;
}

}  // namespace plumb::harness::sweep
