#include "tests/properties/scenes.h"

#include <cmath>
#include <ostream>
#include <string>

#include "engine/scene/json.h"

namespace plumb::properties {
namespace {

constexpr double kCell = 2.4;  // m: things in neighbouring cells do not touch

Vec2d turn(Vec2d v) { return {-v.y, v.x}; }
Vec2d mirror(Vec2d v) { return {-v.x, v.y}; }

/// A point of the world in a body's frame.
Vec2d local(const Body& body, Vec2d point) {
  const double c = std::cos(body.angle), s = std::sin(body.angle);
  const Vec2d way = point - body.position;
  return {c * way.x + s * way.y, c * way.y - s * way.x};
}

Shape shape_of(const Thing& thing, bool bouncy) {
  const double half = 0.2 + 0.07 * thing.size;
  Shape shape{.geometry = Circle{half}};
  if (thing.form == 1) shape.geometry = Box{1.9 * half, 1.1 * half};
  if (thing.form == 2)
    shape.geometry = Polygon{{{-half, -0.5 * half}, {half, -0.6 * half}, {0.1 * half, half}}};
  if (thing.form == 3) shape.geometry = Capsule{{-half, 0.1}, {0.8 * half, 0}, 0.4 * half};
  shape.friction = 0.22 * thing.friction;
  shape.restitution = bouncy ? 0.1 + 0.18 * thing.bounce : 0.21 * thing.bounce;
  return shape;
}

Body body_of(const Recipe& recipe, std::size_t index) {
  const Thing& thing = recipe.things[index];
  const double own = static_cast<double>(index);
  Body body{.name = "b" + std::to_string(index)};
  // Odd numbers, so that nothing lies flat on anything or meets it at a corner.
  body.position = {kCell * static_cast<double>(index % 3) + 0.031 * thing.dx + 0.0037 * own,
                   kCell * std::floor(own / 3) + 0.029 * thing.dy + 0.0053 * own};
  body.angle = 0.37 * thing.turn + 0.0171 * (own + 1);
  body.velocity = {0.41 * thing.vx, 0.39 * thing.vy};
  body.angular_velocity = 0.43 * thing.spin;
  // No two have the ratio from which on a World solves their joints directly.
  body.mass = 0.31 + 0.7 * thing.mass;
  body.shapes = {shape_of(thing, recipe.bouncy)};
  if (!recipe.contacts) body.shapes[0].filter.mask = 0;
  return body;
}

void add_tie(Scene& scene, const Recipe& recipe, std::size_t index) {
  const int tie = recipe.things[index].tie;
  if (tie == kFree || !recipe.ties[static_cast<std::size_t>(tie)]) return;
  const Body& b = scene.bodies[index];
  if (tie == kDrag) return scene.forces.push_back(LinearDrag{b.name, 0.3}), void();
  const std::string name = "t" + std::to_string(index);
  if (tie == kPinned) {
    const Vec2d point = b.position + Vec2d{0.3, 0.4};
    RevoluteJoint joint{.name = name, .body_a = std::string(kWorld), .body_b = b.name};
    joint.anchor_a = point, joint.anchor_b = local(b, point);
    return scene.joints.push_back(joint), void();
  }
  if (index == 0) return;
  const Body& a = scene.bodies[index - 1];
  const Vec2d middle = 0.5 * (a.position + b.position);
  const double apart = std::sqrt(length_squared(b.position - a.position));
  if (tie == kRevolute || tie == kWeld) {
    RevoluteJoint joint{.name = name, .body_a = a.name, .body_b = b.name};
    joint.anchor_a = local(a, middle), joint.anchor_b = local(b, middle);
    if (tie == kRevolute) return scene.joints.push_back(joint), void();
    WeldJoint weld{.name = name, .body_a = a.name, .body_b = b.name};
    weld.anchor_a = joint.anchor_a, weld.anchor_b = joint.anchor_b;
    weld.reference_angle = b.angle - a.angle;
    scene.joints.push_back(weld);
  } else if (tie == kRod || tie == kSoftRod) {
    DistanceJoint joint{.name = name, .body_a = a.name, .body_b = b.name};
    joint.length = apart;
    if (tie == kSoftRod) joint.spring = Spring{2, 0.1};
    scene.joints.push_back(joint);
  } else if (tie == kSlider) {
    PrismaticJoint joint{.name = name, .body_a = a.name, .body_b = b.name};
    joint.anchor_a = local(a, middle), joint.anchor_b = local(b, middle);
    joint.axis = {0.6, 0.8};
    joint.reference_angle = b.angle - a.angle;
    scene.joints.push_back(joint);
  } else if (tie == kSpring) {
    SpringForce spring{.body_a = a.name, .body_b = b.name};
    spring.anchor_b = {0.1, 0.2};
    spring.rest_length = 2, spring.stiffness = 11, spring.damping = 0;
    scene.forces.push_back(spring);
  } else if (tie == kPull) {
    scene.forces.push_back(
        AttractionForce{.body = b.name, .centre_body = a.name, .strength = 3, .exponent = -1});
  }
}

Body wall(const char* name, Vec2d position, double width, double height) {
  Shape shape{.geometry = Box{width, height}};
  shape.restitution = 0.5;
  return {.name = name, .type = BodyType::Static, .position = position, .shapes = {shape}};
}

/// Calls `change(point)` for each vector of the scene that is a direction or a place in a frame that turns
/// with it, and `place(point)` for places in the world.
template <class Vector, class PlaceOf>
void change_vectors(Scene& scene, Vector vector, PlaceOf place) {
  vector(scene.gravity);
  for (Body& body : scene.bodies) {
    place(body.position), vector(body.velocity);
    for (Shape& shape : body.shapes) {
      vector(shape.position);
      if (auto* capsule = std::get_if<Capsule>(&shape.geometry)) vector(capsule->start), vector(capsule->end);
      if (auto* polygon = std::get_if<Polygon>(&shape.geometry))
        for (Vec2d& point : polygon->points) vector(point);
    }
  }
  const auto anchor = [&](const std::string& body, Vec2d& point) {
    body == kWorld ? place(point) : vector(point);
  };
  for (Joint& joint : scene.joints) {
    std::visit(
        [&](auto& j) {
          if constexpr (requires { j.anchor_a; }) anchor(j.body_a, j.anchor_a);
          if constexpr (requires { j.anchor_b; }) anchor(j.body_b, j.anchor_b);
          if constexpr (requires { j.axis; }) vector(j.axis);
        },
        joint);
  }
  for (ForceLaw& law : scene.forces) {
    if (auto* spring = std::get_if<SpringForce>(&law)) vector(spring->anchor_a), vector(spring->anchor_b);
    if (auto* pull = std::get_if<AttractionForce>(&law)) vector(pull->centre);
  }
}

}  // namespace

Scene scene_of(const Recipe& recipe) {
  Scene scene{.name = "made up", .gravity = {0, recipe.gravity ? -9.81 : 0.0}};
  for (std::size_t i = 0; i < recipe.things.size(); ++i) scene.bodies.push_back(body_of(recipe, i));
  for (std::size_t i = 0; i < recipe.things.size(); ++i) add_tie(scene, recipe, i);
  if (recipe.walls) {
    scene.bodies.push_back(wall("floor", {2.4, -2.2}, 40, 2));
    scene.bodies.push_back(wall("left", {-2.6, 6}, 2, 30));
    scene.bodies.push_back(wall("right", {7.7, 6}, 2, 30));
  }
  return scene;
}

void showValue(const Recipe& recipe, std::ostream& out) { out << to_json(scene_of(recipe), 2); }

rc::Gen<int> about(int range) {
  return rc::gen::map(rc::gen::inRange(0, 2 * range + 1),
                      [](int n) { return n % 2 == 0 ? -n / 2 : (n + 1) / 2; });
}

rc::Gen<Recipe> recipes(const Recipe& sample, std::size_t most) {
  using namespace rc;
  const Gen<Thing> thing = gen::build<Thing>(
      gen::set(&Thing::form, gen::inRange(0, 4)), gen::set(&Thing::size, gen::inRange(0, 6)),
      gen::set(&Thing::dx, about(8)), gen::set(&Thing::dy, about(8)), gen::set(&Thing::vx, about(8)),
      gen::set(&Thing::vy, about(8)), gen::set(&Thing::spin, about(8)), gen::set(&Thing::turn, about(8)),
      gen::set(&Thing::mass, gen::inRange(0, 8)), gen::set(&Thing::friction, gen::inRange(0, 5)),
      gen::set(&Thing::bounce, gen::inRange(0, 5)), gen::set(&Thing::tie, gen::inRange(0, int{kTies})));
  const auto things = gen::mapcat(gen::inRange<std::size_t>(1, most + 1), [thing](std::size_t count) {
    return gen::container<std::vector<Thing>>(count, thing);
  });
  return gen::map(things, [sample](std::vector<Thing> all) {
    Recipe recipe = sample;
    recipe.things = std::move(all);
    return recipe;
  });
}

Scene mirrored(Scene scene) {
  const auto flip = [](Vec2d& v) { v = mirror(v); };
  change_vectors(scene, flip, flip);
  for (Body& body : scene.bodies) {
    body.angle = -body.angle, body.angular_velocity = -body.angular_velocity;
    for (Shape& shape : body.shapes) shape.angle = -shape.angle;
  }
  for (Joint& joint : scene.joints) {
    std::visit(
        [](auto& j) {
          if constexpr (requires { j.reference_angle; }) j.reference_angle = -j.reference_angle;
        },
        joint);
  }
  return scene;
}

// Bodies keep their angles: their frames are turned instead, so that no angle is rounded.
Scene turned(Scene scene) {
  const auto rotate = [](Vec2d& v) { v = turn(v); };
  change_vectors(scene, rotate, rotate);
  for (Body& body : scene.bodies) {
    for (Shape& shape : body.shapes) {
      if (auto* box = std::get_if<Box>(&shape.geometry)) std::swap(box->width, box->height);
    }
  }
  return scene;
}

Scene shifted(Scene scene, Vec2d by) {
  change_vectors(
      scene, [](Vec2d&) {}, [by](Vec2d& v) { v += by; });
  return scene;
}

Scene boosted(Scene scene, Vec2d by) {
  for (Body& body : scene.bodies) body.velocity += by;
  return scene;
}

Scene scaled(Scene scene, double length, double time, double mass) {
  const double speed = length / time;
  change_vectors(
      scene, [=](Vec2d& v) { v = length * v; }, [=](Vec2d& v) { v = length * v; });
  scene.gravity = (1 / (time * time)) * scene.gravity;
  for (Body& body : scene.bodies) {
    body.velocity = (speed / length) * body.velocity;  // it was taken for a length
    body.angular_velocity /= time;
    body.mass *= mass;
    for (Shape& shape : body.shapes) {
      if (auto* circle = std::get_if<Circle>(&shape.geometry)) circle->radius *= length;
      if (auto* box = std::get_if<Box>(&shape.geometry)) box->width *= length, box->height *= length;
      if (auto* capsule = std::get_if<Capsule>(&shape.geometry)) capsule->radius *= length;
    }
  }
  for (Joint& joint : scene.joints) {
    if (auto* rod = std::get_if<DistanceJoint>(&joint)) {
      rod->length *= length;
      if (rod->spring) rod->spring->hertz /= time;
    }
  }
  for (ForceLaw& law : scene.forces) {
    if (auto* drag = std::get_if<LinearDrag>(&law)) drag->coefficient *= mass / time;
    if (auto* spring = std::get_if<SpringForce>(&law)) {
      spring->rest_length *= length;
      spring->stiffness *= mass / (time * time);
      spring->damping *= mass / time;
    }
    // Of exponent -1: 1/s^2.
    if (auto* pull = std::get_if<AttractionForce>(&law)) pull->strength /= time * time;
  }
  return scene;
}

BodyState mirrored(const BodyState& s) {
  return {mirror(s.position), -s.angle, mirror(s.velocity), -s.angular_velocity};
}
BodyState turned(const BodyState& s) {
  return {turn(s.position), s.angle, turn(s.velocity), s.angular_velocity};
}
BodyState scaled(const BodyState& s, double length, double time) {
  return {length * s.position, s.angle, (length / time) * s.velocity, s.angular_velocity / time};
}

}  // namespace plumb::properties
