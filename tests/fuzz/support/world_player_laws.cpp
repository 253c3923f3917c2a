#include "engine/scene/error.h"
#include "engine/world/force_laws.h"
#include "engine/world/mover.h"
#include "engine/world/queries.h"
#include "tests/fuzz/support/require.h"
#include "tests/fuzz/support/world_parts.h"
#include "tests/fuzz/support/world_player.h"

/// The members of WorldPlayer that push by laws and ask questions.
namespace plumb::fuzz {

template <class Real>
void WorldPlayer<Real>::apply_forces() {
  const double dt = 1.0 / 60;
  const int which = in_.below(9);
  const LawOptions options{.wakes = in_.flag()};
  for (const BodyId body : world_.bodies()) note_push(body);
  switch (which) {
    case 0:
      return apply_linear_drag(world_, {in_.number(0, 5), in_.number(0, 5)}, dt, options);
    case 1:
      return apply_quadratic_drag(world_, in_.number(0, 2), dt, options);
    case 2:
      return apply_attraction(world_, in_.vector(12), {.strength = in_.number(-20, 20)}, dt, options);
    case 3: {
      const BodyId centre = some_body();
      return apply_attraction_to_body(world_, centre, {.strength = in_.number(-20, 20)}, dt, options);
    }
    case 4:
      return apply_wind(world_, {in_.vector(20), in_.number(0, 2)}, dt, options);
    case 5:
      return apply_water(world_,
                         {.level = in_.number(-5, 5),
                          .density = in_.number(0, 2),
                          .velocity = in_.vector(3),
                          .linear_drag = in_.number(0, 5),
                          .angular_drag = in_.number(0, 5)},
                         dt, options);
    case 6: {
      const BodyId a = some_body(), b = some_body();
      const Vec2d point = in_.vector(1);
      return apply_spring(world_, a, point, b, {}, {in_.number(0, 500), in_.number(0, 20), in_.number(0, 3)},
                          dt, options);
    }
    case 7:
      return apply_law(
          world_,
          [&](const LawBody& body) {
            return Wrench<double>{{body.mass * in_.number(-5, 5), 0}, 0};
          },
          options);
    default: {
      const Blast blast{
          .centre = in_.vector(12), .radius = in_.number(0.5, 10), .impulse = in_.number(0, 20)};
      return explode(world_, blast, {.occlusion = options.wakes});
    }
  }
}

template <class Real>
void WorldPlayer<Real>::ask() {
  const Vec2d from = in_.vector(12), way = in_.vector(20);
  try {
    switch (in_.below(6)) {
      case 0:
        ray_cast_closest(world_, from, way);
        return;
      case 1: {
        const QueryShape shape(draw_geometry(in_));
        cast_shape_closest(world_, shape, from, in_.number(-3, 3), way);
        return;
      }
      case 2: {
        std::vector<ShapeId> found;
        const QueryShape shape(draw_geometry(in_));
        overlap_shape(world_, shape, from, in_.number(-3, 3), {}, found);
        return;
      }
      case 3:
        nearest(world_, from, in_.number(0, 20));
        return;
      case 4: {
        const ShapeId a = some(shapes_), b = some(shapes_);
        distance(world_, a, b);
        return;
      }
      default: {
        const MoverResult moved = move(world_, {{0, -0.4}, {0, 0.4}, 0.3}, from, way, 1.0 / 60, {.mass = 1});
        apply_pushes(world_, moved);
      }
    }
  } catch (const Error& error) {
    const bool known = error.kind() == Error::Kind::Value || error.kind() == Error::Kind::Name;
    if (!known) fail("questions are refused for values and names alone", error.what());
  }
}

template void WorldPlayer<float>::apply_forces();
template void WorldPlayer<double>::apply_forces();
template void WorldPlayer<float>::ask();
template void WorldPlayer<double>::ask();

}  // namespace plumb::fuzz
