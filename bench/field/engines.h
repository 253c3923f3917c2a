#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/field/field_world.h"

namespace plumb::field {

/// An engine that worlds can be made of.
struct Engine {
  std::string name;
  std::string version;
  std::string missing;  ///< why it is not in this build; empty when it is
  std::unique_ptr<FieldWorld> (*create)(const WorldSettings&) = nullptr;
  std::vector<std::string> solvers{};  ///< that it has to choose from
  std::string solver{};                ///< that this one runs; empty: its default
};

/// All that the benchmark knows of, built in or not, the yardstick first.
std::span<const Engine> engines();

/// `engine` with one of its solvers, called "engine:solver".
Engine with_solver(const Engine& engine, const std::string& solver);

}  // namespace plumb::field
