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

/// Returns the labels that do not overlap in a picture of `picture` px. In their order, each is placed above
/// its point, else below it, else left out; it is moved sideways if the picture's edge would cut it. A
/// character takes `character` px.
std::vector<Label> placed(std::span<const Label> labels, Vec2d character, Vec2d picture);

}  // namespace plumb::window
