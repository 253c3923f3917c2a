#pragma once

#include <vector>

#include "scenarios/truth/oscillator.h"

namespace plumb::scenarios::truth {

/// Height of what is dropped on a floor at 0 and bounces with the restitution `e`: parabolas, each as long as
/// e times the one before it, and rest after their limit.
class Bounces {
 public:
  Bounces(Real height, Real gravity, Real e, Real duration);

  Swing at(Real time) const;

  /// Returns the times of impacts of more than a nanometre a second.
  std::vector<double> impacts() const;

 private:
  struct Impact {
    Real time, speed;  // s, m/s afterwards
  };
  Real height_, gravity_;
  std::vector<Impact> impacts_;
};

}  // namespace plumb::scenarios::truth
