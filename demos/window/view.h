#pragma once

#include <vector>

#include "demos/window/player.h"
#include "scenarios/scenario.h"

namespace plumb::window {

/// Returns every scenario of the catalogue, each variant and size, with its truth and every engine to compare
/// with.
std::vector<Item> scenario_items();

/// Returns one instance of a scenario.
Item scenario_item(const scenarios::Instance& instance);

/// Returns a scene without a known answer; other engines run it for `duration` s.
Item scene_item(const Scene& scene, double duration);

}  // namespace plumb::window
