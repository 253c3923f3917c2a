#include <algorithm>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a bar on a hinge with a spring, or a load on a spring: it oscillates at the given frequency.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, hertz = random.ladder(0.1, 4), away = random.within(0.1, 0.5);
  draft.site.kind = Site::Kind::Air;
  draft.out.scene.gravity = {0, 0};
  const bool slides = random.chance(0.5);
  const bool end = random.chance(0.5);
  const int made = draft.box({end ? 0.5 * s : 0, 0}, s, 0.2 * s);
  draft.body(made).velocity = {}, draft.body(made).angular_velocity = 0;
  const Spring spring{hertz, 0};
  if (slides) {
    PrismaticJoint& joint = draft.prismatic(-1, made, draft.body(made).position, {1, 0});
    joint.spring = spring;
    joint.target_translation = away * s;
  } else {
    RevoluteJoint& joint = draft.revolute(-1, made, {0, 0});
    joint.spring = spring;
    joint.target_angle = away;
  }
  // After half a period it is at twice the displacement. An implicit method damps the amplitude by the
  // fraction w h / 2 per radian of phase.
  const double half = 0.5 / hertz;
  draft.out.steps = static_cast<int>(1.2 * half / draft.out.dt) + 2;
  Expectation& swings = draft.expect("swings_at_its_frequency", made, slides ? Quantity::X : Quantity::Angle);
  const double target = slides ? draft.body(made).position.x + 2 * away * s : 2 * away,
               scale = slides ? away * s : away;
  const double damped = std::min(0.8, 3.15 * 3.15 * hertz * draft.out.dt / draft.out.substeps);
  swings.lower = target - (0.1 + damped) * scale, swings.upper = target + 0.1 * scale;
  swings.from = half - 0.51 * draft.out.dt, swings.to = half + 0.51 * draft.out.dt;
  swings.why = "an undamped spring of f Hz takes the body to twice its target after half a period, 1/(2 f)";
  swings.needs = {draft.name(made),
                  std::visit([](const auto& j) { return j.name; }, draft.out.scene.joints.back())};
}

const Register r{{.name = "spring_swing",
                  .title = "a body on a spring of a stated frequency",
                  .weight = 0.5,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
