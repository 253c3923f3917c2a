#include "harness/cluster/machine.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <sched.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "harness/environment.h"

namespace plumb::harness::cluster {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr double kNoise = 1.25;
// Pendulums that fill half of a first-level cache (16 kB), and the number of steps, which take about 2 ms on
// a processor of 2020.
constexpr int kPendulums = 1024, kSteps = 400;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double swing(std::vector<double>& angles, std::vector<double>& speeds) {
  for (int step = 0; step < kSteps; ++step) {
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double x = angles[i];
      speeds[i] -= 1e-3 * x * (1 - x * x / 6) / (1 + 0.01 * speeds[i] * speeds[i]);
      angles[i] += 1e-3 * speeds[i];
    }
  }
  return angles.front();
}

int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set)
                                                     : static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
}

}  // namespace

Machine this_machine(const std::string& kind) {
  const Environment where = environment();
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  const double pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
  return {.kind = kind.empty() ? where.cpu : kind,
          .cpu = where.cpu,
          .os = where.os,
          .host = host,
          .cores = usable_cores(),
          .memory_gb = std::round(1e-8 * pages * static_cast<double>(sysconf(_SC_PAGESIZE))) / 10};
}

Calibration calibrate(double seconds) {
  std::vector<double> angles(kPendulums, 0.5), speeds(kPendulums, 0.1), times;
  volatile double kept = swing(angles, speeds);  // the first run warms the cache up and is not counted
  const Clock::time_point start = Clock::now();
  while (times.size() < 3 || seconds_since(start) < seconds) {
    const Clock::time_point one = Clock::now();
    kept = swing(angles, speeds);
    times.push_back(1e3 * seconds_since(one));
  }
  static_cast<void>(kept);
  std::sort(times.begin(), times.end());
  return {times.front(), times[times.size() / 2], static_cast<int>(times.size())};
}

double noise_of(const Calibration& before, const Calibration& after) {
  const auto ratio = [](double a, double b) { return std::max(a, b) / std::max(std::min(a, b), 1e-9); };
  return std::max({ratio(before.median_ms, before.fastest_ms), ratio(after.median_ms, after.fastest_ms),
                   ratio(before.median_ms, after.median_ms)});
}

bool is_noisy(const Calibration& before, const Calibration& after) {
  return noise_of(before, after) > kNoise;
}

std::string to_json(const Machine& machine) {
  return Json{{"kind", machine.kind}, {"cpu", machine.cpu},     {"os", machine.os},
              {"host", machine.host}, {"cores", machine.cores}, {"memory_gb", machine.memory_gb}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string to_json(const Calibration& calibration) {
  return Json{{"fastest_ms", calibration.fastest_ms},
              {"median_ms", calibration.median_ms},
              {"repetitions", calibration.repetitions}}
      .dump();
}

Machine machine_from_json(const std::string& text) {
  const Json json = Json::parse(text);
  return {.kind = json.at("kind"),
          .cpu = json.at("cpu"),
          .os = json.at("os"),
          .host = json.at("host"),
          .cores = json.at("cores"),
          .memory_gb = json.at("memory_gb")};
}

Calibration calibration_from_json(const std::string& text) {
  const Json json = Json::parse(text);
  return {json.at("fastest_ms"), json.at("median_ms"), json.at("repetitions")};
}

}  // namespace plumb::harness::cluster
