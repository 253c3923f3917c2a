#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/collision/manifold/contact_manifold.h"
#include "engine/world/state/constants.h"
#include "engine/world/world_data.h"

namespace plumb {

/// Prediction for two separated shapes whose bodies keep their present velocities through the step.
enum class ImpactPrediction : std::uint8_t {
  NotSearched,  ///< no contact plane would be crossed, or the shapes touch already
  Miss,         ///< a plane would be crossed, but the shapes pass each other
  Hit,          ///< they touch
};

/// Speculative contact at the time of impact, set for ImpactPrediction::Hit.
template <class Real>
struct SpeculativeContact {
  ImpactPrediction prediction = ImpactPrediction::NotSearched;
  ContactManifold<Real> manifold{};           ///< at the impact, in the frame of a
  Rotation<Real> rotation{};                  ///< of a at the impact
  Vec2<Real> a_to_b{};                        ///< m, from a's centre of mass to b's at the impact
  Vec2<Real> displacement{};                  ///< m, change of `a_to_b` since the step's start
  Real delta_angle_a = 0, delta_angle_b = 0;  ///< rad, rotations until the impact
  Vec2<Real> velocity{};                      ///< m/s, of b's centre of mass relative to a's, at the impact
};

/// Finds the speculative contact of two shapes with the current manifold `closest`. The plane through the
/// closest points is only an estimate: it would deflect a shape that passes a corner closely, and a rotating
/// shape hits elsewhere. So if a plane would be crossed, it counts only if the shapes really touch.
///
/// Shapes without points are searched if they approach in a step by more than half of the smaller extent.
/// Otherwise the smaller shape would be deep in the other one before they had a contact. Bodies that are fast
/// for their own size are left to continuous collision (continuous.cpp).
///
/// Solvers look a substep ahead, so planes that would be crossed up to a substep after the step count, too.
///
/// Bodies in free flight are predicted on their parabola, all others on a straight line. If a joint or
/// a pressing contact holds one of two dynamic bodies, shapes that pass each other get no contact, and those
/// that meet keep the plane of `closest`. They also keep it if they press on each other (`pressed`: they had
/// an impulse in the last substep), or if other dynamic bodies press on them and may push them together.
template <class Real>
SpeculativeContact<Real> find_speculative_contact(const WorldData<Real>& w, const ContactRecord& contact,
                                                  const ContactManifold<Real>& closest, bool pressed, Real dt,
                                                  Real substep);

/// Returns the speculative margin: a fraction of the smaller shape's extent, plus the possible approach in
/// the step.
template <class Real>
Real speculative_margin(const SolverBody<Real>& a, const SolverBody<Real>& b, Real extent_a, Real extent_b,
                        Real dt) {
  const Real smaller = std::min(extent_a, extent_b);
  const Real approach = dt * (l1_norm(b.velocity - a.velocity) + std::abs(a.angular_velocity) * extent_a +
                              std::abs(b.angular_velocity) * extent_b);
  return Real(tuning::kSpeculativeMargin) * smaller +
         std::min(approach, Real(tuning::kMaxSpeculativeApproach) * smaller);
}

/// Builds a speculative constraint at the predicted impact, with the present separations. Writes the impulses
/// that points keep to `impulse`.
template <class Real>
void prepare_speculative_contact(const WorldData<Real>& w, const ContactRecord& contact,
                                 const SpeculativeContact<Real>& at, ContactConstraint<Real>& c,
                                 Real (&impulse)[2]);

/// Does the same for separated shapes that meet in the step. If a point, extrapolated back along its tangent
/// to the step's start, would be inside of the other shape, its overlap there is not real and must not be
/// pushed out.
template <class Real>
void prepare_impact_contact(const WorldData<Real>& w, const ContactRecord& contact,
                            const SpeculativeContact<Real>& at, ContactConstraint<Real>& c,
                            Real (&impulse)[2]);

}  // namespace plumb
