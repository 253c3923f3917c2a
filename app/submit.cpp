#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/local_work.h"
#include "app/output.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/cluster/gather.h"
#include "harness/cluster/jobs.h"
#include "harness/cluster/work.h"
#include "harness/text_file.h"

namespace plumb::app {
namespace {

namespace cluster = harness::cluster;
namespace fs = std::filesystem;

struct SubmitOptions {
  std::string folder, on, out, hosts, partition;
  int nodes = 0, jobs = 0, memory = 4096;
  bool dry_run = false;
};

// Runs `bash script`; returns its exit code.
int run_script(const std::string& script) {
  flush();
  const pid_t child = fork();
  if (child < 0) throw Error(Error::Kind::Io, "a process", "", "", std::strerror(errno));
  if (child == 0) {
    execlp("bash", "bash", script.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kInterrupted;
}

// Runs the units on this machine, `jobs` at a time, and gathers the results.
int run_here(const std::string& folder, const SubmitOptions& options, const LocalWork& work) {
  if (!do_here(work)) {
    notice(fmt::format("interrupted; `plumb submit {} --on local` continues", options.folder));
    return kInterrupted;
  }
  flush();
  execl("/proc/self/exe", "plumb", "gather", folder.c_str(), "--out", options.out.c_str(),
        static_cast<char*>(nullptr));
  throw Error(Error::Kind::Io, "the program", "", "", std::strerror(errno));
}

// Returns the hosts on which these units were disturbed, if others have done units too.
std::string hosts_to_avoid(const cluster::Plan& plan, const cluster::Survey& survey,
                           const std::vector<int>& units) {
  std::set<std::string> avoided, known;
  for (const int unit : units) avoided.insert(plan.unit(unit).avoid.begin(), plan.unit(unit).avoid.end());
  for (const auto& [kind, use] : survey.machines) known.insert(use.hosts.begin(), use.hosts.end());
  if (std::includes(avoided.begin(), avoided.end(), known.begin(), known.end())) return "";
  return fmt::format("{}", fmt::join(avoided, ","));
}

// Makes a folder of its own for a submission.
std::string new_place(const std::string& folder) {
  for (int number = 1;; ++number) {
    const fs::path place = fs::path(folder) / "submit" / fmt::format("{:03}", number);
    std::error_code code;
    fs::create_directories(place.parent_path(), code);
    if (fs::create_directory(place, code)) {
      fs::create_directory(place / "log");
      return place.string();
    }
    if (code)
      throw Error(Error::Kind::Io, fmt::format("folder '{}'", place.string()), "", "",
                  fmt::format("cannot be made: {}", code.message()));
  }
}

std::string hosts_text(const std::string& hosts) {
  std::error_code code;
  if (fs::is_regular_file(hosts, code)) return harness::read_text(hosts);
  std::string out;
  for (const char c : hosts) out += c == ',' ? '\n' : c;
  return out + "\n";
}

// Writes the scripts; returns the one that submits.
std::string write_scripts(const cluster::Plan& plan, const std::vector<int>& units,
                          const SubmitOptions& options, cluster::JobOptions& job) {
  std::string list;
  for (const int unit : units) list += fmt::format("{}\n", unit);
  const auto write = [&](const char* name, const std::string& text) {
    harness::write_whole(job.place + "/" + name, text);
    return job.place + "/" + name;
  };
  write("units.txt", list);
  if (options.on == "parallel") {
    if (!options.hosts.empty()) job.hosts = write("hosts.txt", hosts_text(options.hosts));
    return write("parallel.sh", cluster::parallel_script(plan, units, job));
  }
  write("array.sh", cluster::array_script(plan, units, job));
  write("gather.sh", cluster::gather_script(plan, job));
  return write("submit.sh", cluster::slurm_script(job));
}

int start_submit(SubmitOptions options) {
  const std::string folder = fs::absolute(options.folder).lexically_normal().string();
  const cluster::Plan plan = cluster::read_plan(folder);
  cluster::require_same_program(options.folder, plan, cluster::this_program());
  options.out =
      options.out.empty() ? folder + "/results" : fs::absolute(options.out).lexically_normal().string();
  const cluster::Survey survey = cluster::survey(folder, plan, cluster::WorkOptions{}.expiry);
  const std::vector<int> units = survey.missing();
  if (options.on == "local") {
    LocalWork work{.folder = folder, .jobs = cores()};
    if (options.jobs > 0) work.jobs = work.measuring = options.jobs;
    if (options.dry_run) {
      print(fmt::format("{} x: plumb work {} --all\nplumb plan {} --next\nplumb gather {} --out {}\n",
                        plan.measures_cost(units) ? work.measuring : work.jobs, folder, folder, folder,
                        options.out));
      return kOk;
    }
    return run_here(folder, options, work);
  }
  if (units.empty()) {
    print(fmt::format("all units are done; `plumb gather {}` merges them\n", options.folder));
    return kOk;
  }
  cluster::JobOptions job{.folder = folder,
                          .place = new_place(folder),
                          .out = options.out,
                          .at_once = options.nodes,
                          .memory = options.memory,
                          .partition = options.partition,
                          .hosts = {},
                          .exclude = hosts_to_avoid(plan, survey, units)};
  const std::string script = write_scripts(plan, units, options, job);
  print(fmt::format("{} units in {}; `bash {}` submits them\n", units.size(), job.place, script));
  return options.dry_run ? kOk : run_script(script);
}

}  // namespace

void add_submit(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "submit", "run the units of a folder of work by Slurm, by GNU parallel, or on this machine");
  auto options = std::make_shared<SubmitOptions>();
  command->add_option("folder", options->folder, "folder that `plumb plan` wrote")
      ->required()
      ->type_name("FOLDER");
  command->add_option("--on", options->on, "slurm, parallel or local")
      ->required()
      ->check(CLI::IsMember({"slurm", "parallel", "local"}));
  command
      ->add_option("--nodes", options->nodes,
                   "slurm: number of units at the same time (default: as many as the queue allows)")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->type_name("N");
  command->add_option("--partition", options->partition, "slurm: partition (default: the cluster's)")
      ->type_name("NAME");
  command->add_option("--memory", options->memory, "slurm: memory of a unit in megabytes (default 4096)")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->type_name("MB");
  command
      ->add_option(
          "--hosts", options->hosts,
          "parallel: hosts, separated by commas, or a file for --sshloginfile (default: this machine)")
      ->type_name("HOSTS");
  command
      ->add_option(
          "--jobs", options->jobs,
          "local: number of units at the same time (default: one per core, or one if costs are measured)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command->add_option("--out", options->out, "folder for the results (default FOLDER/results)")
      ->check(problem_with_path)
      ->type_name("DIR");
  command->add_flag("--dry-run", options->dry_run, "only write the scripts");
  command->footer(
      "Examples:\n  plumb submit work --on local\n  plumb submit work --on slurm --nodes 8 --dry-run\n  "
      "plumb submit work --on parallel --hosts node1,node2\nThe scripts are in FOLDER/submit; they may be "
      "edited. See docs/cluster.md. Exit codes: 0 submitted, or\nall done; 1 some units are missing; 2 "
      "usage; 130 interrupted.");
  command->callback([&chosen, options] { chosen = [options] { return start_submit(*options); }; });
}

}  // namespace plumb::app
