#pragma once

#include <cstddef>
#include <vector>

#include "engine/joints/row.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Force and torque on a body, about its centre of mass.
template <class Real>
struct Wrench {
  Vec2<Real> force{};  ///< N
  Real torque = 0;     ///< N m
};

/// The share of [t0, t1] that lies inside [start, start + duration]: a force that is switched within a step
/// still gives its exact impulse.
double active_share(double start, double duration, double t0, double t1);

/// A scene's force laws by body index, one array a law. Each law's formula stands in a file of its own.
template <class Real>
class Forces {
 public:
  explicit Forces(const Scene& scene);

  bool empty() const;
  /// Whether any law acts on `body`.
  bool acts_on(std::size_t body) const;

  /// Adds every law's wrench, averaged over [t0, t1] where a law is switched and with the given motion
  /// elsewhere, to `out`. Arrays are indexed by body. Gravity is not among the laws.
  void add(double t0, double t1, const Pose<Real>* poses, const Twist<Real>* twists, Wrench<Real>* out) const;

 private:
  // One array a law, each law's type in its own file of this folder.
};

}  // namespace plumb
