#pragma once

#include <span>
#include <string>
#include <vector>

#include "demos/window/canvas.h"
#include "engine/math/vec2.h"

namespace plumb::window {

/// A text in the picture.
struct Label {
  Vec2d pixel{};  ///< below the middle of the text
  std::string text;
  Colour colour{};
};

/// Returns the labels that can be read beside each other in a picture of `picture` px, in their order: each
/// above its point, else below it, else left out, since texts over each other cannot be read; moved sideways
/// where the picture's edge would cut it. Earlier labels go first. A character takes `character` px.
std::vector<Label> placed(std::span<const Label> labels, Vec2d character, Vec2d picture);

}  // namespace plumb::window
