#pragma once

#include <vector>

#include "demos/compared/sampled_motion.h"
#include "demos/window/player.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::window {

/// Engines in addition to the built-in ones.
struct Engines {
  std::vector<const reference::Backend*> more{};  ///< can be drawn as outlines
  const reference::Backend* shown =
      nullptr;           ///< moves the scene; null: plumb's world, which can be played with
  double dt = 1.0 / 60;  ///< s, of `shown`
};

/// Returns every scenario of the catalogue, each variant and size, with its truth and every engine to compare
/// with.
std::vector<Item> scenario_items(const Engines& engines = {});

/// Returns one instance of a scenario.
Item scenario_item(const scenarios::Instance& instance, const Engines& engines = {});

/// Returns a scene without a known answer; other engines run it for `duration` s.
Item scene_item(const Scene& scene, double duration, const Engines& engines = {});

/// Returns the motion that an engine has computed for a scene, played back, with the right motion as an
/// outline.
Item motion_item(const demos::About& about, const Scene& scene, const demos::SampledMotion& motion,
                 const Engines& engines);

}  // namespace plumb::window
