#pragma once

#include <string>

#include "engine/scene/scene.h"

/// Limits that several adapters share: only discs and boxes, and only plain hinges or rigid rods as joints.
namespace plumb::reference {

/// Returns the reason why `scene` has a joint that is neither a hinge nor a rod, or one with limits, a range,
/// a motor or a spring; empty if all are plain.
std::string not_plain_joints(const Scene& scene);

/// Returns the reason why `body` has a shape that is neither a circle nor a box; empty if all are.
std::string not_circles_and_boxes(const Body& body);

/// Returns the position at time 0 of `anchor`, which is given in the frame of the body called `name` or of
/// the world, m.
Vec2d anchor_in_world(const Scene& scene, const std::string& name, Vec2d anchor);

}  // namespace plumb::reference
