#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "harness/compare.h"
#include "harness/sweep/journal.h"
#include "harness/thresholds/find.h"
#include "harness/thresholds/finding.h"

namespace plumb::harness::thresholds {

/// DIR/thresholds.jsonl: a line that says where it was measured, then a finding a line as they come.
class Record {
 public:
  /// Opens or makes the file. Throws `Error` (Io), (Syntax) for a line that is none of a record's, (Value)
  /// where it was made by another build or on another machine.
  explicit Record(const std::string& folder);

  const std::string& path() const { return journal_.path(); }

  /// What is there of `request`, to `digits`.
  const Finding* find(const Request& request, int digits) const;
  void append(const Finding& finding);

 private:
  using Key = std::tuple<std::string, std::string, std::string, int>;  // name, engine, setting, digits

  sweep::Journal journal_;
  std::map<Key, Finding> findings_;
};

struct Searched {
  std::vector<Finding> findings;  ///< in the order of the requests
  bool interrupted = false;
};

/// Searches for what is not in `record` yet and appends it as it is found.
Searched find_missing(std::span<const Request> requests, const FindOptions& options, Record& record,
                      const std::function<void(const Progress&)>& progress);

}  // namespace plumb::harness::thresholds
