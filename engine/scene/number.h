#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb {

/// Returns the numbers of `scene` that `path` names, in the words of the scene format: "gravity.y",
/// "contact_rules.yield_speed", "bodies.ball.mass", "bodies.ball.position.x", "bodies.ball.shapes[0].radius",
/// "joints.hinge.length", "joints.hinge.spring.hertz", "forces[0].stiffness". Bodies and joints are given by
/// name (if several names fit, the longest one counts) or, like forces, by index from 0. `shapes` without an
/// index means every shape of the body; these numbers change together. The start and the duration of a force
/// cannot be named. Throws `Error` (Name) if there is no such number. The pointers are valid until `scene`
/// changes.
std::vector<double*> numbers_at(Scene& scene, std::string_view path);

/// Kind of a number, by which the step of a difference in it is chosen.
enum class NumberKind {
  Length,   ///< m: a position or a size, relative to the scene's length
  Angle,    ///< rad
  Relative  ///< anything else, to be compared with itself
};
/// Returns the kind of the number that `path` names in `scene`, by its unit; Relative if there is no such
/// number.
NumberKind kind_of_number(Scene& scene, std::string_view path);

/// Returns the body whose initial state contains the number that `path` names; nullopt for any other number.
std::optional<std::size_t> body_of_initial_state(const Scene& scene, std::string_view path);

}  // namespace plumb
