#pragma once

#include "engine/scene/joint.h"
#include "engine/scene/json/json_fields.h"

namespace plumb::json {

/// Reads the joint at `view`; throws `Error` that names the place and the problem.
Joint read_joint(const View& view);

}  // namespace plumb::json
