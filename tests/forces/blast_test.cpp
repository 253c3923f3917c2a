#include "engine/forces/blast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace plumb {
namespace {

/// Impulse and angular impulse about the centre of the blast.
struct Push {
  Vec2d impulse{};
  double turn = 0;
};

Push pushed(const Blast& blast, const Convex<double>& shape) {
  Push sum;
  visit_blast(blast, shape,
              [&](Vec2d impulse, Vec2d point) { sum.impulse += impulse, sum.turn += cross(point, impulse); });
  return sum;
}

/// The integral over the outline by a fine quadrature: edges and roundings in 4,000 parts.
Push integral(const Blast& blast, const Convex<double>& shape) {
  constexpr int kParts = 4000;
  Push sum;
  const auto press = [&](Vec2d point, Vec2d normal, double length) {
    const double facing = -dot(point, normal), distance = std::sqrt(length_squared(point));
    if (facing <= 0 || distance >= blast.radius) return;
    const double strength = blast.impulse * (1 - distance / blast.radius);
    const Vec2d impulse = (strength * length * facing / (distance * distance)) * point;
    sum.impulse += impulse, sum.turn += cross(point, impulse);
  };
  visit_outline(
      shape,
      [&](Vec2d start, Vec2d end, Vec2d normal) {
        for (int i = 0; i < kParts; ++i)
          press(start + ((i + 0.5) / kParts) * (end - start), normal,
                std::sqrt(length_squared(end - start)) / kParts);
      },
      [&](const OutlineArc& arc) {
        // Half a turn has no sign.
        const double turn = std::abs(std::atan2(cross(arc.from, arc.to), dot(arc.from, arc.to)));
        for (int i = 0; i < kParts; ++i) {
          const double a = (i + 0.5) / kParts * turn;
          const Vec2d normal = std::cos(a) * arc.from + std::sin(a) * perpendicular(arc.from);
          press(arc.centre + arc.radius * normal, normal, arc.radius * turn / kParts);
        }
      });
  return sum;
}

/// Places the corners of a hull about `centre`, with its outward normals.
Convex<double> placed(const std::vector<Vec2d>& corners, double radius, double angle, Vec2d centre,
                      std::vector<Corner<double>>& memory) {
  const Vec2d right{std::cos(angle), std::sin(angle)};
  memory.clear();
  for (const Vec2d corner : corners)
    memory.push_back({centre + corner.x * right + corner.y * perpendicular(right), {}});
  for (std::size_t i = 0; memory.size() > 1 && i < memory.size(); ++i) {
    const Vec2d edge = memory[(i + 1) % memory.size()].point - memory[i].point;
    memory[i].normal = (-1 / std::sqrt(length_squared(edge))) * perpendicular(edge);
  }
  Convex<double> shape;
  shape.corners = memory.data(), shape.count = static_cast<int>(memory.size()), shape.radius = radius;
  return shape;
}

struct Form {
  const char* name;
  std::vector<Vec2d> corners;
  double radius;
};
const std::vector<Form> kForms = {
    {"disc", {{0, 0}}, 0.3},
    {"capsule", {{-0.3, 0}, {0.3, 0}}, 0.3},
    {"long capsule", {{-0.6, 0}, {0.6, 0}}, 0.1},
    {"rounded box", {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}, 0.2},
    {"rounded triangle", {{-0.2, -0.2}, {0.3, -0.1}, {0, 0.3}}, 0.15},
};

// The middles of eight pieces are within 1 % of the integral, wherever the blast is and however large.
TEST(Blast, PushesRoundShapesByTheirIntegral) {
  std::vector<Corner<double>> memory;
  for (const Form& form : kForms) {
    for (const double distance : {1.4, 2.0, 7.0}) {
      for (const double beyond : {0.1, 2.0, 100.0}) {
        for (int turn = 0; turn < 12; ++turn) {
          const Blast blast{.radius = distance + beyond, .impulse = 3};
          const Vec2d centre = distance * Vec2d{std::cos(0.4 * turn), std::sin(0.4 * turn)};
          const Convex<double> shape = placed(form.corners, form.radius, 0.55 * turn, centre, memory);
          const Push got = pushed(blast, shape), exact = integral(blast, shape);
          const double size = std::sqrt(length_squared(exact.impulse));
          const std::string at = std::string(form.name) + ", " + std::to_string(distance) + " m, beyond " +
                                 std::to_string(beyond) + " m, turn " + std::to_string(turn);
          ASSERT_GT(size, 0) << at;
          EXPECT_LT(std::sqrt(length_squared(got.impulse - exact.impulse)), 0.01 * size) << at;
          // Impulses along rays from the centre have no moment about it.
          EXPECT_NEAR(got.turn, 0, 1e-12 * size) << at;
        }
      }
    }
  }
}

TEST(Blast, NearADiscItIsWithinOnePercentFromATenthOfItsRadiusOn) {
  std::vector<Corner<double>> memory;
  for (const double gap : {0.1, 0.2, 0.5, 1.0}) {
    const Convex<double> disc = placed({{0, 0}}, 1, 0, {1 + gap, 0}, memory);
    const Blast blast{.radius = 9, .impulse = 1};
    const Vec2d exact = integral(blast, disc).impulse;
    EXPECT_NEAR(pushed(blast, disc).impulse.x, exact.x, 0.01 * exact.x) << gap;
  }
}

TEST(Blast, DiscsOfManyCornersArePushedLikeDiscs) {
  std::vector<Corner<double>> memory;
  std::vector<Vec2d> corners;
  for (int i = 0; i < 256; ++i)
    corners.push_back(
        0.3 * Vec2d{std::cos(2 * std::numbers::pi * i / 256), std::sin(2 * std::numbers::pi * i / 256)});
  const Blast blast{.radius = 4, .impulse = 1};
  const double disc = pushed(blast, placed({{0, 0}}, 0.3, 0, {2, 0}, memory)).impulse.x;
  const double polygon = pushed(blast, placed(corners, 0, 0.001, {2, 0}, memory)).impulse.x;
  // Of the disc's width of 0.6 m; the whole at its nearest point would be 0.575.
  EXPECT_NEAR(disc / 0.6, 0.492, 0.002);
  EXPECT_NEAR(disc, polygon, 2e-3 * polygon);
}

TEST(Blast, PushesNothingFromWithin) {
  std::vector<Corner<double>> memory;
  const Blast blast{.radius = 4, .impulse = 1};
  for (const Form& form : kForms)
    EXPECT_EQ(pushed(blast, placed(form.corners, form.radius, 0.3, {0.05, 0.02}, memory)).impulse, Vec2d{})
        << form.name;
}

}  // namespace
}  // namespace plumb
