#include "engine/math/arc_tangent.h"
#include "scenarios/truth/parts.h"

// A block slides down a movable wedge, all surfaces smooth: the wedge accelerates at A = m g sin cos/(M + m
// sin^2), and the block slides on it at (M + m) g sin/(M + m sin^2). Source: e.g. Landau and Lifshitz;
// Kleppner and Kolenkow, 2.20.
namespace plumb::scenarios::wedge {
namespace {
using namespace truth;

constexpr double kWedge = 2, kBlock = 1;  // kg

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("wedge"), .duration = 0.6};
  const Real tilt = std::atan(Real(0.5));
  const Vec2<Real> down = direction(-tilt);
  // From its centroid: 3 m wide, 1.5 m high, its right angle to the left.
  const Shape triangle = solid(Polygon{{{-1, -0.5}, {2, -0.5}, {-1, 1}}});
  const Vec2d along = 1 / std::sqrt(5.0) * Vec2d{2, -1};  // down the wedge
  const Vec2d place = Vec2d{-1, 1.5} + 0.5 * along + 0.1 * perpendicular(along);
  problem.scene.bodies = {ground(), piece("wedge", {0, 0.5}, triangle, kWedge),
                          piece("block", place, solid(Box{0.4, 0.2}), kBlock)};
  problem.scene.bodies[2].angle = -arc_tangent(1, 2);
  const Real s = -down.y, c = down.x, share = kWedge + kBlock * s * s;
  const Vec2<Real> away{-kBlock * kGravity * s * c / share, 0};
  const Vec2<Real> slide = (kWedge + kBlock) * kGravity * s / share * down;
  problem.truth =
      follow_in_contact(problem.scene, "A = m g sin cos/(M + m sin^2) (Newton)", [=](Real t, Moving moving) {
        moving[0] = coast(moving[0], t, {away});
        moving[1] = coast(moving[1], t, {away + slide});
      });
  problem.conserved = {.energy = true, .momentum_x = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "wedge", .summary = "a block slides down a free wedge", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::wedge
