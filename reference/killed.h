#pragma once

#include <csignal>

namespace plumb::reference {

/// Number of kills from outside after which a program is considered to have failed by itself. One kill is an
/// accident or a scheduler's decision; a program that needs more memory than there is dies each time.
inline constexpr int kAttempts = 3;

/// Returns true for signals that come from users, schedulers, or a system short of memory. A fault of the
/// program itself raises others (SIGSEGV, SIGABRT, SIGFPE, ...).
inline bool comes_from_outside(int signal) {
  return signal == SIGKILL || signal == SIGTERM || signal == SIGINT || signal == SIGHUP;
}

}  // namespace plumb::reference
