#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/field/field_world.h"

namespace plumb::field {

/// Each of these is defined if its library was found.
std::unique_ptr<FieldWorld> create_box2d(const WorldSettings& settings);
std::unique_ptr<FieldWorld> create_box2d_v3(const WorldSettings& settings);
std::unique_ptr<FieldWorld> create_chipmunk(const WorldSettings& settings);
std::unique_ptr<FieldWorld> create_plumb(const WorldSettings& settings);

std::string chipmunk_version();
std::vector<std::string> plumb_solvers();

}  // namespace plumb::field
