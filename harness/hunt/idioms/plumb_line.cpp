#include <algorithm>
#include <cmath>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a chain with a load at its end that hangs straight down and stays so, or is rotated by a few degrees
// as a whole and swings with about the period of its load.
void build(Draft& draft) {
  Random& random = draft.random;
  Case& out = draft.out;
  const double s = draft.size, dense = draft.density;
  draft.site.kind = Site::Kind::Air;
  if (out.scene.gravity == Vec2d{0, 0}) out.scene.gravity = {0, -9.81};
  const double g = -out.scene.gravity.y, length = random.pick({0.3, 0.5, 1.0}) * s;
  const int links = random.whole(1, 24), first = draft.count();
  const double ratio = random.ladder(1, 1000);  // mass of the load over that of a link
  const bool discs = random.chance(0.3), rods = random.chance(0.3);
  double y = 0;
  int before = -1;
  for (int i = 0; i < links; ++i) {
    const int made = discs ? draft.disc({0, y - length / 2}, 0.2 * length)
                           : draft.box({0, y - length / 2}, 0.1 * length, length);
    if (rods && i > 0) {
      draft.rod(before, made, {0, y + length / 2}, {0, y - length / 2});
    } else {
      draft.revolute(before, made, {0, y});
    }
    before = made, y -= length;
  }
  const double side = random.within(0.3, 2) * length;
  draft.density = ratio * draft.body(before).mass / (side * side);
  const int load = draft.box({0, y - side / 2}, side, side);
  draft.revolute(before, load, {0, y});
  draft.density = dense;
  draft.pass_each_other(first);
  const double depth = -draft.body(load).position.y;
  out.steps = std::max(30, static_cast<int>(random.within(1, 3) / out.dt));
  Expectation& stays = draft.expect("hangs_at_its_length", load, Quantity::Y);
  // An error of 1 % can be seen. Joints begin without impulses, so a chain may bounce at the start.
  stays.lower = -depth * 1.01 - g * out.dt * out.dt, stays.upper = -depth * 0.99;
  stays.from = 0.5;
  stays.why = "a hanging chain keeps its length under its load";
  stays.needs.emplace_back(kMasses);
  for (const Joint& joint : out.scene.joints)
    std::visit([&](const auto& j) { stays.needs.push_back(j.name); }, joint);
  for (int i = first; i < draft.count(); ++i) stays.needs.push_back(draft.name(i));
}

const Register r{{.name = "plumb_line",
                  .title = "a chain that hangs straight, with a load at its end",
                  .weight = 0.5,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
