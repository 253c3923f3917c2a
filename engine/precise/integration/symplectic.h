#pragma once

#include <span>
#include <vector>

#include "engine/integrate/compensated.h"
#include "engine/precise/dynamics/motion.h"

namespace plumb::precise {

/// Steps for long runs: RATTLE (H. C. Andersen 1983), symplectic and time-reversible with joints as
/// constraints, composed to order 8 (W. Kahan, R.-C. Li, Math. Comp. 66, 1997: 17 stages; E. Hairer, C.
/// Lubich, G. Wanner, Geometric Numerical Integration, V.3.2). With a fixed step energy does not drift: its
/// error stays bounded for as long as the motion is regular.
class SymplecticMotion {
 public:
  explicit SymplecticMotion(EquationsOfMotion& equations);

  /// Steps y from `time` over `h`. Joints must be closed, and stay so.
  void step(double time, double h, Compensated& y);

 private:
  void stage(double time, double h, Compensated& y);
  void drift(double time, double h, Compensated& y);
  void kick(double scale, std::span<const Twist<double>> change, Compensated& y) const;

  EquationsOfMotion& equations_;
  std::vector<Twist<double>> acceleration_, correction_;  // by body
};

}  // namespace plumb::precise
