#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

constexpr double kTurn = 6.283185307179586;

// Builds arms around a hub, each held by a joint of the same kind: a propeller, a spider, a cart wheel.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, hub = random.within(0.1, 0.5) * s, arm = random.within(0.5, 2) * s;
  const int arms = random.whole(2, 7), first = draft.count();
  const bool floor = draft.site.kind == Site::Kind::Floor;
  const double inside = draft.site.kind == Site::Kind::Enclosure ? draft.site.height / 2 : 0;
  const Vec2d middle{0, floor ? (arm + hub) * random.within(1.1, 1.5) : inside};
  const double from = floor && random.chance(0.5) ? -2.6 : random.within(0, 1);
  const double spread = floor && random.chance(0.5) ? 2.1 : kTurn * (arms - 1) / arms;
  const int kind = random.whole(0, 6);
  const Spring spring{random.ladder(0.5, 200), random.pick({0.0, 0.2, 0.7, 1.0})};
  const double torque = draft.density * s * s * s * 50 * random.ladder(0.1, 1000);
  draft.disc(middle, hub);
  for (int i = 0; i < arms; ++i) {
    const double angle = from + spread * i / (arms > 1 ? arms - 1 : 1);
    const Vec2d along = direction(angle);
    const int made =
        draft.box(middle + (hub + arm / 2) * along, arm, random.pick({0.05, 0.1, 0.3}) * arm, angle);
    const Vec2d root = middle + hub * along;
    if (kind <= 1) {
      draft.weld(first, made, root);
    } else if (kind == 2) {
      WeldJoint& joint = draft.weld(first, made, root);
      joint.angular_spring = spring;
      if (random.chance(0.5)) joint.linear_spring = spring;
    } else if (kind == 3) {
      draft.revolute(first, made, root).motor = Motor{0, torque};
    } else if (kind == 4) {
      draft.revolute(first, made, root).limits = Range{-random.within(0, 0.5), random.within(0, 0.5)};
    } else if (kind == 5) {
      draft.revolute(first, made, root).spring = spring;
    } else {
      draft.prismatic(first, made, root, along).limits = Range{-0.1 * arm, 0.1 * arm};
    }
  }
  draft.pass_each_other(first);
  if (!floor || random.chance(0.3)) draft.whirl(first, middle, random.within(-10, 10));
}

const Register r{
    {.name = "star", .title = "arms around a hub", .weight = 2, .enclosure = true, .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
