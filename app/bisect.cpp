#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/npm.h"
#include "app/output.h"
#include "app/progress_line.h"
#include "app/selection.h"
#include "app/source.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/isolated_run.h"
#include "harness/style.h"
#include "reference/node_engines.h"

namespace plumb::app {
namespace {

using harness::Check;
using harness::Result;
using harness::Status;

struct BisectOptions {
  std::string name, engine, check, from, to, dt, timeout;
  int size = 0;
};

/// Runs of one case on versions of one engine, each made once.
class Runs {
 public:
  Runs(const BisectOptions& options, reference::NodeEngine engine, bool out_of_the_box)
      : engine_(std::move(engine)), prefix_(engine_.name + (out_of_the_box ? "-default" : "")) {
    if (!options.dt.empty()) settings_.dt = parse_positive("--dt", options.dt);
    if (!options.timeout.empty()) seconds_ = parse_positive("--timeout", options.timeout);
    const std::vector<std::string> files = case_files(options.name);
    if (files.size() > 1)
      throw UsageError(fmt::format("'{}' has {} cases; bisect takes one", options.name, files.size()));
    case_ = std::make_unique<harness::Case>(files.empty()
                                                ? one_instance(options.name, options.size)
                                                : chosen_instances({files.front()}, options.size).front(),
                                            settings_.dt);
  }

  const std::string& label() const { return case_->label; }

  const Result& of(const std::string& version) {
    const auto found = results_.find(version);
    if (found != results_.end()) return found->second;
    progress_.say(fmt::format("{} on {}@{}", case_->label, prefix_, version));
    install({engine_, version});
    const reference::Backend& backend = reference::find_backend(prefix_ + "@" + version);
    harness::IsolatedRun run = harness::run_isolated(*case_, backend, settings_, nullptr, seconds_);
    progress_.clear();
    return results_[version] = std::move(run.result);
  }

 private:
  reference::NodeEngine engine_;
  std::string prefix_;
  reference::StepSettings settings_{};
  double seconds_ = 60;
  std::unique_ptr<harness::Case> case_;
  std::map<std::string, Result> results_;
  ProgressLine progress_;
};

// Returns the missed check called `name`, or the worst of the missed ones; null if there is none.
const Check* missed(const Result& result, const std::string& name) {
  const Check* worst = nullptr;
  for (const Check& check : result.checks) {
    if (check.pass || (!name.empty() && check.name != name)) continue;
    if (worst == nullptr || check.value * worst->tolerance > worst->value * check.tolerance) worst = &check;
  }
  return worst;
}

bool could_run(const Result& result) {
  return result.status == Status::Ok || result.status == Status::Diverged;
}

std::string figures(const Result& result, const std::string& check) {
  if (!could_run(result)) return fmt::format("{}: {}", harness::name_of(result.status), result.reason);
  const Check* found = result.find_check(check);
  if (found == nullptr) return std::string(harness::name_of(result.status));
  return fmt::format("{} {:.3g} (bound {:.3g}){}", check, found->value, found->tolerance,
                     found->pass ? "" : ": misses");
}

int start_bisect(const BisectOptions& options) {
  std::string name = options.engine;
  const bool out_of_the_box = name.ends_with("-default");
  if (out_of_the_box) name.resize(name.size() - std::string("-default").size());
  const NamedVersion wanted = named_version(name);
  Runs runs(options, wanted.engine, out_of_the_box);
  harness::catch_interrupts();
  std::vector<std::string> versions = published_versions(wanted.engine);
  std::erase_if(versions, [&](const std::string& version) {
    return (!options.from.empty() && reference::older(version, options.from)) ||
           (!options.to.empty() && reference::older(options.to, version));
  });
  // Versions on which the adapter or the case does not run give no answer.
  while (!versions.empty() && !could_run(runs.of(versions.back()))) {
    notice(fmt::format("{}@{}: {}", options.engine, versions.back(), figures(runs.of(versions.back()), "")));
    versions.pop_back();
  }
  if (versions.empty()) throw UsageError("no version runs this case");
  const Check* newest = missed(runs.of(versions.back()), options.check);
  if (newest == nullptr) {
    print(fmt::format("{}: {}@{} misses nothing{}\n", runs.label(), options.engine, versions.back(),
                      options.check.empty() ? "" : " in " + options.check));
    return kCheckFailed;
  }
  // If every version misses a check, no version introduced it; another missed check of the newest version may
  // have one.
  std::size_t low = 0, high = versions.size() - 1;
  while (low < high && !could_run(runs.of(versions[low]))) ++low;
  std::string check;
  for (const Check& each : runs.of(versions.back()).checks) {
    if (each.pass || (!options.check.empty() && each.name != options.check)) continue;
    const Check* then = runs.of(versions[low]).find_check(each.name);
    if (then != nullptr && then->pass && check.empty()) check = each.name;
  }
  if (check.empty()) {
    print(fmt::format("{}: {}@{} misses already: {}\n", runs.label(), options.engine, versions[low],
                      figures(runs.of(versions[low]), newest->name)));
    return kCheckFailed;
  }
  while (high - low > 1 && !harness::interrupted()) {
    const std::size_t middle = low + (high - low) / 2;
    const Result& result = runs.of(versions[middle]);
    if (!could_run(result)) {
      versions.erase(versions.begin() + static_cast<std::ptrdiff_t>(middle));
      --high;
      continue;
    }
    const Check* found = result.find_check(check);
    (found != nullptr && found->pass ? low : high) = middle;
  }
  if (harness::interrupted()) return kInterrupted;
  for (const std::size_t i : {low, high})
    print(fmt::format("{:<12} {}\n", versions[i], figures(runs.of(versions[i]), check)));
  print(fmt::format("{}: {} {} is the first version that misses {}\n", runs.label(), options.engine,
                    versions[high], check));
  return kOk;
}

}  // namespace

void add_bisect(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "bisect",
      "find the first version of an engine from npm that misses a bound, by installing and running versions");
  auto options = std::make_shared<BisectOptions>();
  command->add_option("case", options->name, "a scenario or a case file")->required()->type_name("NAME|FILE");
  command->add_option("engine", options->engine, "an engine from npm, see `plumb engines`")
      ->required()
      ->type_name("E");
  command
      ->add_option("--check", options->check,
                   "which check (default: the first that the oldest version does not miss)")
      ->type_name("CHECK");
  command->add_option("--from", options->from, "the oldest version to try")->type_name("V");
  command->add_option("--to", options->to, "the newest version to try")->type_name("V");
  command->add_option("--dt", options->dt, "step in s (default 1/60)")->type_name("DT");
  command->add_option("--timeout", options->timeout, "s after which a run is stopped (default 60)")
      ->type_name("T");
  add_size(*command, options->size);
  command->footer(
      "Examples:\n  plumb bisect elastic_collision/cradle rapier\n  plumb bisect my_case.json rapier --from "
      "0.17.3 --to "
      "0.21.0\nExit codes: 0 found, 1 no version introduced a miss, 2 usage, 130 interrupted.");
  command->callback([&chosen, options] { chosen = [options] { return start_bisect(*options); }; });
}

}  // namespace plumb::app
