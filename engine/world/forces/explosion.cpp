#include <cmath>

#include "engine/world/force_laws.h"
#include "engine/world/forces/law_bodies.h"
#include "engine/world/queries.h"
#include "engine/world/state/lock.h"

namespace plumb {
namespace {

// Returns true if another body lies between the centre of the explosion and the body's point at `offset` from
// it.
template <class Real>
bool is_occluded(const BasicWorld<Real>& world, int body, Vec2d centre, Vec2d offset,
                 const QueryFilter& cover) {
  QueryFilter filter = cover;
  const auto others = [&](ShapeId shape) {
    return world.data().shapes[static_cast<int>(shape.index)].body != body && cover.condition(shape);
  };
  filter.condition = others;
  return ray_cast_closest(world, centre, offset, filter).has_value();
}

}  // namespace

template <class Real>
void explode(BasicWorld<Real>& world, const Blast& blast, const ExplosionOptions& options) {
  require_finite("explosion", "centre", blast.centre);
  require_positive("explosion", "radius", blast.radius);
  require_finite("explosion", "impulse", blast.impulse);
  WorldData<Real>& w = unlocked_with_masses(world);
  if (options.occlusion && options.cover.ignore != BodyId{}) world.position(options.cover.ignore);
  const Lock<Real> lock(w, options.occlusion && options.cover.condition.asks());
  WrenchList list;
  for_each_law_body(w, true, [&](int body) {
    const Vec2d to_body = w.position[body] - blast.centre;
    const double range = blast.radius + static_cast<double>(w.extents[body]);
    if (length_squared(to_body) >= range * range) return;
    const Rotation<double> rotation = normalised_rotation(w, body);
    Wrench<double> sum;
    for_each_solid_shape(w, body, [&](int shape) {
      const LawShape placed(w, shape, rotation, to_body);
      visit_blast(blast, placed.convex(), [&](Vec2d impulse, Vec2d point) {
        if (options.occlusion && is_occluded(world, body, blast.centre, point, options.cover)) return;
        sum += {impulse, cross(point - to_body, impulse)};
      });
    });
    if (sum.force == Vec2d{} && sum.torque == 0) return;
    require_finite_wrench(w, body, sum, "explosion");
    list.add(body, sum);
  });
  for (const BodyWrench& item : list) {
    wake_pushed(w, item.body);
    apply_body_impulse(w, item.body, item.wrench.force, item.wrench.torque);
  }
}

template void explode(BasicWorld<float>&, const Blast&, const ExplosionOptions&);
template void explode(BasicWorld<double>&, const Blast&, const ExplosionOptions&);

}  // namespace plumb
