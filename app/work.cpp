#include "harness/cluster/work.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/usage.h"
#include "harness/interrupt.h"

namespace plumb::app {
namespace {

namespace cluster = harness::cluster;

constexpr useconds_t kShortest = 100'000, kLongest = 3'000'000;  // us between looks at others' claims

struct WorkCommandOptions {
  std::string folder, kind, calibration, expiry;
  int unit = 0, attempts = cluster::kAttempts;
  bool next = false, all = false, again = false;
};

// Reports the outcome of a unit; returns the exit code.
int tell(const std::string& folder, int number, cluster::Worked worked) {
  switch (worked) {
    case cluster::Worked::Done:
      print(fmt::format("unit {} is done\n", number));
      break;
    case cluster::Worked::Before:
      print(fmt::format("unit {} was already done\n", number));
      break;
    case cluster::Worked::Failed: {
      const cluster::Failure failure = cluster::read_failure(folder, number).value_or(cluster::Failure{});
      notice(fmt::format("unit {} failed: {}{}", number, failure.kind,
                         failure.message.empty() ? "" : ": " + failure.message));
      flush();
      return kCheckFailed;
    }
    case cluster::Worked::Interrupted:
      notice(fmt::format("interrupted; unit {} can be claimed again", number));
      return kInterrupted;
    case cluster::Worked::Elsewhere:
      break;
  }
  flush();
  return kOk;
}

int do_all(const std::string& folder, const cluster::Plan& plan, const cluster::WorkOptions& how) {
  cluster::Queue queue(folder, plan, how);
  useconds_t pause = kShortest;
  while (!harness::interrupted()) {
    cluster::Worked worked{};
    if (const std::optional<int> number = queue.next(worked)) {
      if (tell(folder, *number, worked) == kInterrupted) return kInterrupted;
      pause = kShortest;
      continue;
    }
    if (!queue.waits()) return kOk;
    usleep(pause);  // other processes are working, and their claims may expire
    pause = std::min(2 * pause, kLongest);
  }
  return kInterrupted;
}

int start_work(const WorkCommandOptions& options) {
  if ((options.unit > 0 ? 1 : 0) + (options.next ? 1 : 0) + (options.all ? 1 : 0) != 1)
    throw UsageError("work takes one of --unit K, --next and --all");
  if (options.again && options.unit == 0) throw UsageError("--again needs --unit K");
  const std::string folder = std::filesystem::absolute(options.folder).lexically_normal().string();
  const cluster::Plan plan = cluster::read_plan(folder);
  cluster::require_same_program(options.folder, plan, cluster::this_program());
  cluster::WorkOptions how{.kind = options.kind, .attempts = options.attempts, .again = options.again};
  if (!options.calibration.empty()) how.calibration = parse_positive("--calibration", options.calibration);
  if (!options.expiry.empty()) how.expiry = parse_positive("--expiry", options.expiry);
  harness::catch_interrupts();
  if (options.all) return do_all(folder, plan, how);
  if (options.unit > 0)
    return tell(folder, options.unit, cluster::do_unit(folder, plan, plan.unit(options.unit), how, true));
  cluster::Worked worked{};
  const std::optional<int> number = cluster::Queue(folder, plan, how).next(worked);
  if (number) return tell(folder, *number, worked);
  notice("no unit is free; `plumb status` says why");
  return kNothingFree;
}

}  // namespace

void add_work(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("work", "run units of a folder that `plumb plan` wrote");
  auto options = std::make_shared<WorkCommandOptions>();
  command->add_option("folder", options->folder, "folder of work")->required()->type_name("FOLDER");
  command
      ->add_option("--unit", options->unit,
                   "run this unit even if another process claims it; finished units are not run again")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->type_name("K");
  command->add_flag("--next", options->next, "run the longest free unit");
  command->add_flag("--all", options->all, "run one unit after the other until none is left");
  command->add_flag("--again", options->again, "with --unit: measure again; the new results replace the old");
  command->add_option("--kind", options->kind, "kind of this machine (default: the processor's name)")
      ->type_name("NAME");
  command
      ->add_option("--attempts", options->attempts, "skip a unit after this number of failures (default 3)")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->type_name("N");
  command
      ->add_option("--expiry", options->expiry,
                   "age in s at which a claim that is not renewed expires, because its machine is taken for "
                   "dead (default 300)")
      ->type_name("T");
  command
      ->add_option("--calibration", options->calibration,
                   "duration of the calibration in s, half before and half after a unit (default 1)")
      ->type_name("T");
  command->footer(
      "Examples:\n  plumb work FOLDER --unit 17\n  plumb work FOLDER --all\nAny number of processes may run "
      "at once, on any machine that sees the folder. If one is killed, only the unit\nthat it runs is lost. "
      "See docs/cluster.md. Exit codes: 0 done, 1 the unit failed, 2 usage or another\nprogram, 3 no unit is "
      "free, 130 interrupted.");
  command->callback([&chosen, options] { chosen = [options] { return start_work(*options); }; });
}

}  // namespace plumb::app
