// plumb's own world, float, through its public interface. Masses are the scene's.
#include <algorithm>
#include <memory>
#include <string>

#include "bench/field/adapters.h"
#include "engine/world/world.h"

namespace plumb::field {
namespace {

/// Largest torque that a joint of plumb accepts, N m; stands for no limit.
constexpr double kUnlimited = 1e15;

plumb::BodyType type_of(BodyType type) {
  if (type == BodyType::Static) return plumb::BodyType::Static;
  return type == BodyType::Kinematic ? plumb::BodyType::Kinematic : plumb::BodyType::Dynamic;
}

plumb::ShapeDefinition definition_of(const ShapeDefinition& shape) {
  struct Translate {
    plumb::ShapeDefinition& out;
    void operator()(const Circle& circle) const {
      out.geometry = plumb::Circle{circle.radius};
      out.position = circle.centre;
    }
    void operator()(const Capsule& capsule) const {
      out.geometry = plumb::Capsule{capsule.a, capsule.b, capsule.radius};
    }
    void operator()(const Polygon& polygon) const {
      out.geometry = plumb::Polygon{polygon.points, polygon.radius};
    }
    void operator()(const Segment& segment) const { out.geometry = plumb::Segment{segment.a, segment.b}; }
  };
  plumb::ShapeDefinition out;
  std::visit(Translate{out}, shape.geometry);
  out.density = shape.density;
  out.material.friction = shape.friction;
  out.material.restitution = shape.restitution;
  out.filter = {.category = shape.category, .mask = shape.mask, .group = -shape.group};
  return out;
}

BodyId body_of(BodyHandle handle) {
  return {static_cast<std::uint32_t>(handle.bits), static_cast<std::uint32_t>(handle.bits >> 32)};
}

BodyHandle handle_of(BodyId body) { return {std::uint64_t{body.generation} << 32 | body.index}; }

class PlumbWorld final : public FieldWorld {
 public:
  explicit PlumbWorld(const WorldSettings& settings)
      : settings_(settings),
        world_({.gravity = settings.gravity,
                .combine_friction = Combine::GeometricMean,
                .combine_restitution = Combine::Maximum,
                .sleeping = settings.sleeping,
                .continuous = settings.continuous,
                .solver = solver_of(settings.solver).value_or(Solver::SoftSteps),
                .iterations = settings.iterations,
                .quarantine = false,
                .threads = settings.threads}) {
    world_.set_profiling(settings.profiling);
  }

  BodyHandle create_body(const BodyDefinition& body, std::span<const ShapeDefinition> shapes,
                         const MassProperties& mass) override {
    plumb::BodyDefinition out;
    out.type = type_of(body.type);
    out.position = body.position;
    out.angle = body.angle;
    out.velocity = body.velocity;
    out.angular_velocity = body.spin;
    out.gravity_scale = body.gravity_scale;
    out.linear_damping = body.linear_damping;
    out.angular_damping = body.angular_damping;
    if (body.type == BodyType::Dynamic)
      out.mass = plumb::MassProperties{mass.mass, mass.centre, mass.inertia};
    std::vector<plumb::ShapeDefinition> attached;
    attached.reserve(shapes.size());
    for (const ShapeDefinition& shape : shapes) attached.push_back(definition_of(shape));
    return handle_of(world_.create_body(out, attached));
  }

  void destroy_body(BodyHandle body) override { world_.destroy(body_of(body)); }

  void create_revolute(BodyHandle a, BodyHandle b, const RevoluteDefinition& joint) override {
    // plumb rejects a joint between two bodies that are not dynamic.
    if (world_.type(body_of(a)) != plumb::BodyType::Dynamic &&
        world_.type(body_of(b)) != plumb::BodyType::Dynamic)
      return;
    plumb::RevoluteDefinition out;
    out.anchor_a = joint.anchor_a;
    out.anchor_b = joint.anchor_b;
    out.reference_angle = joint.reference_angle;
    if (joint.limits) out.limits = Range{joint.limits->lower, joint.limits->upper};
    if (joint.motor)
      out.motor = plumb::Motor{joint.motor->speed, std::min(joint.motor->max_torque, kUnlimited)};
    if (joint.spring) out.spring = Spring{joint.spring->hertz, joint.spring->damping_ratio};
    world_.create_joint(body_of(a), body_of(b), {.kind = out, .collide = joint.collide});
  }

  void set_velocity(BodyHandle body, Vec2d velocity, double spin) override {
    world_.set_velocity(body_of(body), velocity);
    world_.set_angular_velocity(body_of(body), spin);
  }

  void step() override { world_.step(settings_.dt, settings_.substeps); }

  BodyState state(BodyHandle handle) const override {
    const BodyId body = body_of(handle);
    return {world_.position(body), world_.angle(body), world_.velocity(body), world_.angular_velocity(body)};
  }

  Counts counts() const override {
    const WorldCounts counts = world_.counts();
    return {counts.bodies, counts.shapes, counts.joints, counts.touching};
  }

  Settings settings() const override {
    return {{"precision", "float, positions double"},
            {"substeps", std::to_string(settings_.substeps)},
            {"solver", name_of(world_.solver())},
            {"iterations", sweeps() ? std::to_string(settings_.iterations) : "none"},
            {"continuous", settings_.continuous ? "on" : "off"},
            {"sleeping", settings_.sleeping ? "on" : "off"},
            {"threads", std::to_string(settings_.threads)},
            {"friction", "geometric mean"},
            {"restitution", "the larger"},
            {"joints_between_static_bodies", "left out"}};
  }

  StageTimes profile() const override {
    const WorldProfile& found = world_.profile();
    StageTimes out;
    for (std::size_t i = 0; i < kWorldStages && found.steps > 0; ++i)
      out.emplace_back(kWorldStageNames[i], found.nanoseconds[i] / static_cast<double>(found.steps));
    return out;
  }
  void restart_profile() override { world_.set_profiling(settings_.profiling); }

 private:
  bool sweeps() const {
    return world_.solver() == Solver::SequentialImpulses || world_.solver() == Solver::Jakobsen;
  }

  WorldSettings settings_;
  World world_;
};

}  // namespace

std::vector<std::string> plumb_solvers() { return {std::begin(kSolverNames), std::end(kSolverNames)}; }

std::unique_ptr<FieldWorld> create_plumb(const WorldSettings& settings) {
  return std::make_unique<PlumbWorld>(settings);
}

}  // namespace plumb::field
