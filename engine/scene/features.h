#pragma once

#include <string>

#include "engine/scene/scene.h"

/// Features of a scene that not every engine supports: everything except circles and boxes with friction and
/// restitution, plain revolute joints and rods. Each function describes the first such feature, or returns
/// nothing.
namespace plumb {

/// Returns a kind of shape or joint that few engines have: "body 'lever' has a capsule", "joint 'door' is a
/// prismatic joint".
std::string unusual_kind(const Scene& scene);

/// Returns a field that is not at its default: "body 'kite' has linear_damping", "joint 'hip' has limits".
std::string unusual_field(const Scene& scene);

/// Returns a contact rule that only Precise has: "contact_rules has impact 'stronge'".
std::string unusual_rule(const Scene& scene);

/// Returns an unusual kind or an unusual field.
std::string unusual_feature(const Scene& scene);

}  // namespace plumb
