#include "demos/window/canvas.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace plumb::window {
namespace {

constexpr Paint kWhite{{255, 255, 255}, {}, 0};

// Returns how much of the canvas, cleared to black, is white, px^2.
double covered(const Canvas& canvas) {
  double sum = 0;
  for (const std::uint32_t pixel : canvas.pixels()) sum += unpacked(pixel).r / 255.0;
  return sum;
}

Canvas black(int size = 100) {
  Canvas canvas(size, size);
  canvas.clear({0, 0, 0});
  return canvas;
}

// A pixel is covered by 1/2 - d, d the distance of its centre from the edge, from 0 to 1: on average over all
// places of the grid that is the mean of the areas within d of the shape's edge, d from -1/2 to 1/2. For a
// disc of r > 1/2 that is pi (r^2 + 1/12).
TEST(Canvas, CoversTheAreaOfADisc) {
  for (const double radius : {0.8, 3.0, 12.5, 40.0}) {
    Canvas canvas = black();
    canvas.paint(std::array{Vec2d{50.3, 49.6}}, radius, kWhite);
    EXPECT_NEAR(covered(canvas), std::numbers::pi * (radius * radius + 1.0 / 12),
                0.1 + 1e-4 * radius * radius)
        << radius;
  }
}

TEST(Canvas, CoversTheAreaOfARoundedPolygonInEitherOrder) {
  const std::vector<Vec2d> corners = {{20.2, 30.1}, {70.7, 25.4}, {60.3, 71.9}};
  double area = 0, around = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2d a = corners[i], b = corners[(i + 1) % 3];
    area += cross(a, b) / 2;
    around += std::hypot(b.x - a.x, b.y - a.y);
  }
  for (const double radius : {0.0, 5.0}) {
    Canvas one = black(), other = black();
    one.paint(corners, radius, kWhite);
    other.paint(std::vector<Vec2d>(corners.rbegin(), corners.rend()), radius, kWhite);
    // Steiner's formula.
    const double exact = area + radius * around + std::numbers::pi * radius * radius;
    EXPECT_NEAR(covered(one), exact, 1) << radius;
    EXPECT_NEAR(covered(other), covered(one), 0.02) << radius;
  }
}

TEST(Canvas, CoversTheAreaOfALine) {
  Canvas canvas = black();
  canvas.paint(std::array{Vec2d{10, 20}, Vec2d{70, 65}}, 1.5, kWhite);
  EXPECT_NEAR(covered(canvas), 75 * 3 + std::numbers::pi * 1.5 * 1.5, 1);
}

TEST(Canvas, EdgesLieInsideTheShape) {
  Canvas canvas = black();
  canvas.paint(std::array{Vec2d{20, 20}, Vec2d{80, 20}, Vec2d{80, 80}, Vec2d{20, 80}}, 0,
               {{255, 0, 0}, {0, 255, 0}, 3});
  EXPECT_EQ(canvas.at(19, 50), (Colour{0, 0, 0}));
  EXPECT_EQ(canvas.at(20, 50), (Colour{0, 255, 0}));
  EXPECT_EQ(canvas.at(22, 50), (Colour{0, 255, 0}));
  EXPECT_EQ(canvas.at(23, 50), (Colour{255, 0, 0}));
  EXPECT_EQ(canvas.at(50, 79), (Colour{0, 255, 0}));
  EXPECT_EQ(canvas.at(50, 80), (Colour{0, 0, 0}));
  // The inner edge of a line of 2.5 px goes through the middle of a pixel.
  canvas.clear({0, 0, 0});
  canvas.paint(std::array{Vec2d{20, 20}, Vec2d{80, 20}, Vec2d{80, 80}, Vec2d{20, 80}}, 0,
               {{255, 0, 0}, {0, 255, 0}, 2.5});
  EXPECT_EQ(canvas.at(22, 50), (Colour{128, 128, 0}));
}

TEST(Canvas, WhatIsTranslucentMixes) {
  Canvas canvas(10, 10);
  canvas.clear({0, 100, 200});
  canvas.paint(std::array{Vec2d{5, 5}}, 20, {{255, 0, 0, 51}, {}, 0});
  EXPECT_EQ(canvas.at(5, 5), (Colour{51, 80, 160}));
}

TEST(Canvas, WhatIsOutsideIsCutOff) {
  Canvas canvas = black(20);
  canvas.paint(std::array{Vec2d{-5, 10.5}}, 8, kWhite);
  canvas.paint(std::array{Vec2d{1e6, 1e6}}, 8, kWhite);
  canvas.paint(std::array{Vec2d{-1e7, -1e7}, Vec2d{1e7, -1e7}, Vec2d{1e7, 1}, Vec2d{-1e7, 1}}, 0, kWhite);
  canvas.paint(std::array{Vec2d{NAN, 3}}, 8, kWhite);
  EXPECT_EQ(canvas.at(2, 10), (Colour{255, 255, 255}));
  EXPECT_EQ(canvas.at(5, 10), (Colour{0, 0, 0}));
  EXPECT_EQ(canvas.at(19, 0), (Colour{255, 255, 255}));
  EXPECT_EQ(canvas.at(19, 1), (Colour{0, 0, 0}));
}

}  // namespace
}  // namespace plumb::window
