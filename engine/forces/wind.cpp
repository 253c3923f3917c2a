#include "engine/forces/wind.h"

#include <cmath>

namespace plumb {

WindLoad wind_load(const Wind& wind, const Convex<double>& shape, Vec2d velocity, double spin) {
  WindLoad load;
  const auto add = [&](Vec2d force, Vec2d at, Vec2d flow) {
    load.wrench += {force, cross(at, force)};
    load.power += dot(force, flow);
  };
  const auto flow_at = [&](Vec2d at) { return wind.velocity - velocity - cross(spin, at); };
  visit_outline(
      shape,
      [&](Vec2d start, Vec2d end, Vec2d normal) {
        const Vec2d middle = 0.5 * (start + end);
        const Vec2d flow = flow_at(middle);
        const double into = -dot(flow, normal);
        if (into <= 0) return;
        const double length = std::sqrt(length_squared(end - start));
        add((-0.5 * wind.density * into * into * length) * normal, middle, flow);
      },
      [&](const OutlineArc& arc) {
        const Vec2d flow = flow_at(arc.centre);
        const double speed2 = length_squared(flow);
        if (speed2 == 0) return;
        const Vec2d upwind = (-1 / std::sqrt(speed2)) * flow;
        const FacingArc part = facing_part(arc, upwind);
        // Integrals of cos^2 times the normal (cos, sin) over the angle from upwind.
        const auto along = [](double s) { return s - s * s * s / 3; };
        const auto cube = [](double c) { return c * c * c; };
        const double forward = along(part.sine_to) - along(part.sine_from);
        const double sideways = (cube(part.cosine_from) - cube(part.cosine_to)) / 3;
        add((-0.5 * wind.density * speed2 * arc.radius) *
                (forward * upwind + sideways * perpendicular(upwind)),
            arc.centre, flow);
      });
  return load;
}

}  // namespace plumb
