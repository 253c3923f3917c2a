#include "tests/window/pictures.h"

#include <gtest/gtest.h>
#include <png.h>

namespace plumb::window {

Canvas read_png(const std::string& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) {
    ADD_FAILURE() << file << ": " << image.message;
    return {1, 1};
  }
  image.format = PNG_FORMAT_BGRA;
  Canvas canvas(static_cast<int>(image.width), static_cast<int>(image.height));
  if (png_image_finish_read(&image, nullptr, canvas.pixels().data(), 0, nullptr) == 0)
    ADD_FAILURE() << file << ": " << image.message;
  return canvas;
}

}  // namespace plumb::window
