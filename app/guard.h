#pragma once

#include <functional>
#include <string>

namespace plumb::app {

/// Runs `work` in a child that shares stdout and stderr, so that an engine's crash does not end plumb.
/// Returns the child's exit code; forwards interrupts. Throws `Error` (Run) that names `engine` and the
/// signal if the child died.
int guarded(const std::string& engine, const std::function<int()>& work);

}  // namespace plumb::app
