#pragma once

#include <string>

#include "demos/window/canvas.h"

namespace plumb::window {

/// Writes the canvas as a PNG file: with a palette where 256 colours do, as true colour otherwise. The same
/// canvas gives the same bytes. Throws Error (Io).
void write_png(const Canvas& canvas, const std::string& file);

/// The same picture in no more than `most` (up to 256) colours: those that cover most of it, the others as
/// the nearest of them. For small files.
Canvas with_few_colours(const Canvas& canvas, std::size_t most);

}  // namespace plumb::window
