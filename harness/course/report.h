#pragma once

#include <span>
#include <string>

#include "harness/course/course.h"
#include "harness/style.h"

namespace plumb::course {

/// A chapter's name, before its checks.
std::string heading(const Chapter& chapter, const harness::Style& style);

/// A check's verdict; where it failed its figures and what is likely wrong.
std::string line(const Outcome& outcome, const harness::Style& style);

/// The score by chapter, and what to do next.
std::string score(std::span<const Outcome> outcomes, const harness::Style& style);

/// All of it as a JSON object; docs/course/README.md names its members.
std::string as_json(const std::string& engine, std::span<const Outcome> outcomes);

bool all_passed(std::span<const Outcome> outcomes);

}  // namespace plumb::course
