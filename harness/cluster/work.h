#pragma once

#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "harness/cluster/work_folder.h"

namespace plumb::harness::cluster {

struct WorkOptions {
  std::string kind;        ///< of the machine; empty: its processor's name
  double calibration = 1;  ///< s, half of it before a unit that measures costs and half after
  double expiry = 300;     ///< s without renewal after which a claim's process counts as dead
  int attempts = kAttempts;
  bool again = false;  ///< repeats a done unit; replaces its results when the new ones are complete
};

enum class Worked {
  Done,
  Before,       ///< it was done already
  Elsewhere,    ///< another process has claimed it
  Failed,       ///< its `Failure` is in failed/
  Interrupted,  ///< the unit is free again
};

/// Does one unit in a folder of its own, which is renamed when complete. With `force`, takes the claim from
/// any holder. Throws `Error` (Io) if the folder of work cannot be written: then not even the failure can be
/// recorded.
Worked do_unit(const std::string& folder, const Plan& plan, const Unit& unit, const WorkOptions& options,
               bool force);

/// Chooses units one after the other: the longest first, then those whose claims may belong to dead
/// processes. A unit that should run on another host is left to other processes as long as any are at work.
class Queue {
 public:
  Queue(const std::string& folder, const Plan& plan, const WorkOptions& options);

  /// Does the next free unit. Returns its number; nullopt if none is free.
  std::optional<int> next(Worked& worked);

  /// Returns true if a unit is neither done nor given up: the process that does it may still die.
  bool waits() const { return !open_.empty(); }

 private:
  void leave_out_closed();
  bool attempt(const Unit& unit, Worked& worked) const;

  std::string folder_;
  const Plan& plan_;
  WorkOptions options_;
  std::string host_;
  std::vector<const Unit*> open_;
  std::mt19937 random_{std::random_device{}()};
};

}  // namespace plumb::harness::cluster
