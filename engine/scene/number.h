#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb {

/// Returns the numbers of `scene` that `path` names, in the words of the scene format: "gravity.y",
/// "contact_rules.yield_speed", "bodies.ball.mass", "bodies.ball.position.x", "bodies.ball.shapes[0].radius",
/// "joints.hinge.length", "joints.hinge.spring.hertz", "forces[0].stiffness". Bodies, joints and forces are
/// named (of names that fit, the longest is meant) or counted from 0; `shapes` without a number means that of
/// every shape of the body, which change together. The start and the duration of a force are not named.
/// Throws `Error` (Name) if there is no such number. The pointers are valid until `scene` changes.
std::vector<double*> numbers_at(Scene& scene, std::string_view path);

/// The meaning of a number for the choice of a difference in it.
enum class NumberKind {
  Length,   ///< m: a place or an extent, to be compared with the scene's length
  Angle,    ///< rad
  Relative  ///< anything else, to be compared with itself
};
/// Returns the kind of what `path` names in `scene`, by its unit; Relative if there is no such number.
NumberKind kind_of_number(Scene& scene, std::string_view path);

/// Returns the body of which `path` names a number of the state at the start; nothing for any other number.
std::optional<std::size_t> body_of_start(const Scene& scene, std::string_view path);

}  // namespace plumb
