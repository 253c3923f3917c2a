#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/math/vec2.h"

namespace plumb::window {

/// 8 bits a channel; alpha 255 is opaque.
struct Colour {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Fill and outline of a shape. Alpha 0: none.
struct Paint {
  Colour fill{0, 0, 0, 0};
  Colour line{0, 0, 0, 0};
  double line_width = 0;  ///< px, inside the shape's edge
};

/// A picture in memory, painted in software: the same bytes on every machine. Pixel (0, 0) is at the top
/// left, its centre at (0.5, 0.5); y points down.
class Canvas {
 public:
  Canvas(int width, int height) { resize(width, height); }

  int width() const { return width_; }
  int height() const { return height_; }
  void resize(int width, int height);
  void clear(Colour colour);

  Colour at(int x, int y) const;
  /// Returns the rows from the top; each pixel is `packed`.
  std::span<const std::uint32_t> pixels() const { return pixels_; }
  std::span<std::uint32_t> pixels() { return pixels_; }

  /// Paints all points within `radius` px of the convex hull of `corners`: one corner is a disc, two a
  /// capsule or a line, more a rounded polygon, in either order. Anti-aliased: a pixel's coverage follows
  /// from the distance of its centre from the edge.
  void paint(std::span<const Vec2d> corners, double radius, const Paint& paint);

 private:
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> pixels_;
};

/// Converts a colour to a pixel, 0xaarrggbb, and back.
constexpr std::uint32_t packed(Colour c) {
  return c.b | std::uint32_t{c.g} << 8 | std::uint32_t{c.r} << 16 | std::uint32_t{c.a} << 24;
}
constexpr Colour unpacked(std::uint32_t pixel) {
  return {static_cast<std::uint8_t>(pixel >> 16), static_cast<std::uint8_t>(pixel >> 8),
          static_cast<std::uint8_t>(pixel), static_cast<std::uint8_t>(pixel >> 24)};
}

/// Blends `over` with opacity `alpha` (0..255) onto an opaque pixel.
constexpr std::uint32_t blended(std::uint32_t under, std::uint32_t over, std::uint32_t alpha) {
  // (x * alpha + 128) * 257 >> 16 is x * alpha / 255, rounded.
  const auto mix = [alpha](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t x = a * (255 - alpha) + b * alpha + 128;
    return (x * 257) >> 16;
  };
  const std::uint32_t b = mix(under & 255, over & 255);
  const std::uint32_t g = mix(under >> 8 & 255, over >> 8 & 255);
  const std::uint32_t r = mix(under >> 16 & 255, over >> 16 & 255);
  return b | g << 8 | r << 16 | 0xff000000u;
}

}  // namespace plumb::window
