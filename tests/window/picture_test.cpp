#include "demos/window/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "engine/scene/error.h"
#include "tests/app/program.h"
#include "tests/window/pictures.h"

namespace plumb::window {
namespace {

Canvas gradient() {
  Canvas canvas(40, 30);
  for (std::size_t i = 0; i < canvas.pixels().size(); ++i)
    canvas.pixels()[i] = packed({static_cast<std::uint8_t>(i % 256), static_cast<std::uint8_t>(i / 7), 9});
  return canvas;
}

TEST(Picture, IsReadBackAsItWas) {
  const app::Folder folder;
  Canvas plain(33, 21);
  plain.clear({1, 2, 3});
  plain.paint(std::array{Vec2d{10, 10}}, 5, {{200, 100, 50}, {}, 0});
  for (const Canvas& canvas : {gradient(), plain}) {
    const std::string file = folder.path("a.png");
    write_png(canvas, file);
    const Canvas read = read_png(file);
    ASSERT_EQ(read.width(), canvas.width());
    ASSERT_EQ(read.height(), canvas.height());
    EXPECT_TRUE(std::ranges::equal(read.pixels(), canvas.pixels()));
  }
}

TEST(Picture, FewColoursAreThoseThatCoverMost) {
  Canvas canvas(10, 10);
  canvas.clear({10, 10, 10});
  for (int i = 0; i < 20; ++i) canvas.pixels()[i] = packed({200, 0, 0});
  canvas.pixels()[50] = packed({190, 5, 0});
  canvas.pixels()[51] = packed({20, 10, 10});
  const Canvas few = with_few_colours(canvas, 2);
  const std::set<std::uint32_t> colours(few.pixels().begin(), few.pixels().end());
  EXPECT_EQ(colours, (std::set{packed({10, 10, 10}), packed({200, 0, 0})}));
  EXPECT_EQ(few.pixels()[50], packed({200, 0, 0}));
  EXPECT_EQ(few.pixels()[51], packed({10, 10, 10}));
}

TEST(Picture, SaysWhereItCannotBeWritten) {
  try {
    write_png(gradient(), "/nowhere/a.png");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Io);
    EXPECT_NE(std::string(error.what()).find("/nowhere/a.png"), std::string::npos);
  }
}

}  // namespace
}  // namespace plumb::window
