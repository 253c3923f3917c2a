#include <algorithm>
#include <cmath>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds smooth discs without gravity that fly into each other, between pins and walls. Some crowds are so
// dense that a disc is struck several times in a step; some discs are at rest; some are moved or pushed
// during the run. The exact motion is computed from the discs' collisions.
void build(Draft& draft) {
  Random& random = draft.random;
  Case& out = draft.out;
  const double s = draft.size;
  draft.site.kind = Site::Kind::Air;
  out.scene.gravity = {0, 0};
  draft.friction = 0;
  draft.restitution = random.pick({1.0, 1.0, 0.8, 0.5});
  const int across = random.whole(1, 4), along = random.whole(1, 4), first = draft.count();
  const double cell = s * random.within(0.5, 1.5), gap = random.ladder(0.002, 0.4) * cell;
  // Speeds at which a disc moves by a small or a large part of its size in a step.
  const double speed = random.ladder(0.01, 1) * cell / out.dt;
  const bool alike = random.chance(0.5), rest = random.chance(0.4);
  for (int i = 0; i < across; ++i)
    for (int k = 0; k < along; ++k) {
      const double radius = (cell - gap) / 2 * (alike ? 1 : random.within(0.4, 1));
      const Vec2d at{k * cell + random.within(-0.5, 0.5) * gap, i * cell + random.within(-0.5, 0.5) * gap};
      const bool pin = random.chance(0.1) && i + k > 0;
      const int made = draft.disc(at, radius, pin ? BodyType::Static : BodyType::Dynamic);
      if (!pin && !rest)
        draft.body(made).velocity = random.within(0, 0.3) * speed * direction(random.within(0, 6));
      if (random.chance(0.2)) draft.body(made).shapes.front().restitution = random.pick({0.3, 1.0});
    }
  const int struck = draft.count();
  const double away = cell * random.within(1, 3);
  const int balls = random.pick({1, 1, 2});
  for (int i = 0; i < balls; ++i) {
    const double from = i == 0 ? -away : along * cell + away;
    const int made =
        draft.disc({from, random.within(0, across) * cell - cell / 2}, cell * random.within(0.2, 0.5));
    draft.body(made).velocity = {i == 0 ? speed : -speed, random.within(-0.2, 0.2) * speed};
    if (random.chance(0.3)) draft.body(made).mass *= random.pick({0.1, 10.0});
  }
  if (random.chance(0.5)) {
    const double far = along * cell + 4 * cell;
    draft.box({far, 0}, cell, 20 * cell, random.within(-0.3, 0.3), BodyType::Static);
    draft.box({-5 * cell, 0}, cell, 20 * cell, random.within(-0.3, 0.3), BodyType::Static);
  }
  out.steps = std::min(240, static_cast<int>((away + 6 * along * cell) / (speed * out.dt)) + 10);
  out.sleeping = random.chance(0.3);
  if (random.chance(0.25)) {
    // Pushes a disc at rest or in flight, or moves it to a nearby position.
    const int step = random.whole(1, std::max(1, out.steps / 2));
    out.actions.push_back({.kind = ActionKind::Push,
                           .step = step,
                           .target = draft.name(random.whole(struck, draft.count() - 1)),
                           .position = random.within(0.3, 1) * speed * direction(random.within(0, 6))});
    std::erase_if(out.actions, [&](const Action& action) {
      for (int i = first; i < draft.count(); ++i)
        if (draft.name(i) == action.target) return draft.body(i).type != BodyType::Dynamic;
      return true;
    });
  }
}

const Register r{{.name = "crowd",
                  .title = "smooth discs that collide in flight",
                  .weight = 1.5,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
