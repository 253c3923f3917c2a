#include "reference/support/supervisor.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

// Between fork and exec only calls that are safe in signal handlers are allowed (POSIX, fork(2)). So this
// file uses no allocation, no stream and no directory listing.
namespace plumb::reference {
namespace {

[[noreturn]] void refuse(int problem, int number) {
  if (write(problem, &number, sizeof number) < 0) _exit(126);
  _exit(127);
}

/// Executes the program in this process.
[[noreturn]] void become(const Command& command, pid_t supervisor, int problem) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != supervisor) _exit(127);
  for (int target = 0; target < 3; ++target) {
    if (dup2(command.streams[static_cast<std::size_t>(target)], target) != target) refuse(problem, errno);
  }
  for (const int ignored_by_host : {SIGPIPE, SIGXFSZ}) signal(ignored_by_host, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  execvp(command.program, command.arguments);
  refuse(problem, errno);
}

/// Closes all inherited files, so that pipes close when the processes that use them end.
void close_files() {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int file = 0; file < 3; ++file) dup2(nothing, file);
  close_range(3, ~0U, 0);
}

/// Waits until `child` has ended or SIGTERM arrives. Reaps other children, but not `child`.
void wait_for_end(pid_t child, const sigset_t& signals) {
  while (true) {
    siginfo_t ended{};
    while (waitid(P_ALL, 0, &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid != 0) {
      if (ended.si_pid == child) return;
      waitpid(ended.si_pid, nullptr, 0);
      ended = {};
    }
    if (sigwaitinfo(&signals, nullptr) == SIGTERM) return;
  }
}

/// Kills `number` if it is a child of this process. (If /proc is mounted for another PID namespace, it lists
/// other numbers.) Returns 1 if it is a child that has ended or now ends, else 0.
int kill_child(pid_t number) {
  siginfo_t state{};
  if (waitid(P_PID, static_cast<id_t>(number), &state, WEXITED | WNOHANG | WNOWAIT) != 0) return 0;
  if (state.si_pid != 0) return 1;  // dead, and to be reaped
  return kill(number, SIGKILL) == 0 ? 1 : 0;
}

/// Kills the present children of this process; returns how many of them end.
int kill_children() {
  const int list = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
  if (list < 0) return 0;
  int killed = 0;
  pid_t number = 0;
  char text[4096];
  for (ssize_t count = 0; (count = read(list, text, sizeof text)) > 0;) {
    for (ssize_t i = 0; i < count; ++i) {
      if (text[i] >= '0' && text[i] <= '9') {
        number = number * 10 + (text[i] - '0');
      } else if (number > 0) {
        killed += kill_child(number);
        number = 0;
      }
    }
  }
  close(list);
  return killed;
}

/// Kills and reaps all descendants of the program that has ended; this process inherits them as the
/// subreaper.
void end_orphans() {
  while (true) {
    const int killed = kill_children();
    const pid_t reaped = waitpid(-1, nullptr, killed > 0 ? 0 : WNOHANG);
    if (reaped == 0 || (reaped < 0 && errno != EINTR)) return;
  }
}

[[noreturn]] void end_likewise(int status) {
  if (WIFEXITED(status)) _exit(WEXITSTATUS(status));
  const int number = WTERMSIG(status);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  kill(getpid(), number);
  _exit(128 + number);
}

}  // namespace

void supervise(const Command& command, pid_t host, int problem) {
  // Leaves the host's process group, so that an interrupt from the keyboard reaches only the host.
  setpgid(0, 0);
  signal(SIGCHLD, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  if (getppid() != host) _exit(127);

  const pid_t self = getpid();
  const pid_t child = fork();
  if (child < 0) refuse(problem, errno);
  if (child == 0) become(command, self, problem);
  setpgid(child, child);  // the child does the same; either may run first
  close_files();

  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGCHLD);
  sigaddset(&signals, SIGTERM);
  wait_for_end(child, signals);
  // Kills the group before reaping its leader: until then no other group can get its number.
  kill(-child, SIGKILL);
  kill(child, SIGKILL);  // the program may have left its group
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  end_orphans();
  end_likewise(status);
}

}  // namespace plumb::reference
