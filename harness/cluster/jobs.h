#pragma once

#include <string>
#include <vector>

#include "harness/cluster/work_folder.h"

namespace plumb::harness::cluster {

/// Largest number of tasks in one array: Slurm's MaxArraySize is 1001 by default, and the last index must be
/// below it.
inline constexpr int kMostTasks = 1000;

/// Settings of a submission.
struct JobOptions {
  std::string folder;     ///< of work, absolute
  std::string place;      ///< absolute folder for the scripts, the list of units and the logs
  std::string out;        ///< folder that the results are gathered to, absolute
  int at_once = 0;        ///< units at a time, on all machines; 0: as many as there is room for
  int memory = 4096;      ///< megabytes of a unit
  std::string partition;  ///< of Slurm; empty: its default
  std::string hosts;      ///< file for --sshloginfile; empty: this machine
  std::string exclude;    ///< Slurm's nodes that disturbed these units, separated by commas
};

/// Returns the number of units per task of the array, done one after the other, so that there are at most
/// `kMostTasks` tasks.
int units_a_task(std::size_t units);

/// Returns the time limit, s: three times the estimate of the longest task, plus two minutes.
int time_limit(const Plan& plan, const std::vector<int>& units);

/// Scripts for people to read, edit and run.
std::string array_script(const Plan& plan, const std::vector<int>& units, const JobOptions& options);
std::string gather_script(const Plan& plan, const JobOptions& options);
std::string slurm_script(const JobOptions& options);
std::string parallel_script(const Plan& plan, const std::vector<int>& units, const JobOptions& options);

/// Puts `text` in single quotes for a shell, if it needs them.
std::string quoted_for_shell(const std::string& text);

}  // namespace plumb::harness::cluster
