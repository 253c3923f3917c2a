#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/field/field_world.h"

namespace plumb::field {

/// An engine that can create worlds.
struct Engine {
  std::string name;
  std::string version;
  std::string missing;  ///< why it is not in this build; empty if it is
  std::unique_ptr<FieldWorld> (*create)(const WorldSettings&) = nullptr;
  std::vector<std::string> solvers{};  ///< names of its solvers, if there are several
  std::string solver{};                ///< the solver in use; empty: its default
  bool shares_steps = false;           ///< its worlds may share a step among threads
  int threads = 1;                     ///< that do
};

/// Returns all known engines, built in or not, the yardstick first.
std::span<const Engine> engines();

/// Returns `engine` with one of its solvers, called "engine:solver".
Engine with_solver(const Engine& engine, const std::string& solver);

/// Returns `engine` with this number of threads, called "engine:2" if there are two.
Engine with_threads(const Engine& engine, int threads);

}  // namespace plumb::field
