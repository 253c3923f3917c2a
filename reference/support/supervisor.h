#pragma once

#include <sys/types.h>

#include <array>

namespace plumb::reference {

/// How an engine's program is started.
struct Command {
  const char* program;
  char** arguments;              ///< as exec takes them
  std::array<int, 3> streams{};  ///< become its stdin, stdout and stderr
};

/// Runs a program, and kills everything that is left of it at the end. Never returns. Call it in a newly
/// forked process, with all signals blocked. It ends when the program ends, when it gets SIGTERM, or when the
/// thread of `host` that forked it is gone, even by SIGKILL. By then it has killed the program, its process
/// group and all its descendants, including those in sessions of their own. It ends in the same way as the
/// program: with the same exit code, or by the same signal. If the program cannot be started, the errno is
/// written to `problem`.
[[noreturn]] void supervise(const Command& command, pid_t host, int problem);

}  // namespace plumb::reference
