#pragma once

#include <memory>
#include <string_view>

#include "reference/backend.h"

namespace plumb::reference {

/// Bullet's articulated bodies (Featherstone's algorithm in joint angles), in the precision that this file's
/// source is compiled for, as an adapter called `name`. Both views must outlive it.
std::unique_ptr<Backend> make_bullet_multibody_backend(std::string_view name, std::string_view summary);

}  // namespace plumb::reference
