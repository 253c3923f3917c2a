#include "harness/thresholds/find.h"

#include <chrono>
#include <cmath>
#include <exception>
#include <vector>

#include "engine/scene/error.h"
#include "harness/isolate.h"
#include "harness/thresholds/trial_run.h"

namespace plumb::harness::thresholds {
namespace {

double resolution_of(const FindOptions& options) { return std::pow(10.0, -options.digits); }

/// Returns the facts known before the first run; the outcome is "refused" if the engine cannot run the scene
/// at the holding end.
Finding described(const Request& request, const FindOptions& options) {
  const Threshold& threshold = *request.threshold;
  Finding out{.name = threshold.name,
              .title = threshold.title,
              .quantity = threshold.quantity,
              .unit = threshold.unit,
              .source = threshold.source,
              .judged = threshold.judged,
              .holds_below = threshold.range.holds_below,
              .engine = std::string(request.backend->name()),
              .setting = request.setting,
              .digits = options.digits,
              .low = threshold.range.low,
              .high = threshold.range.high};
  const auto refuse = [&](std::string reason) {
    out.outcome = Finding::Outcome::Refused;
    out.reason = std::move(reason);
  };
  try {
    const reference::Identity identity = request.backend->identity();
    out.engine_version = identity.version;
    const Trial trial = threshold.build(
        threshold.range.holds_below ? threshold.range.low : threshold.range.high, resolution_of(options));
    if (!identity.available) {
      refuse(identity.reason);
    } else if (std::string reason = request.backend->unsupported(trial.scene, request.settings);
               !reason.empty()) {
      refuse(std::move(reason));
    } else {
      out.settings = request.backend->effective_settings(trial.scene, request.settings);
      out.exact = threshold.exact(request.backend->method(request.settings));
    }
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  return out;
}

Finding::Outcome outcome_of(Ending ending) {
  switch (ending) {
    case Ending::Found:
      return Finding::Outcome::Found;
    case Ending::Always:
      return Finding::Outcome::Always;
    case Ending::Never:
      return Finding::Outcome::Never;
    case Ending::Unclear:
      break;
  }
  return Finding::Outcome::Unclear;
}

Finding search(Finding finding, const Request& request, const FindOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  SearchRange range = request.threshold->range;
  range.resolution = resolution_of(options);
  const Crossing crossing = find_crossing(range, [&](double value) {
    return run_isolated(*request.threshold, value, range.resolution, *request.backend, request.settings,
                        options.seconds_a_run);
  });
  finding.outcome = outcome_of(crossing.ending);
  if (std::isfinite(crossing.value)) finding.found = crossing.value;
  finding.low = crossing.low;
  finding.high = crossing.high;
  finding.reason = crossing.reason;
  finding.runs = crossing.runs;
  finding.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return finding;
}

}  // namespace

Finding find_one(const Request& request, const FindOptions& options) {
  Finding finding = described(request, options);
  return finding.outcome == Finding::Outcome::Refused ? finding
                                                      : search(std::move(finding), request, options);
}

// Runs each search in a process that starts processes for its runs. If it is killed, its runs are killed too.
void find_all(std::span<const Request> requests, const FindOptions& options,
              const std::function<void(std::size_t, const std::optional<Finding>&)>& done) {
  std::vector<Finding> findings;
  std::vector<std::size_t> to_search;
  // Described here, so that an engine's program is queried only once.
  for (std::size_t i = 0; i < requests.size(); ++i) {
    findings.push_back(described(requests[i], options));
    if (findings.back().outcome == Finding::Outcome::Refused) {
      done(i, findings.back());
    } else {
      to_search.push_back(i);
    }
  }
  const double seconds = kMostRuns * (options.seconds_a_run + 1);
  isolate_all(
      to_search.size(), options.jobs, seconds,
      [&](std::size_t i) { return to_json(search(findings[to_search[i]], requests[to_search[i]], options)); },
      [&](std::size_t i, const Outcome& outcome) {
        Finding& finding = findings[to_search[i]];
        if (outcome.kind == Outcome::Kind::Interrupted) return done(to_search[i], std::nullopt);
        if (outcome.kind == Outcome::Kind::Done) {
          finding = finding_from_json(outcome.text);
        } else {
          finding.outcome = Finding::Outcome::Unclear;
          finding.reason = outcome.text;
        }
        done(to_search[i], finding);
      });
}

}  // namespace plumb::harness::thresholds
