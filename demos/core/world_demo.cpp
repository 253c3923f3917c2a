#include "demos/core/world_demo.h"

#include <cmath>

#include "demos/core/world_scene.h"
#include "engine/world/queries.h"
#include "engine/world/snapshot.h"
#include "engine/world/world_data.h"

namespace plumb::demos {

void WorldDemo::add_step_controls() {
  add_slider("dt", "s", 0.001, 0.05, dt_, "length of a step");
  add_slider("substeps", "", 1, 20, substeps_, "parts that a step is solved in");
}

void WorldDemo::build() {
  world_ = DemoWorld(definition());
  band_ = {};
  if (!frame_last()) create_frame();
  fill();
  if (frame_last()) create_frame();
  keep_past();
}

void WorldDemo::create_frame() { frame_ = world_.create_body({.name = "frame", .type = BodyType::Static}); }

void WorldDemo::keep_past() {
  before_.keep(world_);
  velocities_before_.clear();
  for (const BodyId body : world_.bodies()) {
    if (body.index >= velocities_before_.size()) velocities_before_.resize(body.index + 1);
    velocities_before_[body.index] = {body.generation, world_.velocity(body)};
  }
}

std::vector<Moving> WorldDemo::moving() const {
  std::vector<Moving> out;
  for (const BodyId body : world_.bodies()) {
    if (world_.type(body) == BodyType::Static) continue;
    const Vec2d velocity = world_.velocity(body);
    Moving moving{.box = world_.box(body),
                  .centre = drawn_centre(body),
                  .velocity = velocity,
                  .mass = world_.mass(body),
                  .awake = world_.awake(body),
                  .labelled = labelled(body)};
    // A body that was added since then has no earlier velocity.
    const bool known = body.index < velocities_before_.size() &&
                       velocities_before_[body.index].generation == body.generation;
    if (known && step_count() > 0)
      moving.force = moving.mass / dt() * (velocity - velocities_before_[body.index].velocity);
    out.push_back(moving);
  }
  return out;
}

std::optional<Scene> WorldDemo::scene() const { return scene_of(world_, about().name); }

void WorldDemo::add_pointer_play(const char* name) {
  pointer_ = kPlays;
  add_choice("pointer", {name, "grab"}, pointer_, "what a press does: the demo's own, or grab and throw");
}

double WorldDemo::reach() const { return view().half_perimeter() / 80; }

void WorldDemo::press(Vec2d point) {
  if (pointer_ == kPlays) {
    begin(point);
  } else if (!grab(point, reach())) {
    grab_else(point);
  }
}
void WorldDemo::drag(Vec2d point) {
  if (pointer_ == kPlays) {
    go_on(point);
  } else {
    pull(point);
  }
}
void WorldDemo::release(Vec2d point) {
  if (pointer_ == kPlays) {
    end(point);
  } else {
    pull(point);
    let_go();
  }
}
void WorldDemo::key(char key) {
  if (key == kGrabKey.key) set("pointer", pointer_ == kPlays ? kGrabs : kPlays);
}

void WorldDemo::step() {
  keep_past();
  before_step();
  advance_world();
  after_step();
}

void WorldDemo::draw(DebugDraw& out, const DrawOptions& options) const {
  plumb::draw(world_, before_, fraction(), out, options);
  draw_over(out);
}

Pose<double> WorldDemo::drawn_pose(BodyId body) const {
  return before_.between(world_.data(), static_cast<int>(body.index), fraction());
}
Vec2d WorldDemo::drawn_centre(BodyId body) const { return drawn_pose(body).position; }

void WorldDemo::write(Encoder& out) const {
  out.put(band_.index), out.put(band_.generation);
  out.put(own());
  std::vector<std::byte> world;
  plumb::save(world_, world);
  out.put(world);
}

void WorldDemo::read(Decoder& in) {
  JointId band;
  band.index = in.get<std::uint32_t>("band");
  band.generation = in.get<std::uint32_t>("band");
  std::vector<double> own;
  in.get(own, "own");
  std::vector<std::byte> world;
  in.get(world, "world");
  plumb::restore(world_, world);
  band_ = band;
  set_own(own);
  let_go();
  keep_past();
}

bool WorldDemo::grab(Vec2d point, double reach, double strength) {
  let_go();
  const auto moves = [&](ShapeId shape) { return world_.type(world_.body(shape)) == BodyType::Dynamic; };
  const std::optional<NearestResult> found = nearest(world_, point, reach, {.condition = moves});
  if (!found) return false;
  hold(found->body, point, strength);
  return true;
}

void WorldDemo::hold(BodyId body, Vec2d point, double strength) {
  let_go();
  const double weight = world_.mass(body) * std::fmax(9.81, std::sqrt(length_squared(world_.gravity())));
  world_.set_awake(body, true);
  band_ = world_.create_joint(
      frame_, body,
      {.kind = MouseDefinition{
           .anchor_b = world_.local_point(body, point), .target = point, .max_force = strength * weight}});
}

void WorldDemo::pull(Vec2d point) {
  if (!world_.valid(band_)) return;
  MouseDefinition mouse = std::get<MouseDefinition>(world_.kind(band_));
  mouse.target = point;
  world_.change(band_, mouse);
}

void WorldDemo::let_go() {
  if (world_.valid(band_)) world_.destroy(band_);
  band_ = {};
}

BodyId WorldDemo::held() const { return world_.valid(band_) ? world_.bodies(band_).second : BodyId{}; }

Totals totals_of(const DemoWorld& world) {
  Totals totals;
  for (const BodyId body : world.bodies()) {
    const double mass = world.mass(body);
    if (mass == 0) continue;
    const Vec2d velocity = world.velocity(body);
    const double spin = world.angular_velocity(body);
    totals.momentum += mass * velocity;
    totals.energy += 0.5 * (mass * length_squared(velocity) + world.inertia(body) * spin * spin);
  }
  return totals;
}

}  // namespace plumb::demos
