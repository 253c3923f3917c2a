#pragma once

#include <memory>
#include <string>

#include "reference/backend.h"

namespace plumb::reference {

/// An adapter called `name` that is listed with the `reason` why it cannot run, and runs nothing.
std::unique_ptr<Backend> make_unavailable(std::string name, std::string reason);

}  // namespace plumb::reference
