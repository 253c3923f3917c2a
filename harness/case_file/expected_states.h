#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/case_file/member.h"
#include "scenarios/scenario.h"

namespace plumb::harness::case_file {

inline constexpr std::array<const char*, 6> kStateComponents{"x", "y", "angle", "vx", "vy", "w"};
inline constexpr std::array<const char*, 4> kStateKinds{"position", "angle", "velocity", "angular_velocity"};

/// Tolerances by `kStateKinds`, in SI units; a kind without one is not compared.
using StateTolerances = std::array<std::optional<double>, 4>;

/// Returns the kind of a component.
constexpr std::size_t kind_of(std::size_t component) {
  constexpr std::size_t kKinds[] = {0, 0, 1, 2, 2, 3};
  return kKinds[component];
}

inline double component(const BodyState& state, std::size_t index) {
  const double all[] = {state.position.x, state.position.y, state.angle,
                        state.velocity.x, state.velocity.y, state.angular_velocity};
  return all[index];
}

/// Time on either side of an impact in which expected velocities are not compared, s: an engine may detect
/// the impact within a step of 1/60 s.
inline constexpr double kImpactWindow = 1.0 / 60 * (1 + 1e-9);

/// Expected state of one body at one time; components that are not given are empty.
struct StateRow {
  double time = 0;  ///< s
  std::string body;
  std::array<std::optional<double>, 6> values{};  ///< by `kStateComponents`
};

/// Reads rows of the columns t, body, and any of x, y, angle, vx, vy, w, as `plumb run` writes them. `path`
/// is for errors. Throws `Error` (Syntax, Value) with the line.
std::vector<StateRow> states_from_csv(const std::string& text, const std::string& path);

/// Reads a list of objects with the same members.
std::vector<StateRow> states_from(const Member& list);

/// Returns one expectation per body and component in `rows`. Throws `Error` for a body that the scene lacks
/// and for a time beyond `duration`.
std::vector<scenarios::Expectation> expectations_of(const std::vector<StateRow>& rows, const Scene& scene,
                                                    double duration, const StateTolerances& tolerances);

}  // namespace plumb::harness::case_file
