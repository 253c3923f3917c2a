#include "tests/scene/sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "engine/scene/joint_fields.h"
#include "engine/scene/json.h"

namespace plumb::test {
namespace {

double below(std::mt19937_64& random, double largest) {
  for (;;) {
    const double value = random_bits(random);
    if (std::abs(value) <= largest) return value;
  }
}

double any(std::mt19937_64& random) { return below(random, 1e100); }
double non_negative(std::mt19937_64& random) { return std::abs(any(random)); }
double unit(std::mt19937_64& random) { return std::abs(below(random, 1)); }
Vec2d vector(std::mt19937_64& random) { return {any(random), any(random)}; }

double positive(std::mt19937_64& random) {
  for (;;) {
    const double value = non_negative(random);
    if (value >= 1e-100) return value;
  }
}

int up_to(std::mt19937_64& random, int highest) {
  return static_cast<int>(random() % static_cast<unsigned>(highest + 1));
}

bool coin(std::mt19937_64& random) { return random() % 2 == 0; }

/// One of plain, quoted, non-Latin and emoji letters, made unique by `index`.
std::string name(std::mt19937_64& random, int index) {
  static const char* const kStems[] = {"body", "a \"quoted\" \\ name/", "Körper-球", "\xF0\x9F\x8F\x80", "'"};
  return kStems[up_to(random, 4)] + std::to_string(index);
}

Geometry random_geometry(std::mt19937_64& random) {
  switch (up_to(random, 5)) {
    case 0:
      return Circle{positive(random)};
    case 1: {
      const double width = positive(random);
      return Box{width, positive(random)};
    }
    case 2: {
      Capsule capsule{vector(random)};
      capsule.end = vector(random);
      capsule.radius = positive(random);
      return capsule;
    }
    case 3: {  // a triangle of any size, clear of a line
      const double size = 1e-20 + unit(random);
      return Polygon{{{0, 0}, {size, 0.25 * size}, {0.5 * size, size}}, unit(random)};
    }
    case 4: {
      const Vec2d start = vector(random);
      return Segment{start, {start.y, -1}};
    }
    default: {
      const double x = unit(random);
      return Chain{{{x, 1}, {2, x}, {3 + x, -0.0}}, coin(random)};
    }
  }
}

Shape random_shape(std::mt19937_64& random) {
  Shape shape;
  shape.geometry = random_geometry(random);
  shape.position = vector(random);
  shape.angle = any(random);
  shape.friction = non_negative(random);
  shape.restitution = unit(random);
  shape.filter = {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random()),
                  static_cast<std::int32_t>(random())};
  shape.rolling_resistance = non_negative(random);
  shape.surface_speed = any(random);
  return shape;
}

Body random_body(std::mt19937_64& random, int index) {
  Body body;
  body.name = name(random, index);
  body.type = static_cast<BodyType>(up_to(random, 2));
  body.position = vector(random);
  body.angle = any(random);
  body.fixed_rotation = coin(random);
  if (body.type != BodyType::Static) {
    body.velocity = vector(random);
    if (!body.fixed_rotation) body.angular_velocity = any(random);
  }
  body.mass = positive(random);
  for (int i = up_to(random, 3); i > 0; --i) body.shapes.push_back(random_shape(random));
  body.lock_x = coin(random), body.lock_y = coin(random);
  body.gravity_scale = any(random);
  body.linear_damping = non_negative(random), body.angular_damping = non_negative(random);
  const auto weighs = [](const Shape& shape) { return extent_of(shape.geometry).area > 0; };
  if (std::none_of(body.shapes.begin(), body.shapes.end(), weighs) || coin(random))
    body.inertia = positive(random);
  return body;
}

/// Gives each field of a joint a value that it may have.
struct RandomField {
  std::mt19937_64& random;

  void operator()(std::string_view, double& out, const FieldRule& rule) const {
    out = rule.limits == Limits::Any           ? any(random)
          : rule.limits == Limits::NonNegative ? non_negative(random)
                                               : positive(random);
  }
  void operator()(std::string_view, bool& out, const FieldRule&) const { out = coin(random); }
  void operator()(std::string_view, Vec2d& out, const FieldRule& rule) const {
    out = vector(random);
    if (rule.limits == Limits::NotZero) out.x = positive(random);
  }
  void operator()(std::string_view, Spring& out, const FieldRule&) const {
    out.hertz = positive(random);
    out.damping_ratio = non_negative(random);
  }
  void operator()(std::string_view, Motor& out, const FieldRule&) const {
    out.speed = any(random);
    out.max_force = non_negative(random);
  }
  void operator()(std::string_view, Range& out, const FieldRule&) const {
    out = {};
    if (coin(random)) out.lower = unit(random);
    if (coin(random)) out.upper = 1 + non_negative(random);
  }
  template <class T>
  void operator()(std::string_view key, std::optional<T>& out, const FieldRule& rule) const {
    if (coin(random)) (*this)(key, out.emplace(), rule);
  }
};

template <std::size_t... kIndex>
Joint joint_of_kind(std::size_t kind, std::index_sequence<kIndex...>) {
  Joint joint;
  (void)((kind == kIndex ? (joint.emplace<kIndex>(), true) : false) || ...);
  return joint;
}

Joint random_joint(std::mt19937_64& random, const Body& body, int index) {
  constexpr std::size_t kKinds = std::variant_size_v<Joint>;
  Joint joint = joint_of_kind(random() % kKinds, std::make_index_sequence<kKinds>());
  const RandomField fill{random};
  std::visit(
      [&](auto& j) {
        j.name = name(random, index);
        j.body_a = body.name, j.body_b = "world";
        if (coin(random)) std::swap(j.body_a, j.body_b);
        anchor_fields(j, fill);
        own_fields(j, fill);
        last_fields(j, fill);
      },
      joint);
  return joint;
}

ForceLaw random_force(std::mt19937_64& random, const Body& body) {
  const double infinite = std::numeric_limits<double>::infinity();
  const double start = non_negative(random);
  const double duration = coin(random) ? infinite : non_negative(random);
  switch (up_to(random, 8)) {
    case 0:
      return LinearDrag{body.name, non_negative(random), non_negative(random)};
    case 1:
      return QuadraticDrag{body.name, non_negative(random)};
    case 2:
      return PointForce{body.name, vector(random), vector(random), static_cast<Frame>(up_to(random, 1)),
                        start,     duration};
    case 3:
      return Torque{body.name, any(random), start, duration};
    case 4: {
      SpringForce spring{"world", body.name, vector(random), vector(random)};
      if (coin(random)) std::swap(spring.body_a, spring.body_b);
      spring.rest_length = non_negative(random);
      spring.stiffness = non_negative(random);
      spring.damping = non_negative(random);
      return spring;
    }
    case 5: {
      const Vec2d centre = vector(random);
      const double strength = any(random);
      return AttractionForce{body.name, "world", centre, strength, up_to(random, 18) - 9};
    }
    case 6:
      return FormulaForce{body.name, "sin(t)", "-m*x^3", "0.5*w", vector(random)};
    case 7:
      return FormulaSpring{"world", body.name, vector(random), vector(random), "table(length, 0, 1, 2, -3)"};
    default: {
      SinusoidalForce force{body.name, vector(random), vector(random)};
      force.angular_frequency = non_negative(random);
      force.phase = any(random);
      return force;
    }
  }
}

}  // namespace

double random_bits(std::mt19937_64& random) {
  for (;;) {
    const double value = std::bit_cast<double>(std::uint64_t{random()});
    if (std::isfinite(value)) return value;
  }
}

Scene random_scene(std::mt19937_64& random) {
  Scene scene;
  scene.name = name(random, 0);
  scene.gravity = vector(random);
  scene.contact_rules = {static_cast<Combine>(up_to(random, 4)),
                         static_cast<Combine>(up_to(random, 4)),
                         non_negative(random),
                         static_cast<Simultaneous>(up_to(random, 1)),
                         static_cast<ImpactRule>(up_to(random, 2)),
                         non_negative(random),
                         0.25 * up_to(random, 4),
                         0.25 * up_to(random, 4)};
  for (int i = up_to(random, 4); i > 0; --i) scene.bodies.push_back(random_body(random, i));
  for (const Body& body : scene.bodies) {
    const int index = static_cast<int>(scene.joints.size());
    if (body.type == BodyType::Dynamic) scene.joints.push_back(random_joint(random, body, index));
    if (coin(random)) scene.forces.push_back(random_force(random, body));
  }
  return scene;
}

Scene full_scene() {
  Scene scene{.name = "everything", .gravity = {0.1, -1.62}};
  scene.contact_rules = {Combine::Average, Combine::Product, 0.25};
  const Filter filter{6, 0xF0F0F0F0u, -3};
  const Shape disc{Circle{0.5}, {0.1, 0.2}, 0.3, 0.7, 0.9, filter, 0.05, -1.5};
  const Shape plank{Box{2, 0.25}, {-0.1, 0.4}, -0.6, 0.2, 0.1, filter, 0.01, 2};
  const auto other = [&](const Geometry& geometry) {
    return Shape{geometry, {0.5, 0.25}, 0.75, 0.3, 0.4, filter, 0.5, 1, 2.5};
  };
  const std::vector<Shape> more = {
      other(Capsule{{1, 2}, {3, 4}, 0.5}), other(Polygon{{{0, 1}, {2, 3}, {-4, 5}}, 0.125}),
      other(Segment{{1, 2}, {3, 5}}), other(Chain{{{0, 1}, {2, 3}, {-4, 5}}, true})};
  scene.bodies = {{"ball",
                   BodyType::Dynamic,
                   {1, 2},
                   0.5,
                   {3, 4},
                   5,
                   6,
                   7.5,
                   false,
                   {disc, plank},
                   0.5,
                   0.1,
                   0.2,
                   true,
                   true},
                  {"floor", BodyType::Static, {0, -1}, 0.25, {}, 0, 2, {}, true, {plank}},
                  {"belt", BodyType::Kinematic, {9, 1}, 0.125, {1, 0}, 2, 0, 0.5, false, {}},
                  {"rock", BodyType::Kinematic, {9, 1}, 0.125, {1, 0}, 2, 0, 0.5, false, more}};
  const Range range{0.25, 0.5};
  const Motor motor{1, 2};
  const Spring spring{3, 4};
  scene.joints = {
      RevoluteJoint{"hinge", "world", "ball", {1, 1}, {2, 2}, true, 1, 2, 3, range, motor, spring, 4},
      DistanceJoint{"rod", "ball", "floor", {3, 3}, {4, 4}, 5, true, 1, 2, spring, range, motor},
      PrismaticJoint{
          "slide", "world", "ball", {1, 1}, {2, 2}, true, 1, 2, {3, 4}, 5, range, motor, spring, 6},
      WeldJoint{"weld", "world", "ball", {1, 1}, {2, 2}, true, 1, 2, 3, spring, spring},
      WheelJoint{"wheel", "world", "ball", {1, 1}, {2, 2}, true, 1, 2, {3, 4}, spring, range, motor},
      MotorJoint{"follow", "world", "ball", true, 1, 2, {3, 4}, 5, 6, 7, spring},
      MouseJoint{"pull", "world", "ball", {1, 1}, true, 1, 2, {3, 4}, spring, 5},
      GearJoint{"gear", "floor", "ball", true, 1, 2, 3, 4},
      PulleyJoint{"rope", "floor", "ball", {1, 1}, {2, 2}, true, 1, 2, {3, 4}, {5, 6}, 7, 8},
      RatchetJoint{"click", "floor", "ball", true, 1, 2, 3, 4},
      FrictionJoint{"drag", "floor", "ball", {1, 1}, {2, 2}, true, 1, 2, 3, 4}};
  scene.forces = {LinearDrag{"ball", 0.5},
                  QuadraticDrag{"ball", 0.25},
                  PointForce{"ball", {1, 2}, {3, 4}, Frame::Body, 0.5, 1.5},
                  Torque{"ball", -2, 0.25, 2},
                  SpringForce{"ball", "floor", {1, 2}, {3, 4}, 0.5, 60, 0.75},
                  AttractionForce{"ball", "floor", {5, 6}, 8, 3},
                  SinusoidalForce{"ball", {1, 2}, {3, 4}, 5, 6},
                  FormulaForce{"ball", "1", "2*t", "sin(w)", {3, 4}},
                  FormulaSpring{"ball", "floor", {1, 2}, {3, 4}, "5*length"}};
  scene.bodies.back().motion = {"9", "1 + 0.1*t", "0.125"};
  scene.drives = {{"hinge", "cos(t)"}};
  return scene;
}

Error error_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  throw std::logic_error("no error");
}

bool same_bits(const Scene& a, const Scene& b) {
  // Equality tells every value apart but the zeros; those the text shows, which has a place for every field.
  return a == b && to_json(a) == to_json(b);
}

}  // namespace plumb::test
