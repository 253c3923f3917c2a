#pragma once

#include <vector>

#include "engine/scene/scene.h"

/// Additional scenes, which tell mistakes apart that give the same motion in a check.
namespace plumb::course {

struct Experiment {
  Scene scene;
  double duration = 0;  ///< s
};

/// Returns the experiments for a mistake that a check of the chapter has shown. Bodies differ in mass, size,
/// angle and place, so that no two quantities are equal by chance.
std::vector<Experiment> experiments(int chapter);

}  // namespace plumb::course
