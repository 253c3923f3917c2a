#pragma once

#include <string>

namespace plumb::harness {

/// Returns docs/known-limits.md: every declared limit, in Markdown.
std::string known_limits_page();

}  // namespace plumb::harness
