#pragma once

#include <vector>

#include "harness/course/prediction.h"

/// The mistakes whose motion can be computed, by the chapters that teach the subject of the mistake.
namespace plumb::course {

std::vector<Predictable> mistakes_of_motion();
std::vector<Predictable> mistakes_of_contacts();
std::vector<Predictable> mistakes_of_boxes();
std::vector<Predictable> mistakes_of_joints();

/// Returns every way to use arms and directions of joints that were computed in an earlier step.
std::vector<Predictable> mistakes_of_kept_joints();

std::vector<Predictable> mistakes_of_order();

/// Returns every way to mix up the x and y of a vector, for every vector of an engine.
std::vector<Predictable> mistakes_of_axes();

/// Returns every point that is turned wrongly, every law that changes the wrong quantity, and every corner
/// that stands for another.
std::vector<Predictable> mistakes_of_places();

/// Returns every edit of a formula: a quantity of a body that another one stands for, or that is left out.
std::vector<Predictable> mistakes_of_edits();

}  // namespace plumb::course
