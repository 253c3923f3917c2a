#pragma once

#include "engine/world/world_data.h"

/// Feedback of position errors into velocities (Baumgarte, 1972), by impulses that are not accumulated.
///
/// If accumulated impulses include the feedback, the warm start of later substeps repeats it. Let iterations
/// reduce a mode's velocity error by the fraction r in a substep, and let f be the fraction of its position
/// error that is fed back. The mode's growth factor z per substep then solves
///     (z - 1)^3 + r (2 z - 1) (z - 1) + r f z^2 = 0,
/// and the mode decays only if r > f / (1 + f). Long chains and welded beams have slower modes, however many
/// the iterations, and explode. If the feedback has separate impulses that start from zero in each substep,
/// it is not repeated, and all modes decay for any r and f up to 1.
namespace plumb {

/// Adds velocities that close errors of joints and contacts at `rate`, 1/s, in as many iterations as the
/// solver makes; overlaps no faster than the contact's depenetration speed. The errors are those at the
/// substep's start: call this before the motion.
template <class Real>
void feed_back_errors(WorldData<Real>& w, Real rate);

}  // namespace plumb
