#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reference/process_backend.h"

namespace plumb::reference {

/// A file descriptor that is closed with its owner.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int number) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~FileDescriptor() { close(); }

  int get() const { return number_; }
  bool open() const { return number_ >= 0; }
  void close();

 private:
  int number_ = -1;
};

/// A running program that exchanges lines over its standard input and output. Its standard error is read too,
/// and its last lines go into every `ProcessError`. The program runs under a supervisor (supervisor.h), which
/// kills its descendants when it ends. The program is killed when this owner is destroyed or the thread that
/// started it dies. A copy inherited through a fork does not affect the program.
class Process {
 public:
  /// Starts `command`. Throws `ProcessError` (Start).
  Process(std::string engine, std::vector<std::string> command, ProcessLimits limits);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Closes the program's input, waits a moment for it to end, and kills it if it does not.
  ~Process();

  /// Returns true if this process started the program, false if it inherited it through a fork.
  bool owned() const;

  /// Sends `line` and a newline; `request` is the name of the request in errors. Throws `ProcessError`.
  void write_line(std::string_view line, const std::string& request);

  /// Returns the next line, of at most `most` bytes, without its newline. Throws `ProcessError`.
  std::string read_line(std::size_t most);

  /// Kills the program and returns an error about the last request, with the last lines of stderr.
  ProcessError fail(ProcessError::Fault fault, std::string problem);

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point next_deadline() const;
  bool wait_for_pipes(Clock::time_point deadline, bool writing);
  bool read_output();
  void read_errors();
  ProcessError ended();
  ProcessError timed_out();
  ProcessError too_long(std::size_t most);
  std::string status_when_ended();
  std::string last_words();
  bool wait_for_end(std::chrono::milliseconds limit) const;
  void kill_and_reap();

  std::string engine_;
  ProcessLimits limits_;
  std::string request_;
  pid_t owner_;
  pid_t pid_ = -1;  ///< of the supervisor
  int status_ = 0;  ///< of wait(2), once reaped
  FileDescriptor input_, output_, errors_;
  std::string received_;     ///< output that `read_line` has not returned yet
  std::size_t scanned_ = 0;  ///< length of the start of `received_` that has no newline
  std::string stderr_tail_;
};

}  // namespace plumb::reference
