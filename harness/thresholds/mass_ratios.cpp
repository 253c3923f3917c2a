#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "engine/math/trigonometry.h"
#include "harness/joint_gap.h"
#include "harness/thresholds/catalogue.h"
#include "harness/thresholds/parts.h"

// Heavy bodies carried by light ones. Rigid bodies carry any mass, so any limit is the engine's own.
namespace plumb::harness::thresholds {
namespace {

constexpr double kDuration = 10;  // s
// Displacement, m, and rotation, rad, that count as a failure. They exceed the margin of a centimetre that
// some engines keep around shapes.
constexpr double kMoved = 0.05;
constexpr int kLinks = 10;
constexpr double kStretch = 0.01;  // largest stretch, as a fraction of the chain's length

Trial stack(double ratio, double) {
  Trial trial{.scene = {.name = "heavy_on_light", .gravity = {0, -kGravity}}, .duration = kDuration};
  Body heavy = block("heavy", 1, 1, {0, 1.5}, 0.5);
  heavy.mass = ratio;
  trial.scene.bodies = {held(block("ground", 20, 2, {0, -1}, 0.5)), block("light", 1, 1, {0, 0.5}, 0.5),
                        heavy};
  trial.broke = [](double time, std::span<const BodyState> states) {
    const double sunk = 1.5 - states[2].position.y, aside = std::abs(states[2].position.x);
    if (std::abs(sunk) > kMoved)
      return fmt::format("{} by {:.2g} m in {:.2g} s", sunk > 0 ? "sinks" : "rises", std::abs(sunk), time);
    if (aside > kMoved || std::abs(states[2].angle) > kMoved)
      return fmt::format("moved by {:.2g} m or rotated within {:.2g} s", aside, time);
    return std::string();
  };
  return trial;
}

Trial chain(double ratio, double) {
  constexpr double kAngle = std::numbers::pi / 6;  // tilt of the chain from the vertical
  const Vec2d along = rotation_of(-std::numbers::pi / 2 + kAngle) * Vec2d{1, 0};
  Trial trial{.scene = {.name = "heavy_tip", .gravity = {0, -kGravity}}, .duration = kDuration};
  Scene& scene = trial.scene;
  std::string before{kWorld};
  for (int i = 0; i <= kLinks; ++i) {
    const bool tip = i == kLinks;
    const std::string name = tip ? "tip" : fmt::format("link {}", i + 1);
    Shape shape{.geometry = Box{1, 0.1}, .filter = {.mask = 0}};
    if (tip) shape.geometry = Circle{0.5};
    scene.bodies.push_back({.name = name,
                            .position = (tip ? kLinks : i + 0.5) * along,
                            .angle = tip ? 0 : -std::numbers::pi / 2 + kAngle,
                            .mass = tip ? ratio : 1,
                            .shapes = {shape}});
    scene.joints.push_back(RevoluteJoint{.name = fmt::format("hinge {}", i + 1),
                                         .body_a = before,
                                         .body_b = name,
                                         .anchor_a = {i == 0 ? 0 : 0.5, 0},
                                         .anchor_b = {tip ? 0 : -0.5, 0}});
    before = name;
  }
  trial.broke = [gaps = std::make_shared<JointGaps>(scene)](double time, std::span<const BodyState> states) {
    double sum = 0;
    for (std::size_t i = 0; i < gaps->size(); ++i) sum += gaps->gap(i, states);
    return sum > kStretch * kLinks ? fmt::format("stretches by {:.2g} m after {:.2g} s", sum, time)
                                   : std::string();
  };
  return trial;
}

}  // namespace

Threshold heavy_on_light() {
  return {.name = "heavy_on_light",
          .title = "the heaviest box on a light one",
          .quantity = "largest mass ratio of a box on a box of the same size",
          .source = "no limit: rigid boxes carry any mass",
          .judged = "the upper box of 1 m moves by more than 5 cm or rotates by 0.05 rad in 10 s",
          .range = {.low = 1, .high = 1e9, .logarithmic = true},
          .exact = no_exact_value,
          .build = stack};
}

Threshold heavy_tip() {
  return {.name = "heavy_tip",
          .title = "the heaviest tip on a chain",
          .quantity = "largest mass ratio of the tip of a chain of ten links to a link",
          .source = "no limit: rigid links carry any mass",
          .judged =
              "the sum of the joint gaps exceeds 1 % of the chain's length while it swings from 30 degrees "
              "for 10 s",
          .range = {.low = 1, .high = 1e9, .logarithmic = true},
          .exact = no_exact_value,
          .build = chain};
}

}  // namespace plumb::harness::thresholds
