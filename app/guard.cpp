#include "app/guard.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/exit_codes.h"
#include "engine/scene/error.h"
#include "harness/interrupt.h"

namespace plumb::app {

int guarded(const std::string& engine, const std::function<int()>& work) {
  std::fflush(stdout);
  harness::catch_interrupts();
  const pid_t child = fork();
  if (child < 0) throw Error(Error::Kind::Io, "a process", "", "", std::strerror(errno));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int code = work();
    std::fflush(stdout);
    std::fflush(stderr);
    _exit(code);
  }
  int status = 0;
  bool passed_on = false;
  while (true) {
    const pid_t done = waitpid(child, &status, harness::interrupted() ? WNOHANG : 0);
    if (done == child) break;
    if (done < 0 && errno != EINTR)
      throw Error(Error::Kind::Run, fmt::format("engine '{}'", engine), "", "", std::strerror(errno));
    if (harness::interrupted() && !passed_on) {
      kill(child, SIGINT);
      passed_on = true;
    }
    if (passed_on) usleep(1000);
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  const int number = WTERMSIG(status);
  if (number == SIGINT || harness::interrupted()) return kInterrupted;
  const char* name = sigabbrev_np(number);
  throw Error(Error::Kind::Run, fmt::format("engine '{}'", engine), "", "",
              fmt::format("crashed with signal {} (SIG{}); the output until then is on stdout", number,
                          name != nullptr ? name : "?"));
}

}  // namespace plumb::app
