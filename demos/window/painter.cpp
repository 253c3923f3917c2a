#include "demos/window/painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace plumb::window {
namespace {

constexpr double kDot = 2;          // px, radius at which smaller shapes are drawn
constexpr double kPoint = 3;        // px, radius of a point
constexpr double kGridStep = 70;    // px, minimum distance
constexpr std::size_t kFewest = 2;  // corners of a shape with an inside

Paint filled(Colour colour) { return {colour, {0, 0, 0, 0}, 0}; }

// Returns the colour of a role's lines.
Colour line_colour(const Paint& paint) { return paint.line.a > 0 ? paint.line : paint.fill; }

// Returns 1, 2 or 5 times a power of ten, at least `least`.
double round_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= least) return step * power;
  return 10 * power;
}

}  // namespace

Paint Painter::paint_of(DrawRole role) const {
  if (outline.a > 0) return {{0, 0, 0, 0}, outline, 1.6};
  return theme_.paint(role == DrawRole::Asleep && !sleep_shows ? DrawRole::Awake : role);
}

void Painter::shape(std::span<const Vec2d> corners, double radius, DrawRole role) {
  pixels_.clear();
  for (const Vec2d& corner : corners) pixels_.push_back(camera_.to_pixel(corner));
  // Shapes too small to be seen are drawn as a dot.
  const Vec2d first = pixels_.front();
  const auto near = [&](Vec2d pixel) { return length_squared(pixel - first) < kDot * kDot; };
  if (radius * camera_.scale() < kDot && std::ranges::all_of(pixels_, near)) {
    const Vec2d dot[] = {first};
    return canvas_.paint(dot, kDot, filled(line_colour(paint_of(role))));
  }
  canvas_.paint(pixels_, radius * camera_.scale(), paint_of(role));
}

void Painter::polygon(std::span<const Vec2d> corners, double radius, DrawRole role) {
  if (corners.size() > kFewest) return shape(corners, radius, role);
  if (corners.size() == kFewest) capsule(corners[0], corners[1], radius, role);
}

void Painter::circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) {
  shape(std::array{centre}, radius, role);
  // Draw a radius, to show the rotation.
  const Paint paint = paint_of(role);
  const Vec2d ends[] = {camera_.to_pixel(centre), camera_.to_pixel(centre + radius * axis)};
  if (radius * camera_.scale() > kPoint) canvas_.paint(ends, 0.5 * paint.line_width, filled(paint.line));
}

void Painter::capsule(Vec2d start, Vec2d end, double radius, DrawRole role) {
  if (radius > 0) return shape(std::array{start, end}, radius, role);
  segment(start, end, role);
}

void Painter::segment(Vec2d start, Vec2d end, DrawRole role) {
  const Paint paint = paint_of(role);
  const Vec2d ends[] = {camera_.to_pixel(start), camera_.to_pixel(end)};
  canvas_.paint(ends, 0.5 * std::max(paint.line_width, 1.0), filled(line_colour(paint)));
}

void Painter::point(Vec2d point, DrawRole role) {
  const Vec2d pixel[] = {camera_.to_pixel(point)};
  canvas_.paint(pixel, kPoint, filled(line_colour(paint_of(role))));
}

void Painter::text(Vec2d point, std::string_view text, DrawRole role) {
  labels_.push_back({camera_.to_pixel(point), std::string(text), line_colour(paint_of(role))});
}

void Painter::grid() {
  const double step = round_step(kGridStep / camera_.scale());
  const double width = canvas_.width(), height = canvas_.height();
  const Vec2d lower = camera_.to_world({0, height}), upper = camera_.to_world({width, 0});
  const Paint paint = filled(theme_.grid());
  // At the middle of a pixel, so that a line covers one row or column of pixels.
  const auto sharp = [](double pixel) { return std::floor(pixel) + 0.5; };
  for (double i = std::ceil(lower.x / step); i * step <= upper.x; ++i) {
    const double x = sharp(camera_.to_pixel({i * step, 0}).x);
    const Vec2d ends[] = {{x, 0}, {x, height}};
    canvas_.paint(ends, i == 0 ? 1 : 0.5, paint);
  }
  for (double i = std::ceil(lower.y / step); i * step <= upper.y; ++i) {
    const double y = sharp(camera_.to_pixel({0, i * step}).y);
    const Vec2d ends[] = {{0, y}, {width, y}};
    canvas_.paint(ends, i == 0 ? 1 : 0.5, paint);
  }
}

void Painter::scale_bar(double covered) {
  const double step = round_step(kGridStep / camera_.scale());
  const double width = canvas_.width() - covered, height = canvas_.height();
  char text[32];
  std::snprintf(text, sizeof text, "%g m", step);
  const Vec2d left{width - 20 - step * camera_.scale(), height - 14}, right{width - 20, height - 14};
  // Draws a plate behind the bar, so that it is readable over bodies and ground.
  Colour plate = theme_.ground();
  plate.a = kPlateAlpha;
  const Vec2d corners[] = {left + Vec2d{-8, 8}, right + Vec2d{8, 8}, right + Vec2d{8, -20},
                           left + Vec2d{-8, -20}};
  canvas_.paint(corners, 0, filled(plate));
  const Vec2d ends[] = {left, right};
  canvas_.paint(ends, 1, filled(theme_.text()));
  // Inserted first, so that no other label takes its place.
  labels_.insert(labels_.begin(), {0.5 * (left + right) + Vec2d{0, -3}, text, theme_.text()});
}

}  // namespace plumb::window
