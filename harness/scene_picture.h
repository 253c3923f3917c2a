#pragma once

#include <string>

#include "scenarios/scenario.h"

namespace plumb::harness {

/// Draws a case as SVG: bodies at rest in grey; moving bodies as outlines at the start and filled at the end,
/// with the paths of their centres; rods and springs at the end. Without an exact motion, only the start is
/// drawn.
std::string scene_picture(const scenarios::Problem& problem, const std::string& title);

}  // namespace plumb::harness
