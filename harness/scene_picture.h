#pragma once

#include <string>

#include "scenarios/scenario.h"

namespace plumb::harness {

/// Draws a case as SVG: what does not move in grey, bodies at the start as outlines and at the end filled,
/// the paths of their centres between, rods and springs at the end. Where there is no exact motion, the start
/// alone.
std::string scene_picture(const scenarios::Problem& problem, const std::string& title);

}  // namespace plumb::harness
