#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "demos/core/demo.h"

namespace plumb::demos {

/// A demo that can be created. Those of the course come first, in its order.
struct Entry {
  int order = 0;
  About about;
  std::unique_ptr<Demo> (*make)();
};

/// Returns all demos, by order and name.
const std::vector<Entry>& all();

/// Creates a demo. Throws Error (Name) that suggests the nearest name.
std::unique_ptr<Demo> make(std::string_view name);

/// Registers a demo in its own file: `const Register kEntry{order, about, make};`
struct Register {
  Register(int order, const About& about, std::unique_ptr<Demo> (*make)());
};

}  // namespace plumb::demos
