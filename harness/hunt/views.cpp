#include "harness/hunt/views.h"

#include <algorithm>

#include "harness/hunt/random.h"
#include "harness/hunt/subject.h"

namespace plumb::harness::hunt {
namespace {

constexpr double kQuarter = 1.5707963267948966;

Vec2d mirror(Vec2d v) { return {-v.x, v.y}; }
Vec2d turn(Vec2d v) { return {-v.y, v.x}; }

/// Applies `vector` to all directions and `point` to all positions in the world.
template <class Vector, class Point>
void change(Scene& scene, const Vector& vector, const Point& point) {
  scene.gravity = vector(scene.gravity);
  for (Body& body : scene.bodies) body.position = point(body.position), body.velocity = vector(body.velocity);
  for (Joint& joint : scene.joints) {
    std::visit(
        [&](auto& j) {
          if constexpr (requires { j.target; }) j.target = point(j.target);
          if constexpr (requires { j.ground_a; })
            j.ground_a = point(j.ground_a), j.ground_b = point(j.ground_b);
          if constexpr (requires { j.anchor_a; })
            if (j.body_a == kWorld) j.anchor_a = point(j.anchor_a);
          if constexpr (requires { j.anchor_b; })
            if (j.body_b == kWorld) j.anchor_b = point(j.anchor_b);
          if constexpr (requires { j.axis; })
            if (j.body_a == kWorld) j.axis = vector(j.axis);
          if constexpr (requires { j.target_position; })
            if (j.body_a == kWorld) j.target_position = point(j.target_position);
        },
        joint);
  }
  for (ForceLaw& law : scene.forces) {
    if (auto* spring = std::get_if<SpringForce>(&law)) {
      if (spring->body_a == kWorld) spring->anchor_a = point(spring->anchor_a);
      if (spring->body_b == kWorld) spring->anchor_b = point(spring->anchor_b);
    }
    if (auto* pull = std::get_if<AttractionForce>(&law); pull != nullptr && pull->centre_body == kWorld)
      pull->centre = point(pull->centre);
  }
}

/// Applies `vector` to all vectors in the bodies' own frames.
template <class Vector>
void change_inside(Scene& scene, const Vector& vector) {
  for (Body& body : scene.bodies) {
    for (Shape& shape : body.shapes) {
      shape.position = vector(shape.position);
      std::visit(
          [&](auto& g) {
            if constexpr (requires { g.start; }) g.start = vector(g.start), g.end = vector(g.end);
            if constexpr (requires { g.points; })
              for (Vec2d& p : g.points) p = vector(p);
          },
          shape.geometry);
    }
  }
  for (Joint& joint : scene.joints) {
    std::visit(
        [&](auto& j) {
          if constexpr (requires { j.anchor_a; })
            if (j.body_a != kWorld) j.anchor_a = vector(j.anchor_a);
          if constexpr (requires { j.anchor_b; })
            if (j.body_b != kWorld) j.anchor_b = vector(j.anchor_b);
          if constexpr (requires { j.axis; })
            if (j.body_a != kWorld) j.axis = vector(j.axis);
          if constexpr (requires { j.target_position; })
            if (j.body_a != kWorld) j.target_position = vector(j.target_position);
        },
        joint);
  }
  for (ForceLaw& law : scene.forces) {
    if (auto* spring = std::get_if<SpringForce>(&law)) {
      if (spring->body_a != kWorld) spring->anchor_a = vector(spring->anchor_a);
      if (spring->body_b != kWorld) spring->anchor_b = vector(spring->anchor_b);
    }
    if (auto* pull = std::get_if<AttractionForce>(&law); pull != nullptr && pull->centre_body != kWorld)
      pull->centre = vector(pull->centre);
  }
}

void flip(std::optional<Range>& range) {
  if (range) range = Range{-range->upper, -range->lower};
}

}  // namespace

Case mirrored(Case one) {
  change(one.scene, mirror, mirror);
  change_inside(one.scene, mirror);
  for (Body& body : one.scene.bodies) {
    body.angle = -body.angle, body.angular_velocity = -body.angular_velocity;
    for (Shape& shape : body.shapes) {
      shape.angle = -shape.angle, shape.surface_speed = -shape.surface_speed;
      // The front of a chain is to the right of its direction.
      if (auto* chain = std::get_if<Chain>(&shape.geometry))
        std::reverse(chain->points.begin(), chain->points.end());
    }
  }
  for (Joint& joint : one.scene.joints) {
    std::visit(
        [](auto& j) {
          using JointKind = std::decay_t<decltype(j)>;
          if constexpr (requires { j.reference_angle; }) j.reference_angle = -j.reference_angle;
          if constexpr (requires { j.target_angle; }) j.target_angle = -j.target_angle;
          if constexpr (requires { j.phase; }) j.phase = -j.phase;
          if constexpr (requires { j.tooth; }) j.tooth = -j.tooth;
          if constexpr (std::is_same_v<JointKind, RevoluteJoint>) flip(j.limits);
          if constexpr (std::is_same_v<JointKind, RevoluteJoint> || std::is_same_v<JointKind, WheelJoint>)
            if (j.motor) j.motor->speed = -j.motor->speed;
        },
        joint);
  }
  return one;
}

// The bodies' frames turn too, so that nothing in them changes.
Case turned(Case one) {
  change(one.scene, turn, turn);
  for (Body& body : one.scene.bodies) body.angle += kQuarter;
  for (Joint& joint : one.scene.joints) {
    std::visit(
        [](auto& j) {
          if constexpr (requires { j.reference_angle; }) {
            if (j.body_a == kWorld) j.reference_angle += kQuarter;
            if (j.body_b == kWorld) j.reference_angle -= kQuarter;
          } else if constexpr (requires { j.target_angle; }) {
            if (j.body_a == kWorld) j.target_angle += kQuarter;
          } else if constexpr (requires { j.tooth; }) {
            if (j.body_a == kWorld) j.phase += kQuarter;
          } else if constexpr (requires {
                                 j.ratio;
                                 j.phase;
                               }) {
            j.phase += (j.body_b == kWorld ? 0 : kQuarter) - (j.body_a == kWorld ? 0 : j.ratio * kQuarter);
          }
        },
        joint);
  }
  return one;
}

Case shifted(Case one, Vec2d by) {
  change(
      one.scene, [](Vec2d v) { return v; }, [by](Vec2d p) { return p + by; });
  return one;
}

Case relabelled(Case one) {
  std::reverse(one.scene.bodies.begin(), one.scene.bodies.end());
  std::reverse(one.scene.joints.begin(), one.scene.joints.end());
  for (Body& body : one.scene.bodies) std::reverse(body.shapes.begin(), body.shapes.end());
  return one;
}

Case rescaled(Case one, double length, double time, double mass) {
  const auto lengths = [=](Vec2d v) { return length * v; };
  change(one.scene, lengths, lengths);
  change_inside(one.scene, lengths);
  const double force = mass * length / (time * time), torque = force * length;
  one.dt *= time;
  one.scene.gravity = (1 / (time * time)) * one.scene.gravity;
  for (Body& body : one.scene.bodies) {
    body.velocity = (1 / time) * body.velocity;
    body.angular_velocity /= time;
    body.mass *= mass;
    if (body.inertia) *body.inertia *= mass * length * length;
    body.linear_damping /= time, body.angular_damping /= time;
    for (Shape& shape : body.shapes) {
      shape.surface_speed *= length / time;
      std::visit(
          [&](auto& g) {
            if constexpr (requires { g.radius; }) g.radius *= length;
            if constexpr (requires { g.width; }) g.width *= length, g.height *= length;
          },
          shape.geometry);
    }
  }
  const auto ticks = [&](Spring& spring) { spring.hertz /= time; };
  for (Joint& joint : one.scene.joints) {
    std::visit(
        [&](auto& j) {
          using JointKind = std::decay_t<decltype(j)>;
          constexpr bool kSlides =
              std::is_same_v<JointKind, PrismaticJoint> || std::is_same_v<JointKind, DistanceJoint>;
          // The axis is a unit vector.
          if constexpr (requires { j.axis; }) j.axis = (1 / length) * j.axis;
          if constexpr (requires { j.spring.hertz; }) ticks(j.spring);
          if constexpr (requires { j.spring.reset(); })
            if (j.spring) ticks(*j.spring);
          if constexpr (requires { j.linear_spring; }) {
            if (j.linear_spring) ticks(*j.linear_spring);
            if (j.angular_spring) ticks(*j.angular_spring);
          }
          if constexpr (requires { j.motor; })
            if (j.motor) {
              j.motor->speed *= (kSlides ? length : 1) / time;
              j.motor->max_force *= kSlides ? force : torque;
            }
          if constexpr (requires { j.max_force; }) j.max_force *= force;
          if constexpr (requires { j.max_torque; }) j.max_torque *= torque;
          if constexpr (requires { j.limits; })
            if (!std::is_same_v<JointKind, RevoluteJoint> && j.limits)
              j.limits = Range{j.limits->lower * length, j.limits->upper * length};
          if constexpr (requires { j.range; })
            if (j.range) j.range = Range{j.range->lower * length, j.range->upper * length};
          if constexpr (std::is_same_v<JointKind, DistanceJoint>) j.length *= length;
          if constexpr (requires { j.target_translation; }) j.target_translation *= length;
          if constexpr (std::is_same_v<JointKind, PulleyJoint>)
            if (j.length) *j.length *= length;
          j.break_force *= force, j.break_torque *= torque;
        },
        joint);
  }
  return one;
}

Case perturbed(Case one, double by, std::uint64_t seed) {
  Random random(seed, one.index);
  const std::vector<double> extent = extents(one.scene);
  for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
    Body& body = one.scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    const auto off = [&] { return by * (2 * random.unit() - 1); };
    const double size = extent[i] > 0 ? extent[i] : 1;
    body.position.x += size * off(), body.position.y += size * off();
    body.angle += off();
    body.velocity.x += size * off(), body.velocity.y += size * off();
    if (!body.fixed_rotation) body.angular_velocity += off();
  }
  // Anchors of joints on the world are rounded as well, which changes loops that pass a singular position.
  const double size = largest_size(one.scene);
  for (Joint& joint : one.scene.joints)
    std::visit(
        [&](auto& j) {
          if constexpr (requires { j.anchor_a; })
            if (j.body_a == kWorld)
              j.anchor_a += by * size * Vec2d{2 * random.unit() - 1, 2 * random.unit() - 1};
        },
        joint);
  return one;
}

BodyState mirrored(const BodyState& s) {
  return {mirror(s.position), -s.angle, mirror(s.velocity), -s.angular_velocity};
}
BodyState turned(const BodyState& s) {
  return {
      {s.position.y, -s.position.x}, s.angle - kQuarter, {s.velocity.y, -s.velocity.x}, s.angular_velocity};
}

}  // namespace plumb::harness::hunt
