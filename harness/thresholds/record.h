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

/// DIR/thresholds.jsonl: one line for the environment, then one line per finding as they come.
class Record {
 public:
  /// Opens or creates the file. Throws `Error` (Io), (Syntax) for an invalid line, (Value) if it was made by
  /// another build or on another machine.
  explicit Record(const std::string& folder);

  const std::string& path() const { return journal_.path(); }

  /// Returns the recorded finding of `request`, to `digits`; null if there is none.
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

/// Searches for the values that are not in `record` yet and appends them as they are found.
Searched find_missing(std::span<const Request> requests, const FindOptions& options, Record& record,
                      const std::function<void(const Progress&)>& progress);

}  // namespace plumb::harness::thresholds
