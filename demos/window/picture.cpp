#include "demos/window/picture.h"

#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "engine/scene/error.h"

namespace plumb::window {
namespace {

constexpr std::size_t kPalette = 256;

// Counts the pixels of each colour.
std::map<std::uint32_t, long> histogram(const Canvas& canvas) {
  std::map<std::uint32_t, long> counts;
  for (const std::uint32_t pixel : canvas.pixels()) ++counts[pixel];
  return counts;
}

// Rows for libpng, with the palette if they are indexed.
struct Encoded {
  std::vector<png_byte> bytes;
  std::vector<png_color> palette;
  std::size_t row_size = 0;
};

Encoded encode(const Canvas& canvas) {
  Encoded out;
  const std::map<std::uint32_t, long> counts = histogram(canvas);
  const bool few = counts.size() <= kPalette;
  std::map<std::uint32_t, png_byte> places;
  if (few) {
    for (const auto& [pixel, count] : counts) {
      const Colour colour = unpacked(pixel);
      places[pixel] = static_cast<png_byte>(out.palette.size());
      out.palette.push_back({colour.r, colour.g, colour.b});
    }
  }
  for (const std::uint32_t pixel : canvas.pixels()) {
    const Colour colour = unpacked(pixel);
    if (few) {
      out.bytes.push_back(places[pixel]);
    } else {
      for (const png_byte channel : {colour.r, colour.g, colour.b}) out.bytes.push_back(channel);
    }
  }
  out.row_size = static_cast<std::size_t>(canvas.width()) * (few ? 1 : 3);
  return out;
}

[[noreturn]] void fail(const std::string& file, const std::string& why) {
  throw Error(Error::Kind::Io, "file '" + file + "'", "", "", "cannot be written: " + why);
}

[[noreturn]] void on_png_error(png_structp png, png_const_charp text) {
  fail(*static_cast<const std::string*>(png_get_error_ptr(png)), text);
}
void on_png_warning(png_structp, png_const_charp) {}

long distance(std::uint32_t a, std::uint32_t b) {
  const Colour p = unpacked(a), q = unpacked(b);
  const auto square = [](long d) { return d * d; };
  return square(p.r - q.r) + square(p.g - q.g) + square(p.b - q.b);
}

}  // namespace

void write_png(const Canvas& canvas, const std::string& file) {
  Encoded rows = encode(canvas);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "wb"), std::fclose);
  if (out == nullptr) fail(file, std::strerror(errno));
  std::string name = file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &name, on_png_error, on_png_warning);
  if (png == nullptr) fail(file, "there is not enough memory");
  png_infop info = png_create_info_struct(png);
  struct Guard {
    png_structp* png;
    png_infop* info;
    ~Guard() { png_destroy_write_struct(png, info); }
  } const guard{&png, &info};
  png_init_io(png, out.get());
  png_set_compression_level(png, 9);
  const bool few = !rows.palette.empty();
  png_set_IHDR(png, info, static_cast<png_uint_32>(canvas.width()), static_cast<png_uint_32>(canvas.height()),
               8, few ? PNG_COLOR_TYPE_PALETTE : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (few) png_set_PLTE(png, info, rows.palette.data(), static_cast<int>(rows.palette.size()));
  png_write_info(png, info);
  for (int y = 0; y < canvas.height(); ++y)
    png_write_row(png, rows.bytes.data() + static_cast<std::size_t>(y) * rows.row_size);
  png_write_end(png, info);
  if (std::fflush(out.get()) != 0) fail(file, std::strerror(errno));
}

Canvas with_few_colours(const Canvas& canvas, std::size_t most) {
  std::vector<std::pair<long, std::uint32_t>> colours;
  for (const auto& [pixel, count] : histogram(canvas)) colours.emplace_back(-count, pixel);
  std::ranges::sort(colours);
  const std::size_t kept = std::min({colours.size(), most, kPalette});
  std::map<std::uint32_t, std::uint32_t> nearest;
  for (const auto& [count, pixel] : colours) {
    const auto found = std::min_element(
        colours.begin(), colours.begin() + static_cast<long>(kept),
        [&](const auto& a, const auto& b) { return distance(a.second, pixel) < distance(b.second, pixel); });
    nearest[pixel] = found->second;
  }
  Canvas out = canvas;
  for (std::uint32_t& pixel : out.pixels()) pixel = nearest[pixel];
  return out;
}

}  // namespace plumb::window
