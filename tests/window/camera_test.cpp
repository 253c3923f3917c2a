#include "demos/window/camera.h"

#include <gtest/gtest.h>

namespace plumb::window {
namespace {

Camera camera() {
  Camera camera;
  camera.resize(1000, 600);
  camera.fit({{-2, 1}, {8, 5}}, 200);
  return camera;
}

TEST(Camera, FitsTheViewBesideThePanel) {
  // 10 m by 4 m on 800 px by 600 px, less a margin of 16 px at three sides and 36 px below.
  EXPECT_DOUBLE_EQ(camera().scale(), 76.8);
  const Vec2d middle = camera().to_pixel({3, 3});
  EXPECT_DOUBLE_EQ(middle.x, 600);
  EXPECT_DOUBLE_EQ(middle.y, 290);
  EXPECT_DOUBLE_EQ(camera().to_pixel({-2, 1}).x, 216);
  EXPECT_DOUBLE_EQ(camera().to_pixel({-2, 1}).y, 290 + 2 * 76.8);
}

TEST(Camera, PixelsAndPointsGoForthAndBack) {
  const Vec2d point = camera().to_world(camera().to_pixel({1.25, -7.5}));
  EXPECT_NEAR(point.x, 1.25, 1e-14);
  EXPECT_NEAR(point.y, -7.5, 1e-14);
}

TEST(Camera, ZoomKeepsWhatIsUnderThePointer) {
  Camera zoomed = camera();
  const Vec2d held = zoomed.to_world({730, 110});
  zoomed.zoom({730, 110}, 3);
  EXPECT_DOUBLE_EQ(zoomed.scale(), 3 * camera().scale());
  EXPECT_NEAR(zoomed.to_world({730, 110}).x, held.x, 1e-13);
  EXPECT_NEAR(zoomed.to_world({730, 110}).y, held.y, 1e-13);
  for (int i = 0; i < 100; ++i) zoomed.zoom({0, 0}, 10);
  EXPECT_EQ(zoomed.scale(), Camera::kLargest);
}

TEST(Camera, PanMovesThePicture) {
  Camera moved = camera();
  moved.pan({50, -20});
  EXPECT_NEAR(moved.to_pixel({3, 3}).x, 650, 1e-10);
  EXPECT_NEAR(moved.to_pixel({3, 3}).y, 270, 1e-10);
}

}  // namespace
}  // namespace plumb::window
