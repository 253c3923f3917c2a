// Stacks of four 1 m squares, 2 m apart, on static grounds of ten stacks, one storey above the other. With
// --sleeping they are asleep when the measurement starts.
#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

constexpr int kHigh = 4;

constexpr int kPiece = 10;  // stacks per piece of ground

// Builds `columns` stacks on each of `storeys` grounds. `columns` is a multiple of kPiece.
Built build(Builder& world, int storeys, int columns) {
  constexpr double kPitch = 2, kStorey = 8;  // m
  const ShapeDefinition square{.geometry = box(0.5, 0.5)},
      ground{.geometry = box(0.5 * kPitch * kPiece, 0.5)};
  Built out;
  for (int storey = 0; storey < storeys; ++storey) {
    const double y = kStorey * storey;
    for (int column = 0; column < columns; ++column) {
      const double x = kPitch * column;
      if (column % kPiece == 0)
        world.create_body({.type = BodyType::Static, .position = {x + 0.5 * kPitch * (kPiece - 1), y - 0.5}},
                          ground);
      int top = 0;
      for (int i = 0; i < kHigh; ++i) top = world.create_body({.position = {x, y + 0.5 + i}}, square);
      if (column == columns / 2) out.tops.push_back({top, y});
    }
  }
  return out;
}

}  // namespace

Scene stacks_10000() {
  return {.name = "stacks_10000",
          .summary = "2500 stacks of four squares",
          .steps = 100,
          .quick_steps = 30,
          .warm_up = 60,
          .on_request = true,
          .build = [](Builder& world, bool quick) { return build(world, quick ? 3 : 50, quick ? 10 : 50); }};
}

Scene stacks_1000000() {
  return {
      .name = "stacks_1000000",
      .summary = "250000 stacks of four squares",
      .steps = 20,
      .quick_steps = 10,
      .warm_up = 60,
      .on_request = true,
      .build = [](Builder& world, bool quick) { return build(world, quick ? 4 : 500, quick ? 10 : 500); }};
}

}  // namespace plumb::field
