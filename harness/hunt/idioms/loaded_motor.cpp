#include <algorithm>
#include <cmath>

#include "engine/scene/geometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a bar on a hinge, or a slide, whose motor runs at its speed from the start, and a load that acts
// with or against it. Below the motor's strength the speed is kept; above it the excess load accelerates the
// body.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  draft.site.kind = Site::Kind::Air;
  draft.out.scene.gravity = {0, 0};
  const bool slides = random.chance(0.4);
  const double speed = random.pick({0.0, 1.0, -2.0}) * (slides ? s : 1);
  const int made = draft.box({0, 0}, s, 0.2 * s);
  Body& body = draft.body(made);
  body.inertia = inertia_of(body);
  const double inert = slides ? body.mass : *body.inertia;
  // Strong enough to change the speed within the run.
  const double most = inert * random.ladder(2, 50) * (slides ? s : 1);
  const double load = most * random.pick({-1.5, -0.9, -0.5, 0.5, 0.9, 1.5});
  if (slides) {
    draft.prismatic(-1, made, {0, 0}, {1, 0}).motor = Motor{speed, most};
    body.velocity = {speed, 0}, body.angular_velocity = 0;
    draft.out.scene.forces.push_back(PointForce{.body = body.name, .force = {load, 0}});
  } else {
    draft.revolute(-1, made, {0, 0}).motor = Motor{speed, most};
    body.velocity = {}, body.angular_velocity = speed;
    draft.out.scene.forces.push_back(Torque{.body = body.name, .torque = load});
  }
  const double rate = std::abs(load) > most ? (load - std::copysign(most, load)) / inert : 0;
  const double time = random.within(0.2, 0.6);
  const int steps = draft.out.steps = std::max(4, static_cast<int>(time / draft.out.dt));
  const double right = speed + rate * steps * draft.out.dt;
  Expectation& holds =
      draft.expect("holds_its_speed", made, slides ? Quantity::VelocityX : Quantity::AngularVelocity);
  // If the motor is barely strong enough, the speed changes by as much as the load adds in a step.
  const double slack = 0.02 * std::abs(right) + 1.1 * std::abs(load) / inert * draft.out.dt;
  holds.lower = right - slack, holds.upper = right + slack;
  holds.from = holds.to = steps * draft.out.dt;
  holds.why =
      "a motor keeps its speed under loads below its largest torque, in both directions; above it, the "
      "excess accelerates the load";
  holds.needs = {draft.name(made),
                 std::visit([](const auto& j) { return j.name; }, draft.out.scene.joints.back()),
                 std::string(kMasses)};
}

const Register r{{.name = "loaded_motor",
                  .title = "a motor at its speed under a load",
                  .weight = 0.4,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
