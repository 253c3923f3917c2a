#include <cmath>

#include "engine/forces/submerged.h"
#include "engine/math/trigonometry.h"
#include "engine/world/force_laws.h"
#include "engine/world/forces/law_bodies.h"
#include "engine/world/state/lock.h"

namespace plumb {
namespace {

Rotation<double> product(Rotation<double> a, Rotation<double> b) {
  return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
}

}  // namespace

template <class Real>
void apply_wind(BasicWorld<Real>& world, const Wind& wind, double dt, LawOptions options) {
  require_finite("wind", "velocity", wind.velocity);
  require_not_negative("wind", "density", wind.density);
  require_positive("wind", "dt", dt);
  WorldData<Real>& w = unlocked_with_masses(world);
  apply_to_bodies(w, options.wakes, [&](int body) {
    const SolverBody<Real>& motion = w.motion[body];
    const Vec2d velocity = motion.velocity.template as<double>();
    const double spin = static_cast<double>(motion.angular_velocity);
    const Rotation<double> rotation = normalised_rotation(w, body);
    WindLoad sum;
    for_each_solid_shape(w, body, [&](int shape) {
      const LawShape placed(w, shape, rotation, {});
      const WindLoad load = wind_load(wind, placed.convex(), velocity, spin);
      sum.wrench += load.wrench, sum.power += load.power;
    });
    return bounded_drag(motion, sum.wrench, sum.power, dt);
  });
}

template <class Real>
void apply_water(BasicWorld<Real>& world, const Water& water, double dt, LawOptions options) {
  require_finite("water", "level", water.level);
  require_finite("water", "velocity", water.velocity);
  require_not_negative("water", "density", water.density);
  require_not_negative("water", "linear_drag", water.linear_drag);
  require_not_negative("water", "angular_drag", water.angular_drag);
  require_positive("water", "dt", dt);
  WorldData<Real>& w = unlocked_with_masses(world);
  const Vec2d gravity = w.settings.gravity;
  const double g = std::sqrt(length_squared(gravity));
  const Vec2d up = g > 0 ? (-1 / g) * gravity : Vec2d{0, 1};
  // Rotation into the water's frame, whose y axis is up.
  const Rotation<double> level{up.y, up.x};

  apply_to_bodies(w, options.wakes, [&](int body) -> Wrench<double> {
    const SolverBody<Real>& motion = w.motion[body];
    const Vec2d velocity = motion.velocity.template as<double>();
    const double spin = static_cast<double>(motion.angular_velocity);
    // Evaluated at the middle of the step, so that floating bodies bob without gaining energy.
    const Vec2d centre = w.position[body] + (0.5 * dt) * velocity;
    const double height = dot(up, centre) - water.level;
    if (height >= static_cast<double>(w.extents[body])) return {};
    const Rotation<double> rotation =
        product(level, product(normalised_rotation(w, body), rotation_of(0.5 * dt * spin)));
    Wrench<double> lift, drag;
    double power = 0;
    for_each_solid_shape(w, body, [&](int shape) {
      const LawShape placed(w, shape, rotation, {0, height});
      const Submerged part = submerged_part(placed.convex());
      if (part.area == 0) return;
      const Vec2d arm = level.inverse() * (part.centroid - Vec2d{0, height});
      const Vec2d weight = (water.density * part.area) * gravity;
      lift += {-weight, -cross(arm, weight)};
      const Vec2d slip = water.velocity - velocity - cross(spin, arm);
      const Vec2d force = (water.linear_drag * part.area) * slip;
      const double torque = -water.angular_drag * part.area * spin;
      drag += {force, cross(arm, force) + torque};
      power += dot(force, slip) - torque * spin;
    });
    lift += bounded_drag(motion, drag, power, dt);
    return lift;
  });
}

#define PLUMB_INSTANTIATE(Real)                                                 \
  template void apply_wind(BasicWorld<Real>&, const Wind&, double, LawOptions); \
  template void apply_water(BasicWorld<Real>&, const Water&, double, LawOptions);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
