#pragma once

#include <string>

namespace plumb::harness::cluster {

/// Fingerprint of the machine that a unit ran on.
struct Machine {
  std::string kind;  ///< costs of one kind are compared with each other: the processor's name, or the name
                     ///< that was given
  std::string cpu, os, host;
  int cores = 0;         ///< that this process may run on
  double memory_gb = 0;  ///< installed, 1e9 bytes
};

/// Returns this machine's fingerprint; `kind` replaces the processor's name if it is not empty.
Machine this_machine(const std::string& kind = "");

/// Repeated timings of a fixed computation (about 2 ms).
struct Calibration {
  double fastest_ms = 0, median_ms = 0;
  int repetitions = 0;
};

/// Repeats the computation for `seconds`, at least three times.
Calibration calibrate(double seconds);

/// Returns the scatter of the times: the largest of three ratios, namely of the median to the fastest time
/// (before and after), and of the two medians. 1 on an undisturbed machine.
double noise_of(const Calibration& before, const Calibration& after);

/// Returns true if other processes disturbed the measurement: a median is a quarter above the fastest time,
/// or the medians before and after differ by a quarter. A cost is called noisy at the same spread.
bool is_noisy(const Calibration& before, const Calibration& after);

std::string to_json(const Machine& machine);
std::string to_json(const Calibration& calibration);
Machine machine_from_json(const std::string& text);
Calibration calibration_from_json(const std::string& text);

}  // namespace plumb::harness::cluster
