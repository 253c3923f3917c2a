#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "harness/thresholds/arch.h"
#include "harness/thresholds/catalogue.h"
#include "harness/thresholds/parts.h"

// A semicircular arch under its own weight. Source: Heyman, The safety of masonry arches, Int. J. Mech. Sci.
// 11 (1969); Cocchetti, Colasante, Rizzi, On the analysis of minimum thickness in circular masonry arches,
// Appl. Mech. Rev. 64 (2011).
namespace plumb::harness::thresholds {
namespace {

constexpr double kFriction = 1;
constexpr double kDrop = 0.02 * kArchRadius;  // m

Body voussoir_body(int index, double thickness) {
  const auto corners = voussoir(index, thickness);
  Polygon shape{.points = {corners.begin(), corners.end()}};
  const Extent extent = extent_of(shape);
  for (Vec2d& point : shape.points) point = point - extent.centroid;
  return {.name = fmt::format("voussoir {}", index + 1),
          .position = extent.centroid,
          .mass = extent.area,
          .shapes = {{.geometry = shape, .friction = kFriction}}};
}

Trial arch(double share, double resolution) {
  Trial trial{.scene = {.name = "arch_thickness", .gravity = {0, -kGravity}}};
  trial.scene.bodies = {held(block("ground", 4 * kArchRadius, 2, {0, -1}, kFriction))};
  for (int i = 0; i < kVoussoirs; ++i) trial.scene.bodies.push_back(voussoir_body(i, share * kArchRadius));
  // If the arch is too thin by a small fraction, its hinges open from rest like tilting blocks. The arm is
  // the arch's radius, and the offset of the centre of mass from the hinge is that fraction of the thickness.
  const double beyond = resolution / 2 * kThinnestArch * kArchRadius;
  trial.duration = 2 * time_to_tilt(beyond, kArchRadius, kArchRadius * kArchRadius, kDrop / kArchRadius);
  trial.broke = [bodies = trial.scene.bodies](double time, std::span<const BodyState> states) {
    for (std::size_t i = 1; i < states.size(); ++i)
      if (length_squared(states[i].position - bodies[i].position) > kDrop * kDrop)
        return fmt::format("{} moved by {:.2g} m in {:.2g} s", bodies[i].name, kDrop, time);
    return std::string();
  };
  return trial;
}

}  // namespace

std::array<Vec2d, 4> voussoir(int index, double thickness) {
  const double inner = kArchRadius - thickness / 2, outer = kArchRadius + thickness / 2;
  // Symmetric in every bit, and level on the ground.
  const auto ray = [](int joint) {
    const double angle = joint * std::numbers::pi / kVoussoirs;
    if (joint == 0 || joint == kVoussoirs) return Vec2d{joint == 0 ? 1.0 : -1.0, 0};
    return Vec2d{std::cos(angle), std::sin(angle)};
  };
  const Vec2d first = ray(index), second = ray(index + 1);
  return {inner * first, outer * first, outer * second, inner * second};
}

Threshold arch_thickness() {
  return {.name = "arch_thickness",
          .title = "the thinnest stable semicircular arch",
          .quantity = fmt::format(
              "thickness / radius of the thinnest stable semicircular arch of {} voussoirs", kVoussoirs),
          .source = "limit analysis of these voussoirs; 0.1075 for infinitely many (Milankovitch, Heyman)",
          .judged =
              "a voussoir moves by more than 2 % of the radius, within twice the time that a rigid arch "
              "needs if it is too thin by half a unit of the last digit",
          .range = {.low = 0.05, .high = 0.25, .holds_below = false},
          .exact = exactly(kThinnestArch),
          .build = arch};
}

}  // namespace plumb::harness::thresholds
