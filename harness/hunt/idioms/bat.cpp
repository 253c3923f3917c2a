#include <algorithm>
#include <cmath>

#include "engine/scene/geometry.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Returns the centroid of a body's first `count` shapes, in its frame.
Vec2d middle_of(const Body& body, std::size_t count) {
  double area = 0;
  Vec2d moment{};
  for (std::size_t i = 0; i < count; ++i) {
    const Extent extent = extent_of(body.shapes[i].geometry);
    area += extent.area, moment += extent.area * body.shapes[i].position;
  }
  return (1 / area) * moment;
}

// Builds a kinematic body with shapes beside its axis of rotation: a bat, a windmill's sail, a driven door.
// It may become dynamic later, and lose a shape; the rest must keep its motion.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, dt = draft.out.dt;
  draft.site.kind = Site::Kind::Air;
  draft.out.scene.gravity = {0, 0};
  const double from = random.within(-3, 3);
  const int made = draft.box({0, 0}, s, random.within(0.1, 1) * s, from, BodyType::Kinematic);
  Body& body = draft.body(made);
  body.shapes.front().position = {random.within(0.2, 1.5) * s, random.within(-0.5, 0.5) * s};
  const int more = random.whole(1, 2);
  for (int i = 0; i < more; ++i) {
    Shape shape = body.shapes.front();
    shape.geometry = Circle{random.within(0.1, 0.5) * s};
    shape.position = {random.within(-1, 2) * s, random.within(-1, 1) * s};
    body.shapes.push_back(shape);
  }
  body.velocity = {random.within(-3, 3) * s, random.within(-3, 3) * s};
  const double rate = body.angular_velocity = random.within(-6, 6);
  const int steps = draft.out.steps = std::min(draft.out.steps, static_cast<int>(1.5 / dt));
  // Position and velocity of the body's centre of mass, updated each time that the centre changes.
  Vec2d centre{}, place = body.position, velocity = body.velocity;
  double time = 0;
  const auto go_on = [&](double until) {
    place += (until - time) * velocity;
    time = until;
  };
  const auto move_centre = [&](Vec2d to) {
    const Vec2d turn = direction(from + rate * time), way = to - centre;
    const Vec2d arm{turn.x * way.x - turn.y * way.y, turn.y * way.x + turn.x * way.y};
    place += arm, velocity += cross(rate, arm), centre = to;
  };
  if (random.chance(0.7)) {
    const int let_go = random.whole(1, steps / 2);
    draft.out.actions.push_back(
        {.kind = ActionKind::SetType, .step = let_go, .target = body.name, .type = BodyType::Dynamic});
    go_on(let_go * dt);
    move_centre(middle_of(body, body.shapes.size()));
    if (random.chance(0.5)) {
      const int lose = random.whole(let_go + 1, steps - 1);
      draft.out.actions.push_back({.kind = ActionKind::DestroyShape, .step = lose, .target = body.name});
      go_on(lose * dt);
      move_centre(middle_of(body, body.shapes.size() - 1));
    }
  }
  go_on(steps * dt);
  for (const Quantity quantity : {Quantity::X, Quantity::Y}) {
    Expectation& moves = draft.expect("moves_on", made, quantity);
    const double right = quantity == Quantity::X ? place.x : place.y;
    // Allows 0.5 % of the displacement and 5 % of the displacement by a step's rotation.
    const double slack = (0.005 + 0.05 * std::abs(rate) * dt) * (2 + std::abs(rate)) * s;
    moves.lower = right - slack, moves.upper = right + slack;
    moves.from = moves.to = steps * dt;
    moves.why =
        "a kinematic body follows its velocity; a body that is released keeps the velocity of each of its "
        "points";
  }
}

const Register r{{.name = "bat",
                  .title = "a kinematic body rotates about a point beside it and is released",
                  .weight = 0.7,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
