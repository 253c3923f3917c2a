#include "engine/world/encounter.h"

#include <algorithm>
#include <cmath>

#include "engine/collide/time_of_impact.h"
#include "engine/world/constants.h"
#include "engine/world/seams.h"

namespace plumb {
namespace {

// m/s, no point moves faster.
template <class Real>
Real fastest(Vec2<Real> velocity, Real turning) {
  return std::abs(velocity.x) + std::abs(velocity.y) + turning;
}

// m/s, of a body's points about its centre of mass.
template <class Real>
Real turning(const WorldData<Real>& w, int body) {
  return std::abs(w.motion[body].angular_velocity) * w.extents[body];
}

// Whether its way is going to be followed.
template <class Real>
bool is_fast(const WorldData<Real>& w, int body, Real dt) {
  return w.gives_way(body) && dt * fastest(w.motion[body].velocity, turning(w, body)) >
                                  Real(tuning::kFastShare) * w.bodies[body].half_width;
}

// In the step, seen from `origin`.
template <class Real>
Sweep<double> sweep_of(const WorldData<Real>& w, int body, Vec2d origin, double dt) {
  const BodyMotion<Real>& motion = w.motion[body];
  const Rotation<Real> q = w.rotation[body];
  return {w.position[body] - origin, dt * motion.velocity.template as<double>(),
          Rotation<double>{static_cast<double>(q.c), static_cast<double>(q.s)},
          dt * static_cast<double>(motion.angular_velocity)};
}

}  // namespace

template <class Real>
Encounter<Real> find_encounter(const WorldData<Real>& w, const ContactRecord& contact, Real dt) {
  const int a = contact.body_a, b = contact.body_b;
  const Real smaller = std::min(w.forms[contact.shape_a].extent, w.forms[contact.shape_b].extent);
  const Real closing =
      dt * fastest(w.motion[b].velocity - w.motion[a].velocity, turning(w, a) + turning(w, b));
  // Bodies of a size, none of them fast, come no nearer than that.
  if (!(closing > Real(2 * tuning::kContactReachMost) * smaller) || w.forms[contact.shape_a].chain) return {};
  if (!w.boxes[contact.shape_a].grown(closing).overlaps(w.boxes[contact.shape_b])) return {};
  if (is_fast(w, a, dt) || is_fast(w, b, dt)) return {};

  const Sweep<double> way_a = sweep_of(w, a, w.position[a], static_cast<double>(dt)),
                      way_b = sweep_of(w, b, w.position[a], static_cast<double>(dt));
  const Convex<Real> shape_a = w.convex(contact.shape_a), shape_b = w.convex(contact.shape_b);
  const Real tolerance = Real(tuning::kImpactTolerance) * smaller;
  const ImpactResult<Real> impact = time_of_impact(shape_a, way_a, shape_b, way_b, Real(0), tolerance);
  if (impact.state != ImpactResult<Real>::State::Hit) return {};

  const Pose<double> at_a = pose_at(way_a, impact.exact_fraction),
                     at_b = pose_at(way_b, impact.exact_fraction);
  const Rotation<double> to_a = at_a.rotation.inverse(), q = at_b.rotation;
  const Vec2d between = at_b.position - at_a.position;
  const auto rounded = [](const Rotation<double>& r) {
    return Rotation<Real>{static_cast<Real>(r.c), static_cast<Real>(r.s)};
  };
  const Pose<Real> b_in_a{(to_a * between).template as<Real>(),
                          rounded({to_a.c * q.c - to_a.s * q.s, to_a.s * q.c + to_a.c * q.s})};
  const Real reach = Real(tuning::kContactReach) * smaller;
  const ContactManifold<Real> manifold = collide_convex(shape_a, shape_b, b_in_a, reach);
  return {manifold.count > 0 ? across_seams(w, contact, b_in_a, reach, manifold, closing) : manifold,
          rounded(at_a.rotation), between.template as<Real>(), static_cast<Real>(impact.exact_fraction) * dt};
}

template Encounter<float> find_encounter(const WorldData<float>&, const ContactRecord&, float);
template Encounter<double> find_encounter(const WorldData<double>&, const ContactRecord&, double);

}  // namespace plumb
