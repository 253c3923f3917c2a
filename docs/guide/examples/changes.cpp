// Bodies and shapes are changed after they were made, and read without an allocation.
#include <array>
#include <cstdio>
#include <unordered_map>

#include "engine/world/queries.h"
#include "engine/world/world.h"

int main() {
  plumb::World world;
  world.create_body({.type = plumb::BodyType::Static, .position = {0, -1}}, {.geometry = plumb::Box{40, 2}});
  const plumb::BodyId crate = world.create_body({.position = {0, 0.5}}, {.geometry = plumb::Box{1, 1}});
  const plumb::BodyId lid = world.create_body({.position = {0, 1.5}}, {.geometry = plumb::Box{1, 1}});
  std::unordered_map<plumb::BodyId, const char*> sprites{{crate, "crate"}, {lid, "lid"}};

  world.set_name(crate, "crate");
  world.set_user_data(crate, 7);
  world.set_density(world.shapes(crate)[0], 5);  // kg/m^2
  for (int i = 0; i < 10; ++i) world.step();
  std::printf("the %s weighs %.0f kg\n", world.name(crate).c_str(), world.mass(crate));

  std::array<plumb::BodyId, 8> moved;
  std::printf("%zu bodies moved:", world.moved(moved));
  for (std::size_t i = 0; i < world.moved({}); ++i) std::printf(" %s", sprites.at(moved[i]));

  world.set_enabled(crate, false);  // not there until it is enabled again
  for (int i = 0; i < 60; ++i) world.step();
  std::array<plumb::BodyPose, 8> poses;
  const std::size_t count = world.poses(poses);
  std::printf("\n%zu bodies, the lid is at %.2f m\n", count, poses[2].position.y);

  const plumb::Aabb<double> box = world.box(lid);
  std::printf("its box reaches to %.2f m, and a ray at it alone %s\n", box.upper.y,
              plumb::ray_cast(world, world.shapes(lid)[0], {0, 5}, {0, -9}) ? "hits" : "misses");
  return 0;
}
