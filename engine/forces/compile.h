#pragma once

#include <cstddef>
#include <map>
#include <string_view>

#include "engine/forces/attraction_force.h"
#include "engine/forces/formula_force.h"
#include "engine/forces/formula_spring.h"
#include "engine/forces/linear_drag.h"
#include "engine/forces/point_force.h"
#include "engine/forces/quadratic_drag.h"
#include "engine/forces/sinusoidal_force.h"
#include "engine/forces/spring_force.h"
#include "engine/forces/torque.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Converts a scene's laws to the evaluated laws, with the bodies' names resolved. The scene is valid.
template <class Real>
class LawCompiler {
 public:
  explicit LawCompiler(const Scene& scene) : scene_(scene) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) index_.emplace(scene.bodies[i].name, i);
  }

  /// Returns the index of a body, or `kFixedFrame`.
  int end(std::string_view name) const {
    return name == kWorld ? kFixedFrame : static_cast<int>(index_.at(name));
  }

  LinearDragLaw<Real> compile(const LinearDrag& law) const {
    return {index_.at(law.body), static_cast<Real>(law.coefficient),
            static_cast<Real>(law.angular_coefficient)};
  }
  QuadraticDragLaw<Real> compile(const QuadraticDrag& law) const {
    return {index_.at(law.body), static_cast<Real>(law.coefficient)};
  }
  PointForceLaw<Real> compile(const PointForce& law) const {
    return {index_.at(law.body), law.force.as<Real>(), law.point.as<Real>(), law.frame,
            law.start,           law.duration};
  }
  TorqueLaw<Real> compile(const Torque& law) const {
    return {index_.at(law.body), static_cast<Real>(law.torque), law.start, law.duration};
  }
  SpringForceLaw<Real> compile(const SpringForce& law) const {
    return {end(law.body_a),
            end(law.body_b),
            law.anchor_a.as<Real>(),
            law.anchor_b.as<Real>(),
            static_cast<Real>(law.rest_length),
            static_cast<Real>(law.stiffness),
            static_cast<Real>(law.damping)};
  }
  AttractionForceLaw<Real> compile(const AttractionForce& law) const {
    const double mass = scene_.bodies[index_.at(law.body)].mass;
    return {end(law.body), end(law.centre_body), law.centre.as<Real>(),
            static_cast<Real>(law.strength * mass), law.exponent};
  }
  SinusoidalForceLaw<Real> compile(const SinusoidalForce& law) const {
    return {index_.at(law.body), law.amplitude.as<Real>(), law.point.as<Real>(), law.angular_frequency,
            law.phase};
  }
  FormulaForceLaw compile(const FormulaForce& law) const {
    const std::size_t body = index_.at(law.body);
    return {body,
            law.point,
            scene_.bodies[body].mass,
            Formula(law.x, kForceVariables),
            Formula(law.y, kForceVariables),
            Formula(law.torque, kForceVariables)};
  }
  FormulaSpringLaw compile(const FormulaSpring& law) const {
    return {end(law.body_a), end(law.body_b), law.anchor_a, law.anchor_b,
            Formula(law.tension, kSpringVariables)};
  }

 private:
  const Scene& scene_;
  std::map<std::string_view, std::size_t> index_;
};

}  // namespace plumb
