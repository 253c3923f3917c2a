#pragma once

#include <cmath>
#include <vector>

#include "engine/world/queries/query_filter.h"
#include "tests/world/query_truth.h"

namespace plumb::query_truth {

/// A crowd of bodies about `centre` with all kinds of shapes, and what the test knows of them.
template <class Real>
struct Crowd {
  struct Known {
    ShapeId id;
    BodyId body;
    ShapeDefinition shape;
    bool chain = false;
  };

  // Corners and rotations are rounded to Real: relative to sizes of a few metres.
  static constexpr double kTolerance = sizeof(Real) == 4 ? 3e-6 : 1e-8;

  Crowd(unsigned seed, Vec2d middle, int bodies = 60) : random(seed), centre(middle) {
    for (int i = 0; i < bodies; ++i) add_body();
  }

  void add_body() {
    BodyDefinition body;
    body.type = static_cast<BodyType>(random.below(3));
    body.position = centre + random.within(15);
    body.angle = random.uniform(-7, 7);
    body.velocity = random.within(5);
    body.angular_velocity = random.uniform(-3, 3);
    const BodyId id = world.create_body(body);
    for (int i = random.chance(0.3) ? 3 : 1; i > 0; --i) {
      ShapeDefinition shape;
      shape.geometry = random_geometry(random);
      shape.position = random.within(1);
      shape.angle = random.uniform(-4, 4);
      shape.filter = {1u << random.below(3), random.chance(0.8) ? 0xFFFFFFFFu : 2u, 0};
      shape.sensor = random.chance(0.15);
      known.push_back({world.create_shape(id, shape), id, shape});
    }
    if (!random.chance(0.15)) return;
    const ChainDefinition chain{.points = {random.within(2), random.within(2)}};
    const ChainId chain_id = world.create_chain(id, chain);
    ShapeDefinition line{.geometry = Segment{chain.points[0], chain.points[1]}};
    known.push_back({world.segments(chain_id)[0], id, line, true});
  }

  /// Seen from `origin`.
  Outline outline(const Known& shape, Vec2d origin) const {
    const Outline in_body =
        placed(outline_of(shape.shape.geometry), shape.shape.position.template as<Wide>(), shape.shape.angle);
    // The body's angle counts turns; its axes are what it is drawn by.
    const Vec2d at = world.position(shape.body), axis = world.world_point(shape.body, {1, 0}) - at;
    return placed(in_body, (at - origin).template as<Wide>(), std::atan2(Wide(axis.y), Wide(axis.x)));
  }

  bool seen(const Known& shape, const QueryFilter& filter) const {
    const Filter& own = shape.shape.filter;
    return (own.category & filter.mask) != 0 && (own.mask & filter.category) != 0 &&
           (!shape.shape.sensor || filter.sensors) && !(shape.body == filter.ignore);
  }

  QueryFilter random_filter() {
    QueryFilter filter;
    if (random.chance(0.4)) filter.mask = static_cast<std::uint32_t>(1 + random.below(7));
    if (random.chance(0.2)) filter.category = 1;
    filter.sensors = random.chance(0.3);
    if (random.chance(0.3)) filter.ignore = known[random.below(static_cast<int>(known.size()))].body;
    return filter;
  }

  /// Steps, then takes out every third body and puts every fourth one somewhere else.
  void stir() {
    for (int i = 0; i < 30; ++i) world.step();
    const std::vector<BodyId> bodies = world.bodies();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (i % 3 == 0) {
        world.destroy(bodies[i]);
      } else if (i % 4 == 0) {
        world.set_position(bodies[i], centre + random.within(15), random.uniform(-7, 7));
      }
    }
    std::erase_if(known, [&](const Known& shape) { return !world.valid(shape.id); });
    for (int i = 0; i < 10; ++i) add_body();
  }

  Random random;
  Vec2d centre;
  BasicWorld<Real> world;
  std::vector<Known> known;
};

}  // namespace plumb::query_truth
