#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plumb::harness::sweep {

/// A file of lines that is appended to, a line at once, by one process at a time. Being killed at any instant
/// loses at most the line under way: what is left of one is cut off when the file is opened again.
class Journal {
 public:
  /// Opens or makes the file and its folders. Throws `Error` (Io), also where another process has it open.
  explicit Journal(const std::string& path);
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  ~Journal();

  /// The whole lines that were there when it was opened.
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
