#pragma once

#include "engine/world/world_data.h"

/// Tells impulses of impacts from those of loads. A load acts in each substep, so its impulses are a good
/// start for the next one: warm starting. The impulses of an impact have done their work. Reused, they throw
/// up a stack that has just landed, because one iteration takes only part of them back.
///
/// A load changes a body's velocity by about the same amount in each substep: not at all at rest, by a
/// constant in a centrifuge. An impact changes it suddenly. Bodies whose change of velocity differs from that
/// of the substep before count as struck, and all contacts of a struck body start from zero. Bodies with
/// joints never do: their joints' impulses would have to go too, and reach other bodies.
namespace plumb {

/// Updates the changes of velocity of all bodies that move by substeps, at the end of a substep of a step of
/// `dt`, s. Returns true if a body has been struck.
template <class Real>
bool find_struck_bodies(WorldData<Real>& w, double dt);

/// Returns true if a body that moves by substeps was struck in the last substep of the last step.
template <class Real>
bool any_struck_body(const WorldData<Real>& w);

}  // namespace plumb
