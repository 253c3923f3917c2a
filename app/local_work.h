#pragma once

#include <string>

namespace plumb::app {

/// How units are done on this machine.
struct LocalWork {
  std::string folder;   ///< of work, absolute
  int jobs = 1;         ///< units at a time
  int measuring = 1;    ///< of these, of units that measure costs: side by side they disturb each other
  bool repeats = true;  ///< units that were disturbed are measured again
};

/// Does all units of a folder of work, each in a process of its own, and those of the rounds that follow from
/// them. Returns false after an interrupt, when the units under way are free again. Throws `Error`.
bool do_here(const LocalWork& work);

/// Returns the number of cores.
int cores();

}  // namespace plumb::app
