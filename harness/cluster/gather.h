#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/cluster/work_folder.h"
#include "harness/hunt/hunt.h"

namespace plumb::harness::cluster {

/// Units of one kind of machine.
struct MachineUse {
  int units = 0;
  std::set<std::string> hosts;
  double fastest_ms = 0, slowest_ms = 0;  ///< medians of calibrations, over the units
};

/// State of a folder of work.
struct Survey {
  std::vector<Done> done;
  std::vector<int> free, running;
  std::map<std::string, std::vector<int>> failed;  ///< by the kind of the last failure, if not done since
  std::map<int, std::string> damaged;              ///< in done/, but not complete
  std::vector<int> noisy;                          ///< measured while other programs used the machine
  std::map<std::string, MachineUse> machines;      ///< by kind
  double seconds_done = 0;                         ///< wall time of all units that are done
  double seconds_left = 0;  ///< s, estimate, corrected by the durations of the units done and by calibrations

  std::vector<int> missing() const;  ///< in order
};

/// `expiry`: age in s at which the process of a claim counts as dead.
Survey survey(const std::string& folder, const Plan& plan, double expiry);

struct Gathered {
  Survey survey;
  std::map<std::string, std::size_t>
      lines{};                            ///< by file: "results.jsonl", "stress.jsonl", "thresholds.jsonl"
  std::map<std::string, int> statuses{};  ///< runs of results.jsonl by status, cells by outcome
  std::size_t cut_short = 0;              ///< last lines that were truncated, and left out
  std::size_t twice = 0;                  ///< runs that two units made; the first counts
  std::vector<std::string> differ{};      ///< number of these whose errors differ in their bits
  bool hunted = false;
  hunt::Hunted hunt{};
};

/// Writes the results of the units that are done to `out`, in the order of the plan; each file is replaced as
/// a whole. Several processes may call this at once: with file locks they take turns, without them the files
/// of the last one remain. Throws `Error` (Io).
Gathered gather(const std::string& folder, const Plan& plan, const std::string& out, double expiry);

/// Formats the state as JSON, for `plumb status` and gathered.json.
std::string to_json(const Plan& plan, const Survey& survey);
std::string to_json(const Plan& plan, const Gathered& gathered);

}  // namespace plumb::harness::cluster
