#pragma once

#include "engine/precise/impact_laws/impact_law.h"

namespace plumb::precise {

/// The course of an impact along its growing normal impulse p, by Routh's method: gap rate and slip are
/// linear in p, with at most one bend, at which the initial slip has stopped. After the bend the contact
/// sticks, or slips in the other direction, until the end.
class SlipPath {
 public:
  SlipPath(const ImpactPoint& point, const ImpactCoefficients& coefficients);

  double gap_rate(double p) const;  ///< m/s, of the gap
  ContactImpulse impulse(double p) const;

  /// Returns the normal impulse at which the gap stops closing, N s.
  double compression() const;

  /// Returns the work of the normal impulse from p to q, J.
  double work(double p, double q) const;

  /// Returns the normal impulse at which it has done `work` >= 0 since compression ended, N s.
  double after_work(double work) const;

 private:
  double start_;                       ///< m/s, gap rate at p = 0
  double first_slope_, second_slope_;  ///< 1/kg, of the gap rate before and after the bend
  double first_ratio_, second_ratio_;  ///< tangential impulse per normal impulse
  double slip_end_;                    ///< N s, infinite if the slip does not stop
};

}  // namespace plumb::precise
