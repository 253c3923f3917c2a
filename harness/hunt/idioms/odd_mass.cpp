#include <algorithm>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Makes one body heavier or lighter than its size suggests, or gives it another inertia.
void build(Draft& draft) {
  Random& random = draft.random;
  const int first = random.whole(0, draft.count() - 1);
  for (int i = 0; i < draft.count(); ++i) {
    Body& body = draft.body((first + i) % draft.count());
    if (body.type != BodyType::Dynamic) continue;
    body.mass *= random.ladder(1e-3, 1e3);
    const double inertia = inertia_of(body);
    if (random.chance(0.4) && inertia > 0) body.inertia = inertia * random.ladder(0.05, 20);
    break;
  }
  std::erase_if(draft.out.expectations, [](const Expectation& each) {
    return std::find(each.needs.begin(), each.needs.end(), kMasses) != each.needs.end();
  });
}

const Register r{{.name = "odd_mass",
                  .title = "one body has another mass and inertia",
                  .role = Idiom::Role::Disturbance,
                  .weight = 0.7,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
