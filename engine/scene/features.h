#pragma once

#include <string>

#include "engine/scene/scene.h"

/// What a scene has beyond what every engine knows: circles and boxes with friction and restitution, plain
/// revolute joints and rods. Each function gives the first such thing in words, or nothing.
namespace plumb {

/// A kind of shape or joint: "body 'lever' has a capsule", "joint 'door' is a prismatic joint".
std::string unusual_kind(const Scene& scene);

/// A field that is not at its default: "body 'kite' has linear_damping", "joint 'hip' has limits".
std::string unusual_field(const Scene& scene);

/// Either of the two.
std::string unusual_feature(const Scene& scene);

}  // namespace plumb
