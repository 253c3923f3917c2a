#include <algorithm>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds a bar that turns about its middle, or its end, until it hits a post.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, half = random.within(0.5, 3) * s, at = random.within(0.2, 0.97) * half;
  // Thin enough not to touch at the start: a post blocks at most 0.3 rad of the bar's rotation.
  const double thick = std::min(random.ladder(0.02, 0.2) * s, 0.2 * at);
  const double post = std::min(random.ladder(0.02, 0.2) * s, 0.2 * at);
  const double rate = random.ladder(1, 30), from = -random.within(0.5, 1.2);
  const Vec2d middle{0, draft.site.kind == Site::Kind::Air ? 0 : 1.2 * half};
  if (draft.site.kind != Site::Kind::Air) draft.site.kind = Site::Kind::Air;
  const bool whole = random.chance(0.6), capsule = random.chance(0.3);
  const Vec2d along = direction(from);
  const Vec2d centre = whole ? middle : middle + (half / 2) * along;
  const double length = whole ? 2 * half : half;
  const int bar = capsule ? draft.add(Capsule{{-length / 2, 0}, {length / 2, 0}, thick / 2}, centre, from)
                          : draft.box(centre, length, thick, from);
  draft.revolute(-1, bar, middle);
  draft.body(bar).angular_velocity = rate;
  draft.body(bar).velocity = cross(rate, centre - middle);
  draft.body(bar).gravity_scale = 0;
  draft.restitution = 0;
  const int stop = draft.disc(middle + Vec2d{at, 0}, post, BodyType::Static);
  for (Shape& shape : draft.body(bar).shapes) shape.restitution = 0;
  // Ends before the other half of the bar would reach the post.
  draft.out.steps = std::max(5, static_cast<int>(1.5 / rate / draft.out.dt));
  Expectation& blocked = draft.expect("is_stopped", bar, Quantity::Angle);
  blocked.upper = 0.3;
  blocked.why = "a bar does not rotate through a post";
  blocked.needs = {draft.name(bar), draft.name(stop),
                   std::visit([](const auto& j) { return j.name; }, draft.out.scene.joints.back())};
}

const Register r{{.name = "turnstile",
                  .title = "a bar that rotates until a post stops it",
                  .weight = 1.2,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
