#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/cost.h"
#include "harness/result.h"
#include "harness/sweep/journal.h"

namespace plumb::harness::sweep {

/// One setting of one engine on one instance, as far as it is known.
struct Trial {
  Result result;
  CostSample rough;                 ///< one repetition while other runs were under way
  std::vector<CostSample> samples;  ///< repetitions in turns
};

/// What is known of an instance.
struct InstanceRecord {
  std::vector<Trial> trials;
  std::map<std::string, std::size_t> places;  ///< by `key_of`
  bool explored = false;
  std::vector<std::string> chosen;  ///< keys of those whose cost is measured
  bool done = false;

  Trial* find(const std::string& key);
  void add(Trial trial);
};

/// `sweep.jsonl`: everything that a sweep has found out, in the order in which it did.
class Record {
 public:
  /// Reads what is there. Throws `Error` (Io; Syntax; Value where it is of other engines, another build or
  /// another machine).
  Record(const std::string& folder, const std::vector<std::string>& engines, const std::string& settings);

  InstanceRecord& of(const std::string& label) { return instances_[label]; }

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
