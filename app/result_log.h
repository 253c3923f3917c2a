#pragma once

#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "harness/result.h"

namespace plumb::app {

/// DIR/results.jsonl: appends and flushes each result as it comes, so that an interrupt loses none.
class ResultLog {
 public:
  /// Creates the folder if there is none. Throws `Error` (Io).
  explicit ResultLog(const std::string& folder);
  void append(std::span<const harness::Result> results);
  const std::string& path() const { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace plumb::app
