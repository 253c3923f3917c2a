#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a chassis on wheels with springs, motors or plain hinges.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, wheel = random.within(0.2, 0.5) * s, length = random.within(1.5, 3) * s;
  const int first = draft.count(), wheels = random.whole(2, 4);
  const double height = draft.site.kind == Site::Kind::Air ? 0 : wheel;
  const int chassis = draft.box({0, height + 0.5 * s}, length, 0.4 * s);
  const bool springs = random.chance(0.7), motors = random.chance(0.6);
  const Spring spring{random.ladder(1, 30), random.pick({0.2, 0.7, 1.0})};
  const double speed = random.within(-20, 20),
               torque = draft.body(chassis).mass * 10 * s * random.ladder(0.1, 10);
  for (int i = 0; i < wheels; ++i) {
    const Vec2d at{length * (static_cast<double>(i) / (wheels - 1) - 0.5), height};
    const int made = draft.disc(at, wheel);
    if (springs) {
      WheelJoint& joint = draft.wheel(chassis, made, at, {0, 1});
      joint.spring = spring;
      if (motors) joint.motor = Motor{speed, torque};
      if (random.chance(0.5)) joint.limits = Range{-0.2 * s, 0.2 * s};
    } else {
      RevoluteJoint& joint = draft.revolute(chassis, made, at);
      if (motors) joint.motor = Motor{speed, torque};
    }
  }
  draft.pass_each_other(first);
}

const Register r{{.name = "vehicle", .title = "a chassis on wheels", .weight = 1, .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
