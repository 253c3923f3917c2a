#pragma once

#include <span>
#include <vector>

#include "scenarios/scenario.h"
#include "scenarios/truth/motion.h"

namespace plumb::scenarios::truth {

struct Disc {
  Real mass = 1;    ///< kg
  Real radius = 0;  ///< m
  Motion motion{};
};

/// Frictionless discs without gravity: straight lines between pair impacts, so closed forms joined at the
/// impacts. An impact comes at the earlier root of |d + t u| = r1 + r2 (d, u the relative position and
/// velocity). It exchanges the impulse (1 + e) m1 m2/(m1 + m2) |u.n| along the normal n of that moment. Discs
/// get no spin. Simultaneous impacts are resolved pair by pair, in the discs' order.
class Billiard {
 public:
  /// Throws `Error` (Run) if the number of impacts is unbounded.
  Billiard(std::vector<Disc> discs, Real restitution, Real duration);

  const std::vector<double>& impacts() const { return impacts_; }

  /// Returns the motions at `time`; at an impact, those after it.
  std::vector<Motion> at(Real time) const;

 private:
  struct Flight {
    Real start;
    std::vector<Motion> motions;
  };
  std::vector<Flight> flights_;
  std::vector<double> impacts_;
};

/// Returns the truth of `scene`, whose bodies are discs of one restitution, without friction or gravity.
Truth billiard_truth(const Scene& scene, double duration);

}  // namespace plumb::scenarios::truth
