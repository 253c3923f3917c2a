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

/// Returns the time until two discs without gravity touch, s; infinite if they miss.
Real time_to_touch(const Disc& first, const Disc& second);

/// A fixed line that reflects discs on the side of its normal.
struct Wall {
  Vec2<Real> point{};   ///< m
  Vec2<Real> normal{};  ///< unit
};

/// Place of a billiard.
struct Table {
  Vec2<Real> gravity{};  ///< m/s^2
  std::vector<Wall> walls{};
};

/// Frictionless discs in uniform gravity: parabolas between impacts, so closed forms joined at the impacts.
/// Gravity cancels in relative motions: the impact of a pair is at the earlier root of |d + t u| = r1 + r2
/// (d, u the relative position and velocity), and one with a wall at a root of the parabola across it. An
/// impact exchanges the impulse (1 + e) m1 m2/(m1 + m2) |u.n| along the normal n of that moment. Discs get no
/// spin. Simultaneous impacts are resolved pair by pair, in the discs' order.
class Billiard {
 public:
  /// Throws `Error` (Run) if the number of impacts is unbounded.
  Billiard(std::vector<Disc> discs, Real restitution, Real duration, Table table = {});

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
  Vec2<Real> gravity_;
};

/// Returns the truth of `scene`, whose dynamic bodies are discs of one restitution, without friction. `walls`
/// are the surfaces at which its static bodies reflect them.
Truth billiard_truth(const Scene& scene, double duration, std::vector<Wall> walls = {});

}  // namespace plumb::scenarios::truth
