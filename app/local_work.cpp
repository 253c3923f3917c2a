#include "app/local_work.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/progress_line.h"
#include "engine/scene/error.h"
#include "harness/cluster/next_round.h"
#include "harness/cluster/work.h"
#include "harness/interrupt.h"

namespace plumb::app {
namespace {

namespace cluster = harness::cluster;

pid_t start_worker(const std::string& folder) {
  const pid_t child = fork();
  if (child < 0) throw Error(Error::Kind::Io, "a process", "", "", std::strerror(errno));
  if (child > 0) return child;
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  // Each unit's line would come between the progress; failures are on stderr.
  if (const int nothing = open("/dev/null", O_WRONLY); nothing >= 0) dup2(nothing, STDOUT_FILENO);
  execl("/proc/self/exe", "plumb", "work", folder.c_str(), "--all", static_cast<char*>(nullptr));
  _exit(127);
}

// Does the units that are planned, `jobs` at a time.
bool do_round(const std::string& folder, std::size_t units, int jobs) {
  std::vector<pid_t> workers;
  for (int i = 0; i < jobs; ++i) workers.push_back(start_worker(folder));
  ProgressLine progress;
  bool passed_on = false;
  while (!workers.empty()) {
    std::erase_if(workers, [](pid_t worker) { return waitpid(worker, nullptr, WNOHANG) == worker; });
    if (harness::interrupted() && !passed_on) {
      for (const pid_t worker : workers) kill(worker, SIGTERM);
      passed_on = true;
    }
    progress.show({cluster::numbers_in(folder, "done").size(), units, "units"});
    usleep(100'000);
  }
  progress.clear();
  return !harness::interrupted();
}

}  // namespace

bool do_here(const LocalWork& work) {
  harness::catch_interrupts();
  for (;;) {
    cluster::Plan plan = cluster::read_plan(work.folder);
    const double expiry = cluster::WorkOptions{}.expiry;
    const std::vector<int> open = cluster::survey(work.folder, plan, expiry).missing();
    if (!open.empty() &&
        !do_round(work.folder, plan.units.size(), plan.measures_cost(open) ? work.measuring : work.jobs))
      return false;
    cluster::NextRound next =
        cluster::next_round(work.folder, plan, cluster::survey(work.folder, plan, expiry));
    if (!work.repeats) std::erase_if(next.units, [](const cluster::Unit& unit) { return unit.repeats > 0; });
    if (next.units.empty()) return true;
    plan.units = std::move(next.units);
    cluster::add_to_plan(work.folder, std::move(plan));
  }
}

int cores() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

}  // namespace plumb::app
