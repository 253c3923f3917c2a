#pragma once

#include <vector>

#include "scenarios/truth/oscillator.h"

namespace plumb::scenarios::truth {

/// Height of a body that is dropped on a floor at 0 and bounces with the restitution `e`: parabolas, each e
/// times as long as the one before, and rest after their limit.
class Bounces {
 public:
  Bounces(Real height, Real gravity, Real e, Real duration);

  Swing at(Real time) const;

  /// Returns the times of impacts faster than a nanometre per second.
  std::vector<double> impacts() const;

 private:
  struct Impact {
    Real time, speed;  // s, m/s afterwards
  };
  Real height_, gravity_;
  std::vector<Impact> impacts_;
};

}  // namespace plumb::scenarios::truth
