#pragma once

#include <memory>
#include <string>

#include "reference/backend.h"

namespace plumb::reference {

/// Placeholder for an adapter called `name` that cannot run; it is listed with the `reason`.
std::unique_ptr<Backend> make_unavailable(std::string name, std::string reason);

}  // namespace plumb::reference
