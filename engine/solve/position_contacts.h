#pragma once

#include "engine/solve/body_motion.h"
#include "engine/solve/contact_graph.h"

/// Contacts solved on positions: overlaps are projected away by moving bodies. Within a substep a body's
/// velocity is the way that it has come since the substep's start over h: moving it by dx changes the
/// velocity by dx / h, and the multiplier over h is an impulse.
namespace plumb {

template <class Real>
struct PositionStep {
  Real h = 0, inverse_h = 0;  ///< s, 1/s, of the substep
  Real bounce_threshold = 0;  ///< m/s; slower impacts do not bounce
};

/// How friction acts on positions.
enum class PositionFriction {
  Coulomb,  ///< takes back sliding as far as mu times the normal multiplier (Jakobsen, 2001)
  Static,   ///< takes it back all or not at all; what slides is left to velocities (Mueller et al., 2020)
};

/// At a substep's start, before forces act: no impulses yet. Until a point has been pressed in this step its
/// approach is that of now.
template <class Real>
void begin_position_contacts(BodyMotion<Real>* motion, ContactGraph<Real>& graph);

/// One sweep over predicted positions: overlaps away, but not faster than a contact may push, then sliding.
/// Positions, rotations and velocities follow.
template <class Real>
void project_contacts(BodyMotion<Real>* motion, Rotation<Real>* rotation, ContactGraph<Real>& graph,
                      const PositionStep<Real>& step, PositionFriction friction);

/// Velocities afterwards. What was pressed and came fast leaves with restitution times its approach, and
/// nothing that was pressed closes on.
template <class Real>
void restore_bounces(BodyMotion<Real>* motion, ContactGraph<Real>& graph, const PositionStep<Real>& step);

/// As `restore_bounces`, and (Mueller et al., 2020, section 3.6) what else was pressed does not leave with
/// the speed of having been pushed out either; then friction of what slides, |dv| <= mu lambda_n / m.
template <class Real>
void correct_contact_velocities(BodyMotion<Real>* motion, ContactGraph<Real>& graph,
                                const PositionStep<Real>& step);

}  // namespace plumb
