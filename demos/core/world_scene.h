#pragma once

#include <string>

#include "demos/core/demo.h"

namespace plumb::demos {

/// Returns the present state of a world as a scene, which every engine can run: bodies, shapes, materials and
/// joints. Static bodies without shapes become the scene's fixed frame. Sensors, bands of the pointer, and
/// joints that drive a body to a pose are left out. If two bodies have the same name, a number is appended.
Scene scene_of(const DemoWorld& world, const std::string& name);

}  // namespace plumb::demos
