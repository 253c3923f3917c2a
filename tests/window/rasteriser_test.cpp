#include "demos/window/rasteriser.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <random>

namespace plumb::window {
namespace {

// Returns the pixels that `draw` puts into an otherwise empty frame.
template <class Draw>
Canvas drawn(Draw&& draw) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {80, 60};
  unsigned char* alpha = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsAlpha8(&alpha, &width, &height);
  ImGui::NewFrame();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.Flags = ImDrawListFlags_None;
  draw(list);
  ImGui::Render();
  Canvas canvas(80, 60);
  canvas.clear({0, 0, 0});
  rasterise(*ImGui::GetDrawData(), *io.Fonts, canvas);
  ImGui::DestroyContext();
  return canvas;
}

// A translucent rectangle, cut into triangles that meet in edges at all angles: no pixel is painted twice,
// and none is left out.
TEST(Rasteriser, TrianglesThatMeetPaintEachPixelOnce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> x(12, 68), y(12, 48);
  for (int round = 0; round < 50; ++round) {
    const ImVec2 middle(x(random), y(random));
    const Canvas canvas = drawn([&](ImDrawList& list) {
      ImVec2 rim[12];
      for (int i = 0; i < 3; ++i) {
        rim[i] = {10 + 20.0f * static_cast<float>(i), 10};
        rim[3 + i] = {70, 10 + 40.0f / 3 * static_cast<float>(i)};
        rim[6 + i] = {70 - 20.0f * static_cast<float>(i), 50};
        rim[9 + i] = {10, 50 - 40.0f / 3 * static_cast<float>(i)};
      }
      for (int i = 0; i < 12; ++i) list.AddTriangleFilled(middle, rim[i], rim[(i + 1) % 12], 0x80ffffff);
    });
    for (int py = 0; py < 60; ++py)
      for (int px = 0; px < 80; ++px)
        ASSERT_EQ(canvas.at(px, py).r, px >= 10 && px < 70 && py >= 10 && py < 50 ? 128 : 0)
            << px << " " << py << " " << middle.x << " " << middle.y;
  }
}

TEST(Rasteriser, ColoursAreMixedBetweenCorners) {
  const Canvas canvas = drawn([](ImDrawList& list) {
    list.AddRectFilledMultiColor({10, 10}, {70, 50}, 0xff000000, 0xff0000ff, 0xff0000ff, 0xff000000);
  });
  for (int x = 10; x < 70; ++x) EXPECT_NEAR(canvas.at(x, 30).r, 255 * (x + 0.5 - 10) / 60, 1) << x;
}

// A colon's glyph is a column 1 px wide, far from the texture's origin: its dots have the whole colour.
TEST(Rasteriser, NarrowGlyphsHaveTheirWholeColour) {
  for (const char* text : {":", "'", "|", "."}) {
    const Canvas canvas = drawn([&](ImDrawList& list) { list.AddText({40, 20}, 0xffffffff, text); });
    int whole = 0, partly = 0;
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 80; ++x) {
        const int value = canvas.at(x, y).r;
        if (value == 255) {
          ++whole;
        } else if (value > 0) {
          ++partly;
        }
      }
    }
    EXPECT_GT(whole, 0) << text;
    EXPECT_EQ(partly, 0) << text;
  }
}

TEST(Rasteriser, NothingIsPaintedOutsideTheClip) {
  const Canvas canvas = drawn([](ImDrawList& list) {
    list.PushClipRect({20, 20}, {30, 30});
    list.AddRectFilled({-100, -100}, {200, 200}, 0xffffffff);
  });
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x)
      ASSERT_EQ(canvas.at(x, y).r, x >= 20 && x < 30 && y >= 20 && y < 30 ? 255 : 0);
}

}  // namespace
}  // namespace plumb::window
