#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/integrate/bernstein.h"
#include "engine/joints/row.h"
#include "engine/scene/scene.h"
#include "engine/simulation/precise_parts.h"

namespace plumb::precise {

/// Two discs that meet.
struct Impact {
  std::size_t disc_a = 0, disc_b = 0;
  double time = 0;      ///< s
  double distance = 0;  ///< m, of the centres when they meet
};

/// A pair as it is at one time.
struct Encounter {
  Vec2d normal{};    ///< from disc a to disc b
  double gap = 0;    ///< m, distance less the sum of the radii
  double speed = 0;  ///< m/s, of the gap: negative when the discs approach
  double noise = 0;  ///< m, what rounding can make of the gap
  double quiet = 0;  ///< m/s, what rounding can make of the speed
};

/// Finds impacts between circles, in time. Motions are given by body of the scene; those of bodies without
/// discs are not looked at.
class Impacts {
 public:
  Impacts(const Scene& scene, Parts parts);

  bool empty() const { return discs_.empty(); }
  std::span<const Disc> discs() const { return discs_; }

  /// The pair that touches and approaches fastest; nothing when none does.
  std::optional<Impact> touching(double time, std::span<const Motion> motions);

  /// The first pair that comes together between two times. Between them a disc's centre is taken to follow
  /// the polynomial of degree 5 that has its position, velocity and acceleration at both ends: exact in free
  /// flight.
  std::optional<Impact> first(double start, double end, std::span<const Motion> at_start,
                              std::span<const Motion> at_end);

  /// The pair of `impact` in the given motions.
  Encounter encounter(const Impact& impact, std::span<const Motion> motions) const;

  /// How long a step may be for the polynomials to follow discs that are off their bodies' centres: a quarter
  /// of a radian.
  double longest_step(std::span<const Motion> motions) const;

  /// The impact's rows for a unit impulse along the normal and along the tangent (a quarter turn on).
  struct Directions {
    Row<double> normal, tangent;
  };
  Directions directions(const Impact& impact, std::span<const Motion> motions) const;

  /// The impulses along normal and tangent by Newton's restitution and Coulomb's friction, N s. `nn`, `nt`
  /// and `tt` are the velocities in one direction by a unit impulse in another; `slip` the velocity along the
  /// tangent.
  struct Impulse {
    double normal = 0, tangent = 0;
  };
  Impulse impulse(const Impact& impact, double speed, double slip, double nn, double nt, double tt) const;

 private:
  static constexpr std::size_t kControls = 6;
  using Path = std::array<Vec2d, kControls>;  // Bernstein coefficients of a centre's way

  void find_pairs(std::span<const Path> paths);
  void follow(std::span<const Motion> at_start, std::span<const Motion> at_end, double duration);

  Scene rules_;  // names, types and contact rules
  Parts parts_;
  std::vector<Disc> discs_;
  // Work space, by disc.
  std::vector<Path> paths_;
  struct Extent {
    double left = 0, right = 0, bottom = 0, top = 0;
    std::size_t disc = 0;
  };
  std::vector<Extent> extents_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
};

}  // namespace plumb::precise
