#pragma once

#include <string>

#include "demos/window/canvas.h"

namespace plumb::window {

/// Writes the canvas as a PNG file: with a palette if it has at most 256 colours, else in true colour. The
/// same canvas gives the same bytes. Throws Error (Io).
void write_png(const Canvas& canvas, const std::string& file);

/// Returns the picture in at most `most` (up to 256) colours: the most frequent ones; others are replaced by
/// the nearest of them. Such files are small.
Canvas with_few_colours(const Canvas& canvas, std::size_t most);

}  // namespace plumb::window
