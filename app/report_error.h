#pragma once

#include <functional>

namespace plumb::app {

/// Runs `action`; converts an exception to one line on stderr, "plumb: ...", and an exit code.
int reporting_errors(const std::function<int()>& action);

}  // namespace plumb::app
