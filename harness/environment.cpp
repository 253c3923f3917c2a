#include "harness/environment.h"

#include <chrono>
#include <fstream>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include "harness/build_info.h"

namespace plumb::harness {
namespace {

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const auto colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  utsname system{};
  return uname(&system) == 0 ? system.machine : "unknown";
}

std::string os_name() {
  std::string distribution;
  std::ifstream file("/etc/os-release");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("PRETTY_NAME=\"", 0) == 0) distribution = line.substr(13, line.size() - 14);
  utsname system{};
  if (uname(&system) != 0) return distribution.empty() ? "unknown" : distribution;
  const std::string kernel = fmt::format("{} {}", system.sysname, system.release);
  return distribution.empty() ? kernel : fmt::format("{}, {}", distribution, kernel);
}

}  // namespace

Environment environment() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return {PLUMB_VERSION,
          PLUMB_COMMIT,
          PLUMB_COMPILER,
          PLUMB_FLAGS,
          PLUMB_BUILD_TYPE,
          cpu_name(),
          os_name(),
          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)))};
}

std::string_view version() { return PLUMB_VERSION; }

}  // namespace plumb::harness
