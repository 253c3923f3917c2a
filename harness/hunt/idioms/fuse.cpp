#include <algorithm>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

template <class Joint>
void bear(Joint& joint, double force, double torque) {
  joint.break_force = force, joint.break_torque = torque;
}

// Builds a load on a joint that breaks somewhat above or below the load's weight or torque.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  draft.site.kind = Site::Kind::Air;
  if (draft.out.scene.gravity == Vec2d{0, 0}) draft.out.scene.gravity = {0, -9.81};
  const double g = -draft.out.scene.gravity.y, length = random.within(0.5, 2) * s;
  const bool holds = random.chance(0.4);
  const double share = holds ? random.pick({1.05, 1.2, 2.0}) : random.pick({0.99, 0.98, 0.96, 0.9});
  const bool beam = random.chance(0.4);
  const int made =
      beam ? draft.box({length / 2, 0}, length, 0.2 * s) : draft.box({0, -length / 2}, 0.3 * s, length);
  const double weight = draft.body(made).mass * g;
  if (beam) {
    bear(draft.weld(-1, made, {0, 0}), 0, share * weight * length / 2);
  } else if (const int kind = random.whole(0, 2); kind == 0) {
    bear(draft.revolute(-1, made, {0, 0}), share * weight, 0);
  } else if (kind == 1) {
    bear(draft.weld(-1, made, {0, 0}), share * weight, 0);
  } else {
    bear(draft.rod(-1, made, {0, s}, {0, 0}), share * weight, 0);
  }
  const int steps = draft.out.steps = std::max(20, static_cast<int>(0.6 / draft.out.dt));
  const double y = draft.body(made).position.y, time = steps * draft.out.dt;
  Expectation& expected = draft.expect(holds ? "holds" : "lets_go", made, Quantity::Y);
  if (holds) {
    expected.lower = y - 0.1 * length, expected.upper = y + 0.1 * length;
    expected.why = "a joint bears loads below its limit";
  } else {
    expected.upper = y - 0.25 * g * time * time;  // half of the free fall, because breaking may take a while
    expected.from = expected.to = time;
    expected.why = "a joint breaks under a load above its limit";
  }
  expected.needs = {std::visit([](const auto& j) { return j.name; }, draft.out.scene.joints.back()),
                    std::string(kMasses)};
}

const Register r{{.name = "fuse",
                  .title = "a load on a joint that breaks",
                  .weight = 0.5,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
