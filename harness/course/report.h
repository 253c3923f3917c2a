#pragma once

#include <span>
#include <string>

#include "harness/course/course.h"
#include "harness/style.h"

namespace plumb::course {

/// Returns the heading of a chapter, printed before its checks.
std::string heading(const Chapter& chapter, const harness::Style& style);

/// Returns a check's verdict; if it failed, also its figures and the likely mistake.
std::string line(const Outcome& outcome, const harness::Style& style);

/// Returns the score by chapter, and the next thing to do.
std::string score(std::span<const Outcome> outcomes, const harness::Style& style);

/// Returns everything as a JSON object; docs/course/README.md names its members.
std::string as_json(const std::string& engine, std::span<const Outcome> outcomes);

bool all_passed(std::span<const Outcome> outcomes);

}  // namespace plumb::course
