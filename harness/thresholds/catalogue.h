#pragma once

#include "harness/thresholds/threshold.h"

/// One function for each threshold's file; `catalogue.cpp` lists them.
namespace plumb::harness::thresholds {

Threshold ramp_friction();
Threshold steep_ramp_friction();
Threshold toppling_angle();
Threshold toppling_push();
Threshold overhang();
Threshold overhang_of_two();
Threshold arch_thickness();
Threshold heavy_on_light();
Threshold heavy_tip();
Threshold spring_force();
Threshold spring_joint();
Threshold stopped_bullet();
Threshold free_speed();
Threshold free_spin();

}  // namespace plumb::harness::thresholds
