#pragma once

#include <memory>
#include <span>
#include <string>

#include "bench/field/field_world.h"

namespace plumb::field {

/// An engine that worlds can be made of.
struct Engine {
  std::string name;
  std::string version;
  std::string missing;  ///< why it is not in this build; empty when it is
  std::unique_ptr<FieldWorld> (*create)(const WorldSettings&) = nullptr;
};

/// All that the benchmark knows of, built in or not, the yardstick first.
std::span<const Engine> engines();

}  // namespace plumb::field
