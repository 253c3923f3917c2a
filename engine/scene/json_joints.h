#pragma once

#include "engine/scene/joint.h"
#include "engine/scene/json_fields.h"

namespace plumb::json {

/// The joint at `view`; throws `Error` that says where and what.
Joint read_joint(const View& view);

}  // namespace plumb::json
