#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Names of a scene's objects in errors.
namespace plumb {

/// Returns "scene 'tower'", or "scene" without a name.
std::string scene_subject(std::string_view name);

/// Returns "body 'ball'"; "body 3", counted from 0, without a name.
std::string body_subject(std::size_t index, std::string_view name);

/// Returns "joint 'hinge'"; "joint 3", counted from 0, without a name.
std::string joint_subject(std::size_t index, std::string_view name);

/// Returns "force 2 (linear_drag on 'ball')", counted from 0; force laws have no names. Empty parts are left
/// out.
std::string force_subject(std::size_t index, std::string_view law, std::string_view body);

/// Returns "drive 2", counted from 0; drives have no names.
std::string drive_subject(std::size_t index);

}  // namespace plumb
