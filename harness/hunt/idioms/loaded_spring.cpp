#include <algorithm>
#include <cmath>

#include "engine/scene/geometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds an arm on a hinge with a damped spring, which its weight, or that of a load at its end, deflects. It
// rests where the spring's torque I w^2 (angle - target) balances that of the weights; I is the arm's own
// inertia about the hinge.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, g = random.within(2, 20), thick = random.within(0.05, 0.3) * s;
  draft.site.kind = Site::Kind::Air;
  draft.out.scene.gravity = {0, -g};
  draft.out.sleeping = false;  // it may approach its rest position at less than the sleep threshold
  const int arm = draft.box({0.5 * s, 0}, s, thick);
  RevoluteJoint& hinge = draft.revolute(-1, arm, {0, 0});
  const bool loaded = random.chance(0.5);
  int load = arm;
  double moment = draft.body(arm).mass * 0.5 * s;  // kg m, moment of the weights at the angle 0
  std::vector<std::string> needs{draft.name(arm), hinge.name, std::string(kMasses)};
  const double own = inertia_of(draft.body(arm)) + draft.body(arm).mass * 0.25 * s * s;
  // Chooses the stiffness so that the deflection is about the drawn one.
  const double bend = random.within(0.05, 0.4);
  const double heavy = loaded ? random.pick({0.2, 1.0, 5.0}) : 0;
  moment += heavy * draft.body(arm).mass * s;
  const double hertz = std::sqrt(moment * g / (own * bend)) / 6.283185307179586;
  hinge.spring = Spring{hertz, random.pick({0.7, 1.0, 2.0})};
  if (loaded) {
    load = draft.disc({s, 0}, 0.2 * s);
    draft.body(load).mass = heavy * draft.body(arm).mass;
    WeldJoint& weld = draft.weld(arm, load, {s, 0});
    needs.push_back(weld.name), needs.push_back(draft.name(load));
  }
  // Solves stiffness * angle = -moment g cos(angle).
  const double stiffness = own * 39.47841760435743 * hertz * hertz;
  double angle = 0;
  for (int i = 0; i < 50; ++i) {
    const Vec2d to = direction(angle);
    angle -= (stiffness * angle + moment * g * to.x) / (stiffness - moment * g * to.y);
  }
  // A load lengthens the period: uses that of arm and load together.
  const double rate =
      6.283185307179586 * hertz / std::sqrt(1 + heavy * draft.body(arm).mass * s * s * 1.1 / own);
  const double time = std::min(12.0, 40 / rate);
  const int steps = draft.out.steps = std::max(20, static_cast<int>(time / draft.out.dt));
  Expectation& rests = draft.expect("rests_where_its_load_says", arm, Quantity::Angle);
  const double slack = 0.02 * std::abs(angle) + 1e-3;
  rests.lower = angle - slack, rests.upper = angle + slack;
  rests.from = rests.to = steps * draft.out.dt;
  rests.why = "a spring deflects until its torque balances the weights";
  rests.needs = needs;
}

const Register r{{.name = "loaded_spring",
                  .title = "an arm on a damped spring, deflected by a weight",
                  .weight = 0.4,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
