#pragma once

#include <functional>

namespace plumb::app {

/// Runs `action`; an exception becomes one line on stderr, "plumb: ...", and an exit code.
int reporting_errors(const std::function<int()>& action);

}  // namespace plumb::app
