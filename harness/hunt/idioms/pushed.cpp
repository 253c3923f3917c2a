#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Pushes and spins one body.
void build(Draft& draft) {
  Random& random = draft.random;
  const int first = random.whole(0, draft.count() - 1);
  for (int i = 0; i < draft.count(); ++i) {
    Body& body = draft.body((first + i) % draft.count());
    if (body.type != BodyType::Dynamic) continue;
    body.velocity += Vec2d{random.within(-5, 5) * draft.size, random.within(-2, 2) * draft.size};
    if (!body.fixed_rotation) body.angular_velocity += random.within(-10, 10);
    break;
  }
  std::erase_if(draft.out.expectations, [](const Expectation& each) { return each.name != "stays_inside"; });
}

const Register r{{.name = "pushed",
                  .title = "one body gets a velocity and an angular velocity",
                  .role = Idiom::Role::Disturbance,
                  .weight = 0.7,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
