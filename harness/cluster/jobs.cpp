#include "harness/cluster/jobs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace plumb::harness::cluster {
namespace {

constexpr double kMargin = 3,
                 kExtra = 120;  // factor on an estimate (often from another machine), and s that are added

// Formats a time as D-HH:MM:SS, days and hours as schedulers want them.
std::string clock_text(int seconds) {
  return fmt::format("{}-{:02}:{:02}:{:02}", seconds / 86400, seconds / 3600 % 24, seconds / 60 % 60,
                     seconds % 60);
}

std::string partition_line(const JobOptions& options) {
  return options.partition.empty() ? "" : fmt::format("#SBATCH --partition={}\n", options.partition);
}

// Returns the lines of a script that plan the next round and submit it.
std::string further_text(const Plan& plan, const JobOptions& options, const std::string& how) {
  return fmt::format(
      R"(# What the results call for: the costs of a sweep, units that were disturbed. Exit code 3: nothing.
if {program} plan {folder} --next; then
  exec {program} submit {folder} --out {out} {how}
fi
)",
      fmt::arg("program", quoted_for_shell(plan.program.path)),
      fmt::arg("folder", quoted_for_shell(options.folder)), fmt::arg("out", quoted_for_shell(options.out)),
      fmt::arg("how", how));
}

double longest_task(const Plan& plan, const std::vector<int>& units) {
  const auto each = static_cast<std::size_t>(units_a_task(units.size()));
  double longest = 0;
  for (std::size_t i = 0; i < units.size(); i += each) {
    double task = 0;
    for (std::size_t j = i; j < std::min(i + each, units.size()); ++j)
      task += plan.unit(units[j]).seconds + 1;
    longest = std::max(longest, task);
  }
  return longest;
}

}  // namespace

int units_a_task(std::size_t units) {
  return std::max(1, static_cast<int>((units + kMostTasks - 1) / kMostTasks));
}

int time_limit(const Plan& plan, const std::vector<int>& units) {
  return 60 * static_cast<int>(std::ceil((kMargin * longest_task(plan, units) + kExtra) / 60));
}

std::string quoted_for_shell(const std::string& text) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("/._-+=,:@").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

std::string array_script(const Plan& plan, const std::vector<int>& units, const JobOptions& options) {
  const int each = units_a_task(units.size());
  const int tasks = static_cast<int>(units.size() + static_cast<std::size_t>(each) - 1) / each;
  const std::string throttle = options.at_once > 0 ? fmt::format("%{}", options.at_once) : "";
  return fmt::format(
      R"(#!/bin/bash
# Units of {folder} as a job array. Edit it as you like; `bash submit.sh` beside it submits it.
# A unit that is done is not done again, so that any task may be repeated at any time.
#SBATCH --job-name=plumb
#SBATCH --array=1-{tasks}{throttle}
#SBATCH --time={time}
#   that is 3 times the {longest:.1f} s estimated for the longest task, and two minutes
#SBATCH --mem={memory}M
{alone}{partition}{exclude}#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={log}
set -u
list={list}
each={each}  # units of a task
first=$(((SLURM_ARRAY_TASK_ID - 1) * each + 1))
failed=0
for unit in $(sed -n "${{first}},$((first + each - 1))p" "$list"); do
  {program} work {folder_quoted} --unit "$unit" || failed=1
done
# Slurm repeats a task whose node died; one that failed is put back here, twice.
if [[ $failed -ne 0 && ${{SLURM_RESTART_COUNT:-0}} -lt 2 ]]; then
  scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}"
fi
exit $failed
)",
      fmt::arg("folder", options.folder), fmt::arg("tasks", tasks), fmt::arg("throttle", throttle),
      fmt::arg("time", clock_text(time_limit(plan, units))), fmt::arg("longest", longest_task(plan, units)),
      fmt::arg("memory", options.memory),
      fmt::arg("exclude", options.exclude.empty()
                              ? ""
                              : fmt::format("#SBATCH --exclude={}\n#   there the units were "
                                            "disturbed before\n",
                                            options.exclude)),
      fmt::arg("alone", plan.measures_cost(units)
                            ? "#SBATCH --exclusive\n#   costs are measured: no other job on the node\n"
                            : "#SBATCH --cpus-per-task=1\n"),
      fmt::arg("partition", partition_line(options)), fmt::arg("log", options.place + "/log/%A_%a.txt"),
      fmt::arg("list", quoted_for_shell(options.place + "/units.txt")), fmt::arg("each", each),
      fmt::arg("program", quoted_for_shell(plan.program.path)),
      fmt::arg("folder_quoted", quoted_for_shell(options.folder)));
}

std::string gather_script(const Plan& plan, const JobOptions& options) {
  std::string how = fmt::format("--on slurm --memory {}", options.memory);
  if (options.at_once > 0) how += fmt::format(" --nodes {}", options.at_once);
  if (!options.partition.empty()) how += " --partition " + quoted_for_shell(options.partition);
  return fmt::format(
      R"(#!/bin/bash
# Merges what is done; run it again whenever more is. It says what is missing.
#SBATCH --job-name=plumb-gather
#SBATCH --time=0-02:00:00
#SBATCH --mem={memory}M
{partition}#SBATCH --output={place}/log/gather.txt
{program} gather {folder} --out {out}
{further})",
      fmt::arg("further", further_text(plan, options, how)), fmt::arg("memory", options.memory),
      fmt::arg("partition", partition_line(options)), fmt::arg("place", options.place),
      fmt::arg("program", quoted_for_shell(plan.program.path)),
      fmt::arg("folder", quoted_for_shell(options.folder)), fmt::arg("out", quoted_for_shell(options.out)));
}

std::string slurm_script(const JobOptions& options) {
  return fmt::format(
      R"(#!/bin/bash
# Submits the array, and after it, whatever came of its tasks, the gathering.
set -eu
cd {place}
job=$(sbatch --parsable array.sh)
after=$(sbatch --parsable --dependency="afterany:${{job%%;*}}" gather.sh)
echo "array ${{job%%;*}}, gathering ${{after%%;*}}; squeue shows them, scancel ${{job%%;*}} ends them"
)",
      fmt::arg("place", quoted_for_shell(options.place)));
}

std::string parallel_script(const Plan& plan, const std::vector<int>& units, const JobOptions& options) {
  const std::string hosts = options.hosts.empty() ? ""
                                                  : fmt::format("  --sshloginfile {} --filter-hosts \\\n",
                                                                quoted_for_shell(options.hosts));
  const std::string jobs = plan.measures_cost(units) ? "1" : "100%";
  const std::string how =
      options.hosts.empty() ? "--on parallel" : "--on parallel --hosts " + quoted_for_shell(options.hosts);
  return fmt::format(
      R"(#!/bin/bash
# Units of {folder} by GNU parallel. Edit it as you like; run again, it goes on where it was:
# the log beside it has what ended well, and a unit that is done is not done again.
# --jobs is on each host{why}.
parallel --joblog {place}/log/joblog --resume-failed --retries 3 --jobs {jobs} \
{hosts}  --workdir {directory} \
  {program} work {folder_quoted} --unit {{}} :::: {place}/units.txt
{further}{program} gather {folder_quoted} --out {out}
)",
      fmt::arg("folder", options.folder), fmt::arg("further", further_text(plan, options, how)),
      fmt::arg("why", plan.measures_cost(units) ? "; one, because costs are measured" : ""),
      fmt::arg("place", quoted_for_shell(options.place)), fmt::arg("jobs", jobs), fmt::arg("hosts", hosts),
      fmt::arg("directory", quoted_for_shell(plan.directory)),
      fmt::arg("program", quoted_for_shell(plan.program.path)),
      fmt::arg("folder_quoted", quoted_for_shell(options.folder)),
      fmt::arg("out", quoted_for_shell(options.out)));
}

}  // namespace plumb::harness::cluster
