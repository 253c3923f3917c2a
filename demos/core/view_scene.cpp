#include "demos/core/view_scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "engine/geometry/convex_hull.h"
#include "engine/math/trigonometry.h"

namespace plumb::demos {
namespace {

constexpr double kReach = 20;  // ratio of the view's size to the search radius of the pointer

// Bounding box of everything drawn.
class Bounds final : public DebugDraw {
 public:
  void polygon(std::span<const Vec2d> corners, double radius, DrawRole) override {
    for (const Vec2d& corner : corners) reach(corner, radius);
  }
  void circle(Vec2d centre, double radius, Vec2d, DrawRole) override { reach(centre, radius); }
  void capsule(Vec2d start, Vec2d end, double radius, DrawRole) override {
    reach(start, radius), reach(end, radius);
  }
  void segment(Vec2d start, Vec2d end, DrawRole) override { reach(start, 0), reach(end, 0); }
  void point(Vec2d point, DrawRole) override { reach(point, 0); }
  void text(Vec2d, std::string_view, DrawRole) override {}

  bool empty() const { return !(box.lower.x <= box.upper.x); }

  Aabb<double> box{{kFar, kFar}, {-kFar, -kFar}};

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  void reach(Vec2d point, double radius) { box = merged(box, Aabb<double>{point, point}.grown(radius)); }
};

struct Placed {
  Vec2d position{};
  Rotation<double> rotation;
  Vec2d operator()(Vec2d point) const { return position + rotation * point; }
};

void draw_shape(const Shape& shape, const Placed& body, DebugDraw& out, DrawRole role) {
  const Rotation<double> own = rotation_of(shape.angle);
  const auto at = [&](Vec2d point) { return body(shape.position + own * point); };
  if (const auto* circle = std::get_if<Circle>(&shape.geometry)) {
    out.circle(at({}), circle->radius, body.rotation * (own * Vec2d{1, 0}), role);
  } else if (const auto* box = std::get_if<Box>(&shape.geometry)) {
    const double x = box->width / 2, y = box->height / 2;
    const Vec2d corners[] = {at({-x, -y}), at({x, -y}), at({x, y}), at({-x, y})};
    out.polygon(corners, 0, role);
  } else if (const auto* capsule = std::get_if<Capsule>(&shape.geometry)) {
    out.capsule(at(capsule->start), at(capsule->end), capsule->radius, role);
  } else if (const auto* polygon = std::get_if<Polygon>(&shape.geometry)) {
    std::vector<Vec2d> corners;
    for (const Corner<double>& corner : convex_hull(polygon->points)) corners.push_back(at(corner.point));
    out.polygon(corners, polygon->radius, role);
  } else if (const auto* segment = std::get_if<Segment>(&shape.geometry)) {
    out.segment(at(segment->start), at(segment->end), role);
  } else if (const auto* chain = std::get_if<Chain>(&shape.geometry)) {
    const std::size_t count = chain->points.size();
    for (std::size_t i = chain->closed ? 0 : 1; i < count; ++i)
      out.segment(at(chain->points[(i + count - 1) % count]), at(chain->points[i]), role);
  }
}

std::vector<std::string> solver_names() {
  std::vector<std::string> names(std::begin(kSolverNames), std::end(kSolverNames));
  for (std::string& name : names) std::ranges::replace(name, '_', ' ');
  return names;
}

About about_of(const Scene& scene, const std::string& summary) {
  return {.name = scene.name.empty() ? "scene" : scene.name,
          .summary = summary,
          .play = sentence_of(summary) + (summary.empty() ? "" : " ") + "Drag bodies with the pointer."};
}

std::vector<BodyState> start_of(const Scene& scene) {
  std::vector<BodyState> states;
  for (const Body& body : scene.bodies)
    states.push_back({body.position, body.angle, body.velocity, body.angular_velocity});
  return states;
}

}  // namespace

void draw_body(const Body& body, const BodyState& state, DebugDraw& out, DrawRole role) {
  const Placed placed{state.position, rotation_of(state.angle)};
  for (const Shape& shape : body.shapes) draw_shape(shape, placed, out, role);
  if (body.shapes.empty()) out.point(state.position, role);
}

void draw_connections(const Scene& scene, std::span<const BodyState> states, double size, DebugDraw& out) {
  // Returns the position of a point of a body, or of the world if that is the joint's end.
  const auto at = [&](const std::string& name, Vec2d anchor) {
    const auto body = find_body(scene, name);
    if (!body) return anchor;
    return states[*body].position + rotation_of(states[*body].angle) * anchor;
  };
  for (const ForceLaw& law : scene.forces) {
    if (const auto* spring = std::get_if<SpringForce>(&law)) {
      draw_spring(out, at(spring->body_a, spring->anchor_a), at(spring->body_b, spring->anchor_b),
                  DrawRole::JointLine);
    } else if (const auto* attraction = std::get_if<AttractionForce>(&law);
               attraction != nullptr && attraction->centre_body == kWorld) {
      out.circle(attraction->centre, size / 100, {0, 0}, DrawRole::Highlight);
    }
  }
  for (const Joint& joint : scene.joints) {
    if (const auto* pulley = std::get_if<PulleyJoint>(&joint)) {
      draw_pulleys(out, at(pulley->body_a, pulley->anchor_a), pulley->ground_a, pulley->ground_b,
                   at(pulley->body_b, pulley->anchor_b), DrawRole::JointLine);
    } else if (const auto* stick = std::get_if<DistanceJoint>(&joint)) {
      const Vec2d a = at(stick->body_a, stick->anchor_a), b = at(stick->body_b, stick->anchor_b);
      if (stick->spring) {
        draw_spring(out, a, b, DrawRole::JointLine);
      } else {
        out.segment(a, b, DrawRole::JointLine);
      }
    }
  }
}

Aabb<double> bounds_of(const Scene& scene, std::span<const BodyState> states) {
  Bounds moving, all;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    draw_body(scene.bodies[i], states[i], all, DrawRole::Awake);
    if (scene.bodies[i].type != BodyType::Static)
      draw_body(scene.bodies[i], states[i], moving, DrawRole::Awake);
  }
  draw_connections(scene, states, 0, moving);
  if (!moving.empty()) return moving.box;
  return all.empty() ? Aabb<double>{{-1, -1}, {1, 1}} : all.box;
}

SceneDemo::SceneDemo(const Scene& scene, const std::string& summary, std::optional<Aabb<double>> view)
    : WorldDemo(about_of(scene, summary)), scene_(scene) {
  add_choice("solver", solver_names(), solver_, "how contacts and joints are held");
  add_slider("iterations", "", 1, 50, iterations_, "sweeps a substep, where the solver has them");
  add_step_controls();
  if (view) {
    view_ = *view;
  } else {
    const Aabb<double> box = bounds_of(scene_, start_of(scene_));
    view_ = box.grown(0.3 * box.half_perimeter());
  }
  restart();
}

WorldDefinition SceneDemo::definition() const {
  WorldDefinition definition = world_definition(scene_);
  definition.sleeping = false;
  definition.solver = static_cast<Solver>(solver_);
  definition.iterations = iterations_;
  return definition;
}

void SceneDemo::fill() {
  parts_ = add_scene(world_, scene_);
  forces_.emplace(scene_, parts_);
  drives_.emplace(scene_, parts_);
}

// Evaluates force laws, prescribed motions and drives in each substep, as a Simulation does: with any of
// these, each substep is a step of the world.
void SceneDemo::advance_world() {
  if (forces_->empty() && drives_->empty()) {
    world_.step(dt_, substeps_);
    return;
  }
  const double substep = dt_ / substeps_;  // s
  for (int i = 0; i < substeps_; ++i) {
    drives_->apply(world_, substep);
    forces_->apply(world_, substep);
    world_.step(substep, 1);
  }
}

void SceneDemo::changed(std::string_view control) {
  if (control == "solver") world_.set_solver(static_cast<Solver>(solver_));
  if (control == "iterations") world_.set_iterations(iterations_);
}

void SceneDemo::read_states(std::span<BodyState> out) const {
  for (std::size_t i = 0; i < parts_.bodies.size(); ++i) out[i] = world_.state(parts_.bodies[i]);
  drives_->read_velocities(world_.time(), out);
}

double SceneDemo::reach() const { return view_.half_perimeter() / kReach; }

// Grabs a body whose shapes collide with nothing (such as the rods of a chain), which queries do not find.
// Takes the nearest one by the bounding box of each body in its own frame.
bool SceneDemo::grab_else(Vec2d point) {
  BodyId nearest_body{};
  double nearest_distance = reach();
  for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
    if (scene_.bodies[i].type != BodyType::Dynamic) continue;
    Bounds own;
    draw_body(scene_.bodies[i], {}, own, DrawRole::Awake);
    const Vec2d local = world_.local_point(parts_.bodies[i], point);
    const Vec2d inside{std::clamp(local.x, own.box.lower.x, own.box.upper.x),
                       std::clamp(local.y, own.box.lower.y, own.box.upper.y)};
    const double distance = std::sqrt(length_squared(local - inside));
    if (distance > nearest_distance) continue;
    nearest_distance = distance;
    nearest_body = parts_.bodies[i];
  }
  if (!world_.valid(nearest_body)) return false;
  hold(nearest_body, point);
  return true;
}

std::optional<Scene> SceneDemo::scene() const {
  Scene now = scene_;
  for (std::size_t i = 0; i < now.bodies.size(); ++i) {
    const BodyState state = world_.state(parts_.bodies[i]);
    Body& body = now.bodies[i];
    body.position = state.position, body.angle = state.angle;
    body.velocity = state.velocity, body.angular_velocity = state.angular_velocity;
  }
  return now;
}

void SceneDemo::draw_over(DebugDraw& out) const {
  if (scene_.forces.empty() && scene_.joints.empty()) return;
  std::vector<BodyState> states(scene_.bodies.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Pose<double> pose = drawn_pose(parts_.bodies[i]);
    states[i].position = drawn_centre(parts_.bodies[i]);
    states[i].angle = std::atan2(pose.rotation.s, pose.rotation.c);
  }
  draw_connections(scene_, states, view_.half_perimeter(), out);
}

std::vector<Figure> SceneDemo::figures() const {
  const Totals totals = totals_of(world_);
  return {{"time", time(), "s"},
          {"momentum x", totals.momentum.x, "kg m/s"},
          {"momentum y", totals.momentum.y, "kg m/s"},
          {"kinetic energy", totals.energy, "J"}};
}

}  // namespace plumb::demos
