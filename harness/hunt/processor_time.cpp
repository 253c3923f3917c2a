#include "harness/hunt/processor_time.h"

#include <ctime>

#include <sys/resource.h>

namespace plumb::harness::hunt {

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Outcome isolate_within(double seconds, const std::function<std::string()>& work) {
  return isolate(
      [&] {
        // The signal at the limit records the reason of the end; a second later the process is killed.
        const auto most = static_cast<rlim_t>(seconds);
        const rlimit limit{most, most + 1};
        setrlimit(RLIMIT_CPU, &limit);
        return work();
      },
      kPatience * seconds);
}

}  // namespace plumb::harness::hunt
