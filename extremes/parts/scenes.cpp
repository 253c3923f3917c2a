#include "extremes/parts/scenes.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace plumb::extremes {

Scene tower(std::string name, int count, double size, Vec2d foot) {
  Scene scene{.name = std::move(name)};
  for (int i = 0; i < count; ++i)
    scene.bodies.push_back({.name = "box" + std::to_string(i),
                            .position = foot + Vec2d{0, size * (i + 0.5)},
                            .mass = size * size,
                            .shapes = {{.geometry = Box{size, size}}}});
  scene.bodies.push_back({.name = "floor",
                          .type = BodyType::Static,
                          .position = foot - Vec2d{0, size / 2},
                          .shapes = {{.geometry = Box{20 * size, size}}}});
  return scene;
}

Scene pendulum(std::string name, double length, double angle, Vec2d pivot) {
  Scene scene{.name = std::move(name)};
  const Vec2d along{std::sin(angle), -std::cos(angle)};
  scene.bodies = {{.name = "rod",
                   .position = pivot + length / 2 * along,
                   .angle = angle,
                   .mass = length * length,
                   .inertia = length * length * length * length / 12,
                   .shapes = {untouchable(Box{length / 20, length})}}};
  scene.joints = {RevoluteJoint{.name = "hinge",
                                .body_a = std::string(kWorld),
                                .body_b = "rod",
                                .anchor_a = pivot,
                                .anchor_b = {0, length / 2}}};
  return scene;
}

Scene rod_chain(std::string name, int count, Vec2d direction, double tip) {
  Scene scene{.name = std::move(name)};
  std::string before{kWorld};
  Vec2d anchor{};
  const auto hang = [&](Body body, Vec2d own) {
    scene.joints.push_back(RevoluteJoint{.name = "hinge" + std::to_string(scene.joints.size()),
                                         .body_a = before,
                                         .body_b = body.name,
                                         .anchor_a = anchor,
                                         .anchor_b = own});
    before = body.name;
    scene.bodies.push_back(std::move(body));
  };
  for (int i = 0; i < count; ++i) {
    hang({.name = "rod" + std::to_string(i),
          .position = (i + 0.5) * direction,
          .angle = std::atan2(direction.y, direction.x),
          .mass = 1,
          .inertia = 1.0 / 12,
          .shapes = {untouchable(Box{1, 0.05})}},
         {-0.5, 0});
    anchor = {0.5, 0};
  }
  if (tip > 0)
    hang({.name = "tip", .position = count * direction, .mass = tip, .shapes = {untouchable(Circle{0.25})}},
         {});
  return scene;
}

Trial resting(Scene scene, double size, double dt, long steps) {
  Trial trial{.scene = std::move(scene), .dt = dt, .stretches = evenly(steps, 200)};
  trial.exact = at_rest(trial.scene);
  trial.judge = [size](const Scene& of) {
    return judge_by({deepest_overlap(of, size / 100), farthest_from_start(of, size / 20, 10 * size)});
  };
  return trial;
}

Motion at_rest(const Scene& scene) {
  std::vector<BodyState> start;
  for (const Body& body : scene.bodies) start.push_back(initial_state(body));
  return [start](double, std::span<BodyState> out) { std::copy(start.begin(), start.end(), out.begin()); };
}

}  // namespace plumb::extremes
