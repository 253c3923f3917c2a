#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "harness/reality/drops.h"
#include "harness/reality/fit.h"

namespace plumb::harness::reality {

/// Returns the parameters of a law with the least loss over some drops. The loss is the mean over the times
/// of the logarithm of the middle half's mean error, so that each time has the same weight although errors
/// grow. Uses the Gauss-Newton method with Levenberg's damping, and the derivatives of Precise's motions
/// through their impacts (`Simulation::sensitivities`). Motions without a derivative do not direct a step,
/// but count in the loss.
Fit fit_drops(std::span<const DropStart* const> drops, const DropLaw& law);

/// Returns fitted values with their intervals; see `with_intervals`.
std::vector<Estimate> intervals_of_drops(std::span<const DropStart* const> drops, const DropLaw& law,
                                         std::span<const double> values, std::uint64_t seed);

}  // namespace plumb::harness::reality
