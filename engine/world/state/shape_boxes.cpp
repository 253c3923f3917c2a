#include "engine/world/state/shape_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/convex_bounds.h"

namespace plumb {

template <class Real>
Aabb<Real> tight_aabb(const WorldData<Real>& w, int shape) {
  const int body = w.shapes[shape].body;
  return convex_bounds(w.convex(shape), Pose<Real>{w.position[body].template as<Real>(), w.rotation[body]});
}

template <class Real>
Aabb<Real> fat_aabb(const WorldData<Real>& w, int shape, Real dt) {
  const int body = w.shapes[shape].body;
  Aabb<Real> box = w.tight_aabbs[shape];
  // The margin covers the rounding of positions far from the origin.
  const Real far =
      std::max(std::abs(box.lower.x) + std::abs(box.lower.y), std::abs(box.upper.x) + std::abs(box.upper.y));
  const Real rounding = 4 * std::numeric_limits<Real>::epsilon() * far;
  // Static shapes get no margin: 10 % of a large ground would pair it with everything nearby.
  if (w.bodies[body].type == BodyType::Static) return box.grown(rounding);
  box = box.grown(Real(tuning::kAabbMargin) * w.forms[shape].extent + rounding);
  const SolverBody<Real>& motion = w.motion[body];
  const bool alone = w.bodies[body].first_contact == kNone;
  const Real distance = dt * (std::abs(motion.velocity.x) + std::abs(motion.velocity.y));
  const Real further = alone
                           ? Real(tuning::kPredictedSteps - 1) * distance
                           : std::clamp(Real(tuning::kMaxCrowdPrediction) * w.forms[shape].extent - distance,
                                        Real(0), distance);
  const Real steps = distance > 0 ? 1 + further / distance : Real(1);
  return predicted_aabb(box, (steps * dt) * motion.velocity,
                        dt * std::abs(motion.angular_velocity) * w.extents[body], w.extents[body]);
}

template <class Real>
bool update_proxy(WorldData<Real>& w, int shape, Real dt, Real rotation_distance) {
  return update_aabbs(w, shape, dt, rotation_distance, [&](int left, const Aabb<Real>& box) {
    store_fat_aabb(w, left, box, w.tree_of(w.bodies[w.shapes[left].body].type));
  });
}

#define PLUMB_FOR(Real)                                            \
  template Aabb<Real> tight_aabb(const WorldData<Real>&, int);     \
  template Aabb<Real> fat_aabb(const WorldData<Real>&, int, Real); \
  template bool update_proxy(WorldData<Real>&, int, Real, Real);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
