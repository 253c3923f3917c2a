#include "demos/window/labels.h"

#include <algorithm>
#include <cmath>

namespace plumb::window {

std::vector<Label> placed(std::span<const Label> labels, Vec2d character, Vec2d picture) {
  struct Taken {
    double left, right, top;  // px
  };
  // Areas that are taken, in rows as high as a character: a text reaches into two rows.
  std::vector<std::vector<Taken>> taken(static_cast<std::size_t>(std::max(picture.y, 0.0) / character.y) + 1);
  const auto line_of = [&](double y) { return static_cast<std::size_t>(y / character.y); };
  std::vector<Label> out;
  for (const Label& label : labels) {
    const double width = character.x * static_cast<double>(label.text.size());
    // A point outside the picture gets no label. The comparison also excludes NaN.
    const bool seen =
        label.pixel.x >= 0 && label.pixel.x <= picture.x && label.pixel.y >= 0 && label.pixel.y <= picture.y;
    if (!seen) continue;
    const double left = std::max(std::min(label.pixel.x - width / 2, picture.x - width), 0.0);
    const double right = left + width;
    for (const double bottom : {label.pixel.y, label.pixel.y + character.y}) {
      const double top = bottom - character.y;
      if (top < 0 || bottom > picture.y) continue;
      const std::size_t first = line_of(top), last = line_of(bottom);
      bool free = true;
      for (std::size_t line = first; line <= last; ++line)
        for (const Taken& other : taken[line])
          free =
              free && !(left < other.right && right > other.left && std::fabs(top - other.top) < character.y);
      if (!free) continue;
      for (std::size_t line = first; line <= last; ++line) taken[line].push_back({left, right, top});
      out.push_back(label);
      out.back().pixel = {left + width / 2, bottom};
      break;
    }
  }
  return out;
}

}  // namespace plumb::window
