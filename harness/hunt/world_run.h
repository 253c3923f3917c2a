#pragma once

#include "harness/hunt/motion.h"

namespace plumb::harness::hunt {

/// Runs the case in a World of either precision, with its actions.
template <class Real>
Motion run_world(const Case& one, const RunOptions& options);

extern template Motion run_world<float>(const Case&, const RunOptions&);
extern template Motion run_world<double>(const Case&, const RunOptions&);

}  // namespace plumb::harness::hunt
