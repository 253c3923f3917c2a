#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/check.h"
#include "engine/scene/json/json_document.h"

/// Converts between values in a scene's JSON and the names that errors give them.
namespace plumb::json {

/// The name of a value in errors.
struct Naming {
  std::string subject;  ///< "body 'ball'"
  std::string field;    ///< "shapes[1].radius"; empty for the subject itself
};

/// Returns the naming of the last node of `path`, which starts at the root.
Naming naming_of(const std::vector<const Node*>& path);

/// Returns the line of `field` of the thing at `location`; the line of its parent if the text does not
/// contain the field.
int line_of(const Node& root, const SceneLocation& location, std::string_view field);

}  // namespace plumb::json
