#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plumb::harness::sweep {

/// Append-only file of lines, for one process at a time. Being killed at any instant loses at most the line
/// under way: a partial line is cut off when the file is opened again.
class Journal {
 public:
  /// Opens or creates the file and its folders. Throws `Error` (Io), also if another process has it open.
  explicit Journal(const std::string& path);
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  ~Journal();

  /// Returns the whole lines that were there when it was opened.
  const std::vector<std::string>& lines() const { return lines_; }
  const std::string& path() const { return path_; }

  /// `line` has no line ends. Throws `Error` (Io).
  void append(std::string_view line);

 private:
  [[noreturn]] void fail(std::string_view what) const;

  std::string path_;
  int file_ = -1;
  std::vector<std::string> lines_;
};

}  // namespace plumb::harness::sweep
