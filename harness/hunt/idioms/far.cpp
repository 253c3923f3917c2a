#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Moves everything far from the origin.
void build(Draft& draft) {
  const double side = draft.random.pick({-1.0, 1.0});
  const Vec2d by{side * draft.random.ladder(100, 1e5), draft.random.within(-100, 100)};
  for (Body& body : draft.out.scene.bodies) body.position += by;
  for (Joint& joint : draft.out.scene.joints)
    std::visit(
        [&](auto& j) {
          if constexpr (requires { j.anchor_a; })
            if (j.body_a == kWorld) j.anchor_a += by;
          if constexpr (requires { j.anchor_b; })
            if (j.body_b == kWorld) j.anchor_b += by;
          if constexpr (requires { j.ground_a; }) j.ground_a += by, j.ground_b += by;
          if constexpr (requires { j.target; }) j.target += by;
        },
        joint);
  for (Expectation& expected : draft.out.expectations) {
    if (expected.quantity == Quantity::X) expected.lower += by.x, expected.upper += by.x;
    if (expected.quantity == Quantity::Y) expected.lower += by.y, expected.upper += by.y;
  }
  for (Action& action : draft.out.actions)
    if (action.kind == ActionKind::Teleport) action.position += by;
}

const Register r{{.name = "far",
                  .title = "everything lies far from the origin",
                  .role = Idiom::Role::Disturbance,
                  .weight = 0.7,
                  .fits = [](const Draft& draft) { return draft.out.scene.forces.empty(); },
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
