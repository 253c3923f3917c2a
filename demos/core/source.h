#pragma once

#include <string_view>

namespace plumb::demos {

/// Returns the C++ of a demo in this folder, as it was compiled; empty for one that is defined elsewhere.
std::string_view source_of(std::string_view demo);

}  // namespace plumb::demos
