#pragma once

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// Checks of chapter 5 on sticks: one between two circles, a pendulum, and a chain.
namespace plumb::course {

Finding stick_keeps_its_length(const Lab& lab);
Finding stick_weighs_masses(const Lab& lab);
Finding pendulum(const Lab& lab);
Finding chain_swings(const Lab& lab);

}  // namespace plumb::course
