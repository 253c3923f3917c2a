#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/check.h"
#include "engine/scene/json_document.h"

/// From values in a scene's JSON to the names that errors give them, and back.
namespace plumb::json {

/// What an error calls a value.
struct Naming {
  std::string subject;  ///< "body 'ball'"
  std::string field;    ///< "shapes[1].radius"; empty for the subject itself
};

/// The naming of the last node of `path`, which leads there from the root.
Naming naming_of(const std::vector<const Node*>& path);

/// The line of `field` of the thing at `place`; where the text leaves the field out, that of what should hold
/// it.
int line_of(const Node& root, const Place& place, std::string_view field);

}  // namespace plumb::json
