#pragma once

#include <string>
#include <string_view>

#include "engine/scene/scene.h"

namespace plumb {

/// Returns the scene as JSON; numbers are the shortest decimals that read back to the same bits. `indent` <
/// 0: one line. Throws `Error` for values without a JSON form: non-finite numbers (except a law's infinite
/// duration, which is left out) and names that are not UTF-8.
std::string to_json(const Scene& scene, int indent = 2);

/// Reads a scene and validates it. Throws `Error` with the line, the subject, the field and the value.
Scene scene_from_json(std::string_view text);

}  // namespace plumb
