#pragma once

#include <algorithm>

#include "engine/world/state/constants.h"
#include "engine/world/world.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Returns the approach speed from which an impact is reported, m/s.
template <class Real>
Real min_hit_speed(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  const double set = w.settings.thresholds.hit;
  return set >= 0 ? static_cast<Real>(set)
                  : c.depenetration_speed * Real(tuning::kHitSpeed / tuning::kDepenetrationSpeed);
}

/// Returns a contact as the user sees it. The constraint stores each lever arm r as its components along t
/// and n.
template <class Real>
ContactReading reading_of(const WorldData<Real>& w, const ContactRecord& contact,
                          const ContactConstraint<Real>& c) {
  const auto id = [&](int shape) {
    return ShapeId{static_cast<std::uint32_t>(shape), w.shapes.generation(shape)};
  };
  ContactReading reading;
  reading.shape_a = id(contact.shape_a), reading.shape_b = id(contact.shape_b);
  reading.normal = c.normal.template as<double>();
  reading.count = c.count;
  const Vec2<Real> n = c.normal, t{n.y, -n.x};
  const double reading_scale = w.impulse_h > 0 ? w.last_h / w.impulse_h : 1;
  for (int i = 0; i < c.count; ++i) {
    // r x n = r.x n.y - r.y n.x = r . t, and r x t = -(r . n).
    const Vec2<Real> arm = c.arm_a[i] * t - c.arm_tangent_a * n;
    reading.points[i] = w.position[c.body_a] + arm.template as<double>();
    reading.separations[i] = static_cast<double>(c.separation[i]);
    reading.impulses[i] = reading_scale * static_cast<double>(c.normal_impulse[i]);
    reading.approach = std::min(reading.approach, static_cast<double>(c.approach[i]));
  }
  if (contact.hit_events || contact.pre_solve) reading.step_impulse = static_cast<double>(c.step_impulse);
  return reading;
}

}  // namespace plumb
