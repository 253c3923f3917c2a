#pragma once

#include <cstddef>

#include "engine/forces/linear_drag.h"
#include "engine/forces/point_force.h"
#include "engine/forces/quadratic_drag.h"
#include "engine/forces/torque.h"
#include "engine/scene/scene.h"

/// From a scene's law to the law that is evaluated, with the body's name resolved to `body`.
namespace plumb {

template <class Real>
LinearDragLaw<Real> compile_law(const LinearDrag& law, std::size_t body) {
  return {body, static_cast<Real>(law.coefficient)};
}

template <class Real>
QuadraticDragLaw<Real> compile_law(const QuadraticDrag& law, std::size_t body) {
  return {body, static_cast<Real>(law.coefficient)};
}

template <class Real>
PointForceLaw<Real> compile_law(const PointForce& law, std::size_t body) {
  return {body, law.force.as<Real>(), law.point.as<Real>(), law.frame, law.start, law.duration};
}

template <class Real>
TorqueLaw<Real> compile_law(const Torque& law, std::size_t body) {
  return {body, static_cast<Real>(law.torque), law.start, law.duration};
}

}  // namespace plumb
