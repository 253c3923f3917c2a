#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/cost.h"
#include "harness/result.h"
#include "harness/sweep/journal.h"

namespace plumb::harness::sweep {

/// Known data of one setting of one engine on one instance.
struct Trial {
  Result result;
  CostSample rough;                 ///< one repetition, measured while other runs were in progress
  std::vector<CostSample> samples;  ///< repetitions measured in turns with those of other trials
};

/// Known data of an instance.
struct InstanceRecord {
  std::vector<Trial> trials;
  std::map<std::string, std::size_t> places;  ///< by `key_of`
  bool explored = false;
  std::vector<std::string> chosen;  ///< keys of the trials whose cost is measured
  bool done = false;

  Trial* find(const std::string& key);
  void add(Trial trial);
};

/// Results of a sweep (`sweep.jsonl`), in the order in which they were found.
class Record {
 public:
  /// Reads the existing file. Throws `Error` (Io; Syntax; Value if it is of other engines, another build or
  /// another machine).
  Record(const std::string& folder, const std::vector<std::string>& engines, const std::string& settings);

  InstanceRecord& of(const std::string& label) { return instances_[label]; }

  /// Takes over the runs of another sweep in `folder` on these instances, except those that are known
  /// already. Its rough costs guide the search; its measured costs are not taken over. Throws `Error` (Io;
  /// Syntax; Value if it is of another build).
  void take_over(const std::string& folder, const std::set<std::string>& labels);

  void ran(const std::string& label, const Trial& trial);
  void explored(const std::string& label, const std::vector<std::string>& chosen);
  void costed(const std::string& label, const std::string& key, const CostSample& sample);
  void done(const std::string& label);

 private:
  void read(const std::string& line);

  Journal journal_;
  std::map<std::string, InstanceRecord> instances_;
};

}  // namespace plumb::harness::sweep
