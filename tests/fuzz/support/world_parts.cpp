#include "tests/fuzz/support/world_parts.h"

namespace plumb::fuzz {
namespace {

constexpr double kReach = 12;  // m, of where bodies begin

std::optional<Spring> draw_spring(ByteSource& in) {
  if (!in.flag()) return std::nullopt;
  const double hertz = in.number(0.2, 20);
  return Spring{hertz, in.number(0, 2)};
}

std::optional<Range> draw_range(ByteSource& in, double lowest, double highest) {
  if (!in.flag()) return std::nullopt;
  const double lower = in.number(lowest, highest);
  return Range{lower, lower + in.number(0, highest)};
}

std::optional<Motor> draw_motor(ByteSource& in) {
  if (!in.flag()) return std::nullopt;
  const double speed = in.number(-10, 10);
  return Motor{speed, in.number(0, 200)};
}

// Anchors and reference angles by which bodies that lie apart are pulled together.
template <class Joint>
Joint anchored(ByteSource& in) {
  Joint joint;
  joint.anchor_a = in.vector(1);
  joint.anchor_b = in.vector(1);
  return joint;
}

DistanceDefinition draw_distance(ByteSource& in) {
  auto joint = anchored<DistanceDefinition>(in);
  joint.length = in.number(0.1, 4);
  joint.spring = draw_spring(in);
  joint.range = draw_range(in, 0, 4);
  joint.motor = draw_motor(in);
  return joint;
}

RevoluteDefinition draw_revolute(ByteSource& in) {
  auto joint = anchored<RevoluteDefinition>(in);
  joint.reference_angle = in.number(-3, 3);
  joint.limits = draw_range(in, -2, 2);
  joint.motor = draw_motor(in);
  joint.spring = draw_spring(in);
  joint.target_angle = in.number(-3, 3);
  return joint;
}

PrismaticDefinition draw_prismatic(ByteSource& in) {
  auto joint = anchored<PrismaticDefinition>(in);
  joint.axis = {in.number(0.1, 1), in.number(-1, 1)};
  joint.limits = draw_range(in, -2, 2);
  joint.motor = draw_motor(in);
  joint.spring = draw_spring(in);
  joint.target_translation = in.number(-1, 1);
  return joint;
}

WeldDefinition draw_weld(ByteSource& in) {
  auto joint = anchored<WeldDefinition>(in);
  joint.reference_angle = in.number(-3, 3);
  joint.linear_spring = draw_spring(in);
  joint.angular_spring = draw_spring(in);
  return joint;
}

WheelDefinition draw_wheel(ByteSource& in) {
  auto joint = anchored<WheelDefinition>(in);
  joint.axis = {in.number(-1, 1), in.number(0.1, 1)};
  joint.spring = draw_spring(in);
  joint.limits = draw_range(in, -1, 1);
  joint.motor = draw_motor(in);
  return joint;
}

PulleyDefinition draw_pulley(ByteSource& in) {
  auto joint = anchored<PulleyDefinition>(in);
  joint.ground_a = in.vector(kReach);
  joint.ground_b = in.vector(kReach);
  joint.ratio = in.number(0.2, 3);
  if (in.flag()) joint.length = in.number(0.5, 20);
  return joint;
}

Polygon draw_polygon(ByteSource& in) {
  Polygon polygon;
  const int count = 3 + in.below(6);
  for (int i = 0; i < count; ++i) polygon.points.push_back(in.vector(0.8));
  polygon.radius = in.flag() ? in.number(0, 0.2) : 0.05;
  return polygon;
}

}  // namespace

WorldDefinition draw_world(ByteSource& in) {
  return {.gravity = in.flag() ? in.vector(20) : Vec2d{0, -9.81},
          .combine_friction = static_cast<Combine>(in.below(5)),
          .combine_restitution = static_cast<Combine>(in.below(5)),
          .sleeping = in.flag(),
          .continuous = in.flag(),
          .solver = static_cast<Solver>(in.below(static_cast<int>(std::size(kSolverNames)))),
          .iterations = 1 + in.below(12),
          .direct_islands = in.flag(),
          .quarantine = in.below(8) < 7};
}

MassProperties draw_mass(ByteSource& in) { return {in.number(0.1, 50), in.vector(0.3), in.number(0.01, 20)}; }

BodyDefinition draw_body(ByteSource& in) {
  BodyDefinition body;
  const int kind = in.byte();
  body.type = kind % 8 == 0 ? BodyType::Static : kind % 8 == 1 ? BodyType::Kinematic : BodyType::Dynamic;
  body.position = in.vector(kReach);
  if (kind & 8) body.angle = in.number(-7, 7);
  if (kind & 16) body.velocity = in.vector(30), body.angular_velocity = in.number(-20, 20);
  if (kind & 32) {
    body.gravity_scale = in.number(-1, 2);
    body.linear_damping = in.number(0, 5);
    body.angular_damping = in.number(0, 5);
  }
  if (kind & 64) {
    const int locks = in.byte();
    body.lock_x = locks & 1, body.lock_y = locks & 2, body.lock_rotation = locks & 4;
    body.may_sleep = locks & 8, body.awake = locks & 16;
    if (locks & 32) body.mass = draw_mass(in);
    if (locks & 64) body.name = "body " + std::to_string(locks);
  }
  body.user_data = static_cast<std::uint64_t>(kind);
  return body;
}

Material draw_material(ByteSource& in) {
  Material material;
  const int kind = in.byte();
  if (kind & 1) material.friction = in.number(0, 2);
  if (kind & 2) material.restitution = in.number(0, 1);
  if (kind & 4) material.rolling_resistance = in.number(0, 0.5);
  if (kind & 8) material.surface_speed = in.number(-5, 5);
  return material;
}

Filter draw_filter(ByteSource& in) {
  const std::uint32_t category = 1u << in.below(3);
  return {category, in.flag() ? 0xFFFFFFFFu : in.byte(), in.below(5) - 2};
}

ShapeGeometry draw_geometry(ByteSource& in) {
  switch (in.below(6)) {
    case 0:
      return Circle{in.number(0.15, 0.8)};
    case 1:
      return Box{in.number(0.2, 1.5), in.number(0.2, 1.5)};
    case 2:
      return Capsule{in.vector(0.7), in.vector(0.7), in.number(0.1, 0.5)};
    case 3:
      return draw_polygon(in);
    case 4:
      return Segment{in.vector(4), in.vector(4)};
    default:
      return Box{in.number(5, 30), in.number(0.1, 2)};
  }
}

ShapeDefinition draw_shape(ByteSource& in) {
  ShapeDefinition shape;
  shape.geometry = draw_geometry(in);
  const int kind = in.byte();
  if (kind & 1) shape.position = in.vector(1);
  if (kind & 2) shape.angle = in.number(-4, 4);
  if (kind & 4) shape.density = in.number(0.5, 4);
  if (kind & 8) shape.material = draw_material(in);
  if (kind & 16) shape.filter = draw_filter(in);
  shape.sensor = (kind & 224) == 224;
  shape.hit_events = kind & 32;
  shape.pre_solve = kind & 64;
  shape.user_data = static_cast<std::uint64_t>(kind);
  return shape;
}

ChainDefinition draw_chain(ByteSource& in) {
  ChainDefinition chain;
  const int count = 2 + in.below(7);
  for (int i = 0; i < count; ++i) chain.points.push_back(in.vector(kReach));
  chain.closed = in.flag();
  chain.material = draw_material(in);
  return chain;
}

JointKind draw_joint_kind(ByteSource& in, int kind) {
  switch (kind) {
    case 0:
      return draw_distance(in);
    case 1:
      return draw_revolute(in);
    case 2:
      return draw_prismatic(in);
    case 3:
      return draw_weld(in);
    case 4:
      return draw_wheel(in);
    case 5:
      return MotorDefinition{in.vector(2),
                             in.number(-3, 3),
                             in.number(0, 500),
                             in.number(0, 100),
                             {in.number(0.5, 10), in.number(0, 2)}};
    case 6:
      return MouseDefinition{
          in.vector(0.5), in.vector(kReach), {in.number(0.5, 10), in.number(0, 2)}, in.number(0, 1000)};
    case 7:
      return GearDefinition{in.number(-4, 4), in.number(-3, 3)};
    case 8:
      return draw_pulley(in);
    case 9:
      return RatchetDefinition{in.number(-0.5, 0.5), in.number(-1, 1)};
    default: {
      auto joint = anchored<FrictionDefinition>(in);
      joint.max_force = in.number(0, 100);
      joint.max_torque = in.number(0, 100);
      return joint;
    }
  }
}

JointDefinition draw_joint(ByteSource& in) {
  JointDefinition joint;
  const int kind = in.byte();
  joint.kind = draw_joint_kind(in, kind % static_cast<int>(std::variant_size_v<JointKind>));
  const int more = in.byte();
  joint.collide = more & 1;
  if (more & 2) joint.break_force = in.number(0, 500);
  if (more & 4) joint.break_torque = in.number(0, 500);
  return joint;
}

}  // namespace plumb::fuzz
