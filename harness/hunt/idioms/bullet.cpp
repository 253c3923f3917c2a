#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Shoots a small fast disc at the structure.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, speed = random.ladder(5, 300) * s;
  const double before = draft.restitution;
  draft.restitution = 0;
  const double height = random.within(0.3, 1.5) * s, radius = random.ladder(0.02, 0.2) * s;
  const int made = draft.disc({-4 * s, height}, radius);
  draft.body(made).velocity = {speed, 0};
  draft.restitution = before;
  std::erase_if(draft.out.expectations, [](const Expectation& each) { return each.name != "stays_inside"; });
}

const Register r{{.name = "bullet",
                  .title = "a small fast disc is shot at the structure",
                  .role = Idiom::Role::Disturbance,
                  .weight = 0.7,
                  .fits = [](const Draft& draft) { return draft.site.kind == Site::Kind::Floor; },
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
