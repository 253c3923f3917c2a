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

/// Converts a scene's force laws to those that are evaluated, with indices in place of the bodies' names. The
/// scene must be valid.
class LawCompiler {
 public:
  explicit LawCompiler(const Scene& scene) : scene_(scene) {
    if (scene.forces.empty()) return;  // an index of a million names takes 80 MB
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) index_.emplace(scene.bodies[i].name, i);
  }

  /// Returns the index of a body, or `kFixedFrame`.
  int body_index(std::string_view name) const {
    return name == kWorld ? kFixedFrame : static_cast<int>(index_.at(name));
  }

  LinearDragLaw compile(const LinearDrag& law) const {
    return {index_.at(law.body), law.coefficient, law.angular_coefficient};
  }
  QuadraticDragLaw compile(const QuadraticDrag& law) const { return {index_.at(law.body), law.coefficient}; }
  PointForceLaw compile(const PointForce& law) const {
    return {index_.at(law.body), law.force, law.point, law.frame, law.start, law.duration};
  }
  TorqueLaw compile(const Torque& law) const {
    return {index_.at(law.body), law.torque, law.start, law.duration};
  }
  SpringForceLaw compile(const SpringForce& law) const {
    return {body_index(law.body_a), body_index(law.body_b), law.anchor_a, law.anchor_b,
            law.rest_length,        law.stiffness,          law.damping};
  }
  AttractionForceLaw compile(const AttractionForce& law) const {
    const double mass = scene_.bodies[index_.at(law.body)].mass;
    return {body_index(law.body), body_index(law.centre_body), law.centre, law.strength * mass, law.exponent};
  }
  SinusoidalForceLaw compile(const SinusoidalForce& law) const {
    return {index_.at(law.body), law.amplitude, law.point, law.angular_frequency, law.phase};
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
    return {body_index(law.body_a), body_index(law.body_b), law.anchor_a, law.anchor_b,
            Formula(law.tension, kSpringVariables)};
  }

 private:
  const Scene& scene_;
  std::map<std::string_view, std::size_t> index_;
};

}  // namespace plumb
