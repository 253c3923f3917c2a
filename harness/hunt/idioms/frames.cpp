#include "engine/math/trigonometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Gives each body another frame: rotated by any angle, or by whole turns. The scene in the world is the same.
void build(Draft& draft) {
  Random& random = draft.random;
  std::vector<double> turns;
  const bool whole = random.chance(0.5);
  for (int i = 0; i < draft.count(); ++i) {
    const double turn = whole ? 6.283185307179586 * random.whole(-20, 20) : random.within(-10, 10);
    turns.push_back(draft.body(i).type == BodyType::Dynamic ? turn : 0);
    Body& body = draft.body(i);
    body.angle += turns.back();
    const Rotation<double> back = rotation_of(turns.back()).inverse();
    for (Shape& shape : body.shapes) {
      shape.position = back * shape.position;
      shape.angle -= turns.back();
    }
  }
  const auto turn_of = [&](const std::string& name) {
    const auto at = find_body(draft.out.scene, name);
    return at ? turns[*at] : 0;
  };
  for (Joint& joint : draft.out.scene.joints) {
    std::visit(
        [&](auto& j) {
          const double a = turn_of(j.body_a), b = turn_of(j.body_b);
          if constexpr (requires { j.anchor_a; }) j.anchor_a = rotation_of(a).inverse() * j.anchor_a;
          if constexpr (requires { j.anchor_b; }) j.anchor_b = rotation_of(b).inverse() * j.anchor_b;
          if constexpr (requires { j.axis; }) j.axis = rotation_of(a).inverse() * j.axis;
          if constexpr (requires { j.reference_angle; }) j.reference_angle += b - a;
          if constexpr (requires { j.target_position; }) {
            j.target_position = rotation_of(a).inverse() * j.target_position;
            j.target_angle += b - a;
          }
          if constexpr (requires {
                          j.ratio;
                          j.phase;
                        })
            j.phase += b - j.ratio * a;
          if constexpr (requires { j.tooth; }) j.phase += b - a;
        },
        joint);
  }
  for (Expectation& expected : draft.out.expectations)
    if (expected.quantity == Quantity::Angle)
      expected.lower += turn_of(expected.body), expected.upper += turn_of(expected.body);
}

const Register r{{.name = "frames",
                  .title = "bodies whose frames are rotated, also by many revolutions",
                  .role = Idiom::Role::Disturbance,
                  .weight = 1.5,
                  .fits = [](const Draft& draft) { return draft.out.scene.forces.empty(); },
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
