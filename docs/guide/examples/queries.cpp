// What a game asks its world: what is in the line of sight, in reach, under the cursor, nearest.
#include "engine/world/queries.h"

#include <cstdio>

int main() {
  using namespace plumb;
  World world;
  enum : std::uint32_t { kWalls = 1, kEnemies = 2 };
  const BodyId wall =
      world.create_body({.name = "wall", .type = BodyType::Static, .position = {6, 0}},
                        ShapeDefinition{.geometry = Box{1, 4}, .filter = {.category = kWalls}});
  const BodyId enemy =
      world.create_body({.name = "enemy", .position = {9, 0}},
                        ShapeDefinition{.geometry = Circle{0.5}, .filter = {.category = kEnemies}});

  // Line of sight: the wall is met first, 5.5 m ahead.
  const auto hit = ray_cast_closest(world, {0, 0}, {20, 0});
  if (!hit || hit->body != wall) return 1;

  // A shot that goes through walls: only enemies are looked for.
  const auto shot = ray_cast_closest(world, {0, 0}, {20, 0}, {.mask = kEnemies});
  if (!shot || shot->body != enemy) return 1;

  // How far a ball of 0.25 m can be thrown upwards beside the wall.
  const auto free_way = cast_shape_closest(world, Circle{0.25}, {5.2, -5}, 0, {0, 10});

  // All in a blast of 4 m, under the cursor, and the nearest thing to a point with how far it is.
  std::vector<ShapeId> in_blast, at_cursor;
  overlap_shape(world, Circle{4}, {9, 3}, 0, {}, in_blast);
  shapes_at(world, {9.2, 0.1}, {}, at_cursor);
  const auto closest = nearest(world, {7, 5}, 10);
  if (!closest) return 1;

  std::printf("wall in sight at %.2f m, free way: %s, %zu in the blast, %zu at the cursor, nearest %.2f m\n",
              20 * hit->fraction, free_way ? "no" : "yes", in_blast.size(), at_cursor.size(),
              closest->distance);
  return 0;
}
