// A kinematic drum of 36 quadrilaterals between radius 16 and 18 m and 4 blades down to 14 m. It turns at 25
// degrees a second and moves by (1, -2) mm/s. It contains 90 x 90 squares of 0.2 m at a pitch of 0.21 m. 8102
// bodies, one of which is static and empty. Without continuous collision, because that would take more than
// half of Box2D 2.4's time.
#include <cmath>
#include <numbers>

#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

constexpr int kSegments = 36;
constexpr double kPitchAngle = 2 * std::numbers::pi / kSegments;

/// Returns the quadrilateral between two radii and two angles, counter-clockwise.
Polygon sector(double inner, double outer, double from, double to) {
  const Vec2d a{std::cos(from), std::sin(from)}, b{std::cos(to), std::sin(to)};
  return {{inner * a, outer * a, outer * b, inner * b}, 0};
}

std::vector<ShapeDefinition> drum() {
  std::vector<ShapeDefinition> out;
  const double seam = 0.1 * kPitchAngle;  // overlap with a neighbour on either side
  for (int i = 0; i < kSegments; ++i) {
    const double from = i * kPitchAngle, to = from + kPitchAngle;
    out.push_back({.geometry = sector(16, 18, from - seam, to + seam)});
    if (i % 9 == 0) out.push_back({.geometry = sector(14, 16, from, to)});
  }
  return out;
}

Built build(Builder& world, bool quick) {
  const Vec2d centre{0, 10};
  world.create_body({.type = BodyType::Static}, std::vector<ShapeDefinition>{});
  world.create_body({.type = BodyType::Kinematic,
                     .position = centre,
                     .velocity = {0.001, -0.002},
                     .spin = 25 * std::numbers::pi / 180},
                    drum());
  const int n = quick ? 20 : 90;
  const double half = 0.1, pitch = 2.1 * half, start = -1.1 * half * n;
  const ShapeDefinition square{.geometry = box(half, half)};
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column)
      world.create_body({.position = {start + pitch * column, centre.y + start + pitch * row}}, square);
  const Vec2d reach{18, 18};
  return {.region = Region{centre - reach, centre + reach}};
}

}  // namespace

Scene washer() {
  return {.name = "washer",
          .summary = "8100 small squares in a round drum with blades, moved as given",
          .steps = 500,
          .quick_steps = 60,
          .continuous = false,
          .build = build};
}

}  // namespace plumb::field
