#include <cmath>

#include "extremes/parts/hanging.h"
#include "extremes/parts/swing.h"

namespace plumb::extremes {
namespace {

constexpr double kBeam = 1.0 / 3;  // kg m^2: 1 kg, 2 m, without thickness

Joint hinge(std::string name, std::string_view to, std::string body, Vec2d at) {
  return RevoluteJoint{
      .name = std::move(name), .body_a = std::string(to), .body_b = std::move(body), .anchor_a = at};
}

Trial build(double ratio) {
  Trial trial{.scene = {.name = "mass_ratio_lever"}, .stretches = evenly(120, 120)};
  const Shape disc = untouchable(Circle{0.2});
  trial.scene.bodies = {{.name = "beam", .mass = 1, .inertia = kBeam, .shapes = {untouchable(Box{2, 0.1})}},
                        {.name = "heavy", .position = {-1, 0}, .mass = ratio, .shapes = {disc}},
                        {.name = "light", .position = {1, 0}, .mass = 1, .shapes = {disc}}};
  trial.scene.joints = {hinge("fulcrum", kWorld, "beam", {}), hinge("left", "beam", "heavy", {-1, 0}),
                        hinge("right", "beam", "light", {1, 0})};
  // The discs are hinged at their centres, so they act on the beam as point masses: I a'' = (M - m) g cos(a),
  // a from level.
  const double k = (ratio - 1) * kGravity / (kBeam + ratio + 1);
  if (ratio == 1) trial.exact = at_rest(trial.scene);
  if (ratio > 1)
    trial.exact = [swing = Swing(k, std::numbers::pi / 2)](double t, std::span<BodyState> out) {
      const double angle = std::numbers::pi / 2 - swing.angle(t), rate = -swing.rate(t);
      const Vec2d arm{std::cos(angle), std::sin(angle)}, way = rate * perpendicular(arm);
      out[0] = {.position = {}, .angle = angle, .angular_velocity = rate};
      out[1] = {.position = -arm, .velocity = -way};
      out[2] = {.position = arm, .velocity = way};
    };
  const double energy = (ratio + 1) * kGravity;
  trial.judge = [energy](const Scene& scene) { return closed_and_lossless(scene, 2, energy); };
  return trial;
}

const Register r{{.name = "mass_ratio_lever",
                  .title = "a beam of 2 m and 1 kg on a fulcrum, a heavy load at one end and 1 kg at the "
                           "other, released for 2 s",
                  .axis = "mass ratio",
                  .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9},
                  .rule = "sum of the joint gaps at most 1 % of the beam's length, energy error at most 5 % "
                          "of m g times half the beam's length",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
