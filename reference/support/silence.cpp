#include "reference/support/silence.h"

#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

namespace plumb::reference {

Silence::Silence() {
  std::fflush(stdout);
  output_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  if (output_ < 0) return;
  const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nothing < 0) return;
  dup2(nothing, STDOUT_FILENO);
  close(nothing);
}

Silence::~Silence() {
  if (output_ < 0) return;
  std::fflush(stdout);
  dup2(output_, STDOUT_FILENO);
  close(output_);
}

}  // namespace plumb::reference
