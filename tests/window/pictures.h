#pragma once

#include <string>

#include "demos/window/canvas.h"

namespace plumb::window {

/// The picture in a PNG file, read by libpng's own simplified reader. Fails the test where there is none.
Canvas read_png(const std::string& file);

/// The pixels that a colour test accepts: how many, and the mean of their centres.
struct Blob {
  long count = 0;
  Vec2d centre{};  ///< px
};
template <class Test>
Blob blob_of(const Canvas& canvas, Test&& accepts) {
  Blob blob;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      if (!accepts(canvas.at(x, y))) continue;
      ++blob.count;
      blob.centre += Vec2d{x + 0.5, y + 0.5};
    }
  }
  if (blob.count > 0) blob.centre = blob.centre * (1.0 / static_cast<double>(blob.count));
  return blob;
}

}  // namespace plumb::window
