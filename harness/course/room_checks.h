#pragma once

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// Checks of chapter 1 on a ball among walls and on a floor.
namespace plumb::course {

inline constexpr const char* kWallOfNoScene = "walls_hard_coded";

inline constexpr const char* kStill =
    "The ball never moves: add v dt to its position in each step; v begins with the scene's \"velocity\".";

inline constexpr const char* kTurnedEveryStep =
    "The ball sticks in the wall: its velocity is reversed in each step that it overlaps the wall. Reverse "
    "it only "
    "if it moves towards the wall, v . n < 0, and push the ball out.";

Finding four_walls(const Lab& lab);
Finding settles(const Lab& lab);

}  // namespace plumb::course
