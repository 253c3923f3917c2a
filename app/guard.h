#pragma once

#include <functional>
#include <string>

namespace plumb::app {

/// Runs `work` in a child that shares stdout and stderr, so that an engine which crashes does not take plumb
/// with it. Returns the child's exit code; interrupts are passed on. Throws `Error` (Run) that names `engine`
/// and the signal where the child died.
int guarded(const std::string& engine, const std::function<int()>& work);

}  // namespace plumb::app
