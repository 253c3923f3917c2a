// A game sets its own rules: which pairs collide, what counts as a hit, which loads it hears of, who may tunnel.
#include <algorithm>
#include <cstdio>

#include "engine/world/world.h"

int main() {
  constexpr std::uint64_t kGhost = 1ull << 40;  // one of 64 categories
  plumb::World world({.thresholds = {.hit = 0.5}});
  const plumb::BodyId ground = world.create_body({.type = plumb::BodyType::Static, .position = {0, -1}},
                                                 {.geometry = plumb::Box{40, 2}});
  const plumb::BodyId crate =
      world.create_body({.position = {0, 2}}, {.geometry = plumb::Box{1, 1}, .hit_events = true});
  const plumb::BodyId ghost = world.create_body(
      {.position = {3, 0.5}, .continuous = false}, {.geometry = plumb::Box{1, 1}, .filter = {.category = kGhost}});
  world.on_filter([&](plumb::ShapeId a, plumb::ShapeId b) {
    return ((world.filter(a).category | world.filter(b).category) & kGhost) == 0;
  });

  // A rope that says when it bears more than 7 N, and a motor without force: it only switches contact off.
  const plumb::BodyId lamp = world.create_body({.position = {-5, 3}}, {.geometry = plumb::Circle{0.5}});
  world.create_joint(ground, lamp,
                     {.kind = plumb::DistanceDefinition{.anchor_a = {-5, 6}, .length = 2}, .report_force = 7});
  const plumb::BodyId inner = world.create_body({.position = {8, 0.5}}, {.geometry = plumb::Box{1, 1}});
  const plumb::BodyId outer = world.create_body({.position = {8.2, 0.5}}, {.geometry = plumb::Box{1, 1}});
  world.create_joint(inner, outer, {.kind = plumb::MotorDefinition{}});

  double most = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    for (const plumb::JointLoadEvent& load : world.events().loaded) most = std::max(most, load.force);
    for (const plumb::HitEvent& hit : world.events().hits)
      std::printf("hit at %.1f m/s with %.1f N s\n", hit.speed, hit.impulse);
  }
  std::printf("the ghost is at %.0f m\n", world.position(ghost).y);
  std::printf("the crate is pressed with %.2f N\n", 60 * world.contacts(crate)[0].step_impulse);
  std::printf("the rope bore up to %.1f N\n", most);
  std::printf("the boxes are %.1f m apart\n", world.position(outer).x - world.position(inner).x);
  return 0;
}
