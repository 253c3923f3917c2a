#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a crank that drives a mechanism: gears, a piston, a pulley, a ratchet, another crank.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  const int first = draft.count();
  const Vec2d middle{0, draft.site.kind == Site::Kind::Air ? 0 : 6 * s};
  const int kind = random.whole(0, 4);
  const double torque = draft.density * s * s * s * s * random.ladder(1, 100);
  if (kind == 0) {  // a slider crank
    const double crank = random.within(0.3, 0.7) * s, rod = random.within(0.8, 3) * s;
    const int a = draft.box(middle + Vec2d{crank / 2, 0}, crank, 0.1 * s);
    const int b = draft.box(middle + Vec2d{crank + rod / 2, 0}, rod, 0.1 * s);
    const int c = draft.box(middle + Vec2d{crank + rod, 0}, 0.4 * s, 0.4 * s);
    RevoluteJoint& drive = draft.revolute(-1, a, middle);
    if (random.chance(0.6)) drive.motor = Motor{random.within(-10, 10), torque};
    draft.revolute(a, b, middle + Vec2d{crank, 0});
    draft.revolute(b, c, middle + Vec2d{crank + rod, 0});
    draft.prismatic(-1, c, middle + Vec2d{crank + rod, 0}, {1, 0});
  } else if (kind == 1) {  // meshing wheels
    const int wheels = random.whole(2, 4);
    double x = 0, before = 0;
    for (int i = 0; i < wheels; ++i) {
      const double radius = random.within(0.3, 1) * s;
      x += i > 0 ? before + radius : 0;
      const int made = draft.disc(middle + Vec2d{x, 0}, radius);
      draft.revolute(-1, made, middle + Vec2d{x, 0});
      if (i > 0) draft.join<GearJoint>(made - 1, made).ratio = -before / radius;
      before = radius;
    }
    draft.body(first).angular_velocity = random.within(-10, 10);
    for (int i = first + 1; i < draft.count(); ++i) {
      const auto radius = [&](int k) {
        return std::get<Circle>(draft.body(k).shapes.front().geometry).radius;
      };
      draft.body(i).angular_velocity = -draft.body(i - 1).angular_velocity * radius(i - 1) / radius(i);
    }
  } else if (kind == 2) {  // two loads on a rope
    const int a = draft.box(middle + Vec2d{-s, -2 * s}, 0.5 * s, 0.5 * s);
    const int b = draft.box(middle + Vec2d{s, -random.within(1, 3) * s}, 0.5 * s, 0.5 * s);
    auto& rope = draft.join<PulleyJoint>(a, b);
    rope.ground_a = middle + Vec2d{-s, 0}, rope.ground_b = middle + Vec2d{s, 0};
    rope.ratio = random.pick({1.0, 1.0, 2.0, 0.5});
  } else if (kind == 3) {  // two cranks coupled by a rod; equal ones pass through a line
    const double crank = random.within(0.3, 0.8) * s, apart = random.within(1.5, 3) * s;
    const double angle = random.within(-3, 3), rate = random.within(-8, 8);
    const Vec2d along = direction(angle), next = middle + Vec2d{apart, 0};
    const int a = draft.box(middle + 0.5 * crank * along, crank, 0.1 * s, angle);
    const int b = draft.box(next + 0.5 * crank * along, crank, 0.1 * s, angle);
    const int rod = draft.box(middle + crank * along + Vec2d{apart / 2, 0}, apart, 0.1 * s);
    draft.revolute(-1, a, middle);
    draft.revolute(-1, b, next);
    draft.revolute(a, rod, middle + crank * along);
    draft.revolute(b, rod, next + crank * along);
    for (const int each : {a, b})
      draft.body(each).angular_velocity = rate, draft.body(each).velocity = cross(rate, 0.5 * crank * along);
    draft.body(rod).velocity = cross(rate, crank * along);
  } else {  // a wheel that turns one way only
    const int wheel = draft.disc(middle, 0.5 * s);
    draft.revolute(-1, wheel, middle);
    draft.join<RatchetJoint>(-1, wheel).tooth = random.pick({0.1, -0.1, 0.5});
    draft.body(wheel).angular_velocity = random.within(-5, 5);
  }
  draft.pass_each_other(first);
}

const Register r{{.name = "machine",
                  .title = "cranks, linkages, gears, pulleys and ratchets",
                  .weight = 1,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
