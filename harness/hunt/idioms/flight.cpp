#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds one to three bodies in free flight that spin and may collide in pairs.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  const int count = random.whole(1, 3);
  const bool inside = draft.site.kind == Site::Kind::Enclosure;
  const double height = inside ? draft.site.height / 2 : 0, apart = inside ? draft.site.width / 4 : 3 * s;
  for (int i = 0; i < count; ++i) {
    const double about = random.ladder(0.3, 2) * s, angle = random.within(-3, 3);
    const int made =
        draft.any({(i - (inside ? 1 : 0)) * apart, height + random.within(-0.5, 0.5) * s}, about, angle);
    draft.body(made).velocity = {(i == 0 ? 1 : -0.5 * i) * random.ladder(0.5, 20) * s, 0};
    draft.body(made).angular_velocity = random.within(-20, 20);
    if (random.chance(0.2)) draft.body(made).linear_damping = random.ladder(0.1, 10);
    if (random.chance(0.1)) draft.body(made).fixed_rotation = true, draft.body(made).angular_velocity = 0;
    if (random.chance(0.2)) {
      draft.body(made).shapes.push_back(
          {.geometry = draft.any_geometry(0.5 * s), .position = {0.4 * about, 0.2 * about}});
      draft.weigh(made);
    }
  }
}

const Register r{{.name = "flight",
                  .title = "bodies that collide in flight",
                  .weight = 1,
                  .floor = false,
                  .enclosure = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
