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

/// Runs a program and kills all that is left of it at the end. Never returns. Call it in a newly forked
/// process, with all signals blocked. It ends when the program does, when it gets SIGTERM, or when
/// the thread of `host` that forked it is gone, even by SIGKILL. By then it has killed the program, its
/// process group and whatever else was started from there, in sessions of their own too. It ends as the
/// program did: with the same exit code, or by the same signal. An errno that kept the program from starting
/// is written to `problem`.
[[noreturn]] void supervise(const Command& command, pid_t host, int problem);

}  // namespace plumb::reference
