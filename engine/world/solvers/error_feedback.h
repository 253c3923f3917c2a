#pragma once

#include "engine/world/world_data.h"

/// Feedback of position errors into velocities (Baumgarte, 1972), by impulses that are not accumulated.
/// If accumulated impulses included the feedback, the warm start of later substeps would repeat it. Let
/// iterations reduce a mode's velocity error by the fraction r in a substep, and let f be the fraction of its
/// position error that is fed back. The mode's growth factor z per substep then solves
///     (z - 1)^3 + r (2 z - 1) (z - 1) + r f z^2 = 0,
/// and the mode decays only if r > f / (1 + f). Long chains and welded beams always have slower modes,
/// whatever the number of iterations, and explode. Separate impulses for the feedback start from zero in each
/// substep. They are not repeated, so all modes decay for any r and f up to 1.
namespace plumb {

/// Adds velocities that close errors of joints and contacts at `rate`, 1/s, in as many iterations as the
/// solver makes. Overlaps close no faster than at the contact's depenetration speed. The errors are those at
/// the substep's start: call this before the motion.
template <class Real>
void feed_back_errors(WorldData<Real>& w, Real rate);

}  // namespace plumb
