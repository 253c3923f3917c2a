#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/hunt/case.h"
#include "harness/hunt/objection.h"

namespace plumb::harness::hunt {

/// A judge's objection to one engine's run of one case, with the smallest failing case that was found.
struct Finding {
  std::string engine;
  Objection objection;  ///< to the smallest case, if there is one
  Case smallest;
  bool shrunk = false;
  std::string kind{};  ///< judge, and the parts of the smallest case
};

/// Names the parts of the case that matter to a law: its kinds of joints, of shapes, of actions.
std::string made_of(const Case& one, const std::string& law = "");

/// Converts to one line of JSON.
std::string to_json(const Finding& finding);
Finding finding_from_json(std::string_view text);

}  // namespace plumb::harness::hunt
