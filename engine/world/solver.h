#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace plumb {

/// Solver of contacts and joints. Each is a file in engine/world/solvers; docs/guide/solvers.md compares
/// them.
enum class Solver : std::uint8_t {
  SoftSteps,           ///< soft constraints with substeps and relaxation; direct solve of small islands
  SequentialImpulses,  ///< Catto (2005): accumulated impulses, with feedback of position errors
  Jakobsen,            ///< Jakobsen (2001): projection of positions, velocities from positions
  Xpbd,                ///< Macklin and Mueller (2016): a projection with compliance in each substep
  Direct,              ///< soft steps, with a direct solve of islands with joints
};

/// Names in command lines and tables, by Solver.
inline constexpr const char* kSolverNames[] = {"soft_steps", "sequential_impulses", "jakobsen", "xpbd",
                                               "direct"};

constexpr const char* name_of(Solver solver) { return kSolverNames[static_cast<int>(solver)]; }

constexpr std::optional<Solver> solver_of(std::string_view name) {
  for (int i = 0; i < 5; ++i) {
    if (name == kSolverNames[i]) return static_cast<Solver>(i);
  }
  return std::nullopt;
}

}  // namespace plumb
