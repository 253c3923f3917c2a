// Chipmunk 7, double. Masses are the scene's.
#include <chipmunk/chipmunk.h>
#include <chipmunk/chipmunk_structs.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "bench/field/adapters.h"
#include "engine/core/text.h"
#include "reference/support/silence.h"

namespace plumb::field {
namespace {

/// Chipmunk's own default of 0.1 is meant for pixels. This is Box2D's value, in metres.
constexpr double kSlop = 0.005;

cpVect to_chipmunk(Vec2d v) { return {v.x, v.y}; }
Vec2d from_chipmunk(cpVect v) { return {v.x, v.y}; }
cpBody* body_of(BodyHandle handle) { return reinterpret_cast<cpBody*>(handle.bits); }

/// Returns a new space. A debug build of the library prints a banner when a process makes its first one, so
/// that one is made in silence.
cpSpace* new_space() {
  static const bool greeted = [] {
    const reference::Silence silence;
    cpSpaceFree(cpSpaceNew());
    return true;
  }();
  static_cast<void>(greeted);
  return cpSpaceNew();
}

/// Motion parameters of one body.
struct OwnMotion {
  double linear_damping = 0, angular_damping = 0, gravity_scale = 1;
};

/// Applies damping as Box2D does: v / (1 + c dt).
void update_velocity(cpBody* body, cpVect gravity, cpFloat damping, cpFloat dt) {
  const auto& own = *static_cast<const OwnMotion*>(cpBodyGetUserData(body));
  cpBodyUpdateVelocity(body, cpvmult(gravity, own.gravity_scale), damping, dt);
  cpBodySetVelocity(body, cpvmult(cpBodyGetVelocity(body), 1 / (1 + own.linear_damping * dt)));
  cpBodySetAngularVelocity(body, cpBodyGetAngularVelocity(body) / (1 + own.angular_damping * dt));
}

void collect_shape(cpBody*, cpShape* shape, void* out) {
  static_cast<std::vector<cpShape*>*>(out)->push_back(shape);
}
void collect_constraint(cpBody*, cpConstraint* constraint, void* out) {
  static_cast<std::vector<cpConstraint*>*>(out)->push_back(constraint);
}
void collect_body(cpBody* body, void* out) { static_cast<std::vector<cpBody*>*>(out)->push_back(body); }

class ChipmunkWorld final : public FieldWorld {
 public:
  explicit ChipmunkWorld(const WorldSettings& settings) : settings_(settings), space_(new_space()) {
    cpSpaceSetGravity(space_, to_chipmunk(settings.gravity));
    cpSpaceSetIterations(space_, settings.iterations);
    cpSpaceSetCollisionSlop(space_, kSlop);
    if (settings.sleeping) cpSpaceSetSleepTimeThreshold(space_, 0.5);
  }

  ChipmunkWorld(const ChipmunkWorld&) = delete;
  ChipmunkWorld& operator=(const ChipmunkWorld&) = delete;

  ~ChipmunkWorld() override {
    std::vector<cpBody*> bodies;
    cpSpaceEachBody(space_, collect_body, &bodies);
    for (cpBody* body : bodies) remove(body);
    cpSpaceFree(space_);
  }

  BodyHandle create_body(const BodyDefinition& body, std::span<const ShapeDefinition> shapes,
                         const MassProperties& mass) override {
    cpBody* out = new_body(body.type, mass);
    cpBodySetAngle(out, body.angle);
    cpBodySetPosition(out, to_chipmunk(body.position));
    cpSpaceAddBody(space_, out);
    if (body.type != BodyType::Static) {
      cpBodySetVelocity(out, to_chipmunk(body.velocity));
      cpBodySetAngularVelocity(out, body.spin);
    }
    if (body.linear_damping != 0 || body.angular_damping != 0 || body.gravity_scale != 1) {
      cpBodySetUserData(out, new OwnMotion{body.linear_damping, body.angular_damping, body.gravity_scale});
      cpBodySetVelocityUpdateFunc(out, update_velocity);
    }
    for (const ShapeDefinition& shape : shapes) attach(out, shape);
    ++counts_.bodies;
    return {reinterpret_cast<std::uint64_t>(out)};
  }

  void destroy_body(BodyHandle body) override { remove(body_of(body)); }

  void create_revolute(BodyHandle first, BodyHandle second, const RevoluteDefinition& joint) override {
    cpBody *a = body_of(first), *b = body_of(second);
    // Chipmunk aborts on a joint between two bodies that are not dynamic.
    if (cpBodyGetType(a) != CP_BODY_TYPE_DYNAMIC && cpBodyGetType(b) != CP_BODY_TYPE_DYNAMIC) return;
    add(cpPivotJointNew2(a, b, to_chipmunk(joint.anchor_a), to_chipmunk(joint.anchor_b)), joint);
    const double zero = joint.reference_angle;
    if (joint.limits)
      add(cpRotaryLimitJointNew(a, b, zero + joint.limits->lower, zero + joint.limits->upper), joint);
    if (joint.motor) {
      // Its rate is that of a relative to b, hence the minus.
      cpConstraint* motor = add(cpSimpleMotorNew(a, b, -joint.motor->speed), joint);
      const bool unlimited = joint.motor->max_torque >= std::numeric_limits<float>::max();
      cpConstraintSetMaxForce(motor, unlimited ? INFINITY : joint.motor->max_torque);
    }
    if (joint.spring) {
      const auto inverse = [](cpBody* body) {
        return cpBodyGetType(body) == CP_BODY_TYPE_DYNAMIC ? 1 / cpBodyGetMoment(body) : 0.0;
      };
      const double inertia = 1 / (inverse(a) + inverse(b));
      const double omega = 2 * std::numbers::pi * joint.spring->hertz;
      // Its angle is that of a minus that of b.
      add(cpDampedRotarySpringNew(a, b, -zero, inertia * omega * omega,
                                  2 * joint.spring->damping_ratio * inertia * omega),
          joint);
    }
    ++counts_.joints;
  }

  void set_velocity(BodyHandle body, Vec2d velocity, double spin) override {
    cpBodySetVelocity(body_of(body), to_chipmunk(velocity));
    cpBodySetAngularVelocity(body_of(body), spin);
  }

  void step() override { cpSpaceStep(space_, settings_.dt); }

  BodyState state(BodyHandle handle) const override {
    const cpBody* body = body_of(handle);
    return {from_chipmunk(cpBodyGetPosition(body)), cpBodyGetAngle(body),
            from_chipmunk(cpBodyGetVelocity(body)), cpBodyGetAngularVelocity(body)};
  }

  Counts counts() const override {
    Counts out = counts_;
    out.touching = space_->arbiters->num;
    return out;
  }

  Settings settings() const override {
    return {{"precision", "double"},
            {"iterations", std::to_string(settings_.iterations)},
            {"continuous", "none"},
            {"sleeping", settings_.sleeping ? "on, after 0.5 s" : "off"},
            {"collision_slop", shortest(kSlop) + " m (its 0.1 is meant for pixels)"},
            {"collision_bias", "10 % of an overlap in 1/60 s"},
            {"friction", "geometric mean"},
            {"restitution", "product of square roots: below the larger where they differ"},
            {"revolute", "pivot, rotary limit, motor and rotary spring: a constraint each"},
            {"joints_between_static_bodies", "left out"},
            {"library", "as Debian builds it, assertions on"}};
  }

 private:
  static cpBody* new_body(BodyType type, const MassProperties& mass) {
    if (type == BodyType::Static) return cpBodyNewStatic();
    if (type == BodyType::Kinematic) return cpBodyNewKinematic();
    cpBody* out = cpBodyNew(mass.mass, mass.inertia);
    cpBodySetCenterOfGravity(out, to_chipmunk(mass.centre));
    return out;
  }

  static cpShape* new_shape(cpBody* body, const Circle& circle) {
    return cpCircleShapeNew(body, circle.radius, to_chipmunk(circle.centre));
  }
  static cpShape* new_shape(cpBody* body, const Capsule& capsule) {
    return cpSegmentShapeNew(body, to_chipmunk(capsule.a), to_chipmunk(capsule.b), capsule.radius);
  }
  static cpShape* new_shape(cpBody* body, const Segment& segment) {
    return cpSegmentShapeNew(body, to_chipmunk(segment.a), to_chipmunk(segment.b), 0);
  }
  static cpShape* new_shape(cpBody* body, const Polygon& polygon) {
    std::vector<cpVect> points;
    for (const Vec2d p : polygon.points) points.push_back(to_chipmunk(p));
    return cpPolyShapeNewRaw(body, static_cast<int>(points.size()), points.data(), polygon.radius);
  }

  void attach(cpBody* body, const ShapeDefinition& definition) {
    cpShape* shape =
        std::visit([&](const auto& geometry) { return new_shape(body, geometry); }, definition.geometry);
    cpShapeSetFriction(shape, std::sqrt(definition.friction));
    cpShapeSetElasticity(shape, std::sqrt(definition.restitution));
    cpShapeSetFilter(shape, cpShapeFilterNew(static_cast<cpGroup>(definition.group), definition.category,
                                             definition.mask));
    cpSpaceAddShape(space_, shape);
    ++counts_.shapes;
  }

  cpConstraint* add(cpConstraint* constraint, const RevoluteDefinition& joint) {
    cpConstraintSetCollideBodies(constraint, joint.collide ? cpTrue : cpFalse);
    return cpSpaceAddConstraint(space_, constraint);
  }

  void remove(cpBody* body) {
    std::vector<cpConstraint*> constraints;
    cpBodyEachConstraint(body, collect_constraint, &constraints);
    for (cpConstraint* constraint : constraints) {
      counts_.joints -= cpConstraintIsPivotJoint(constraint) == cpTrue;
      cpSpaceRemoveConstraint(space_, constraint);
      cpConstraintFree(constraint);
    }
    std::vector<cpShape*> shapes;
    cpBodyEachShape(body, collect_shape, &shapes);
    for (cpShape* shape : shapes) {
      cpSpaceRemoveShape(space_, shape);
      cpShapeFree(shape);
      --counts_.shapes;
    }
    delete static_cast<OwnMotion*>(cpBodyGetUserData(body));
    cpSpaceRemoveBody(space_, body);
    cpBodyFree(body);
    --counts_.bodies;
  }

  WorldSettings settings_;
  cpSpace* space_;
  Counts counts_;
};

}  // namespace

std::string chipmunk_version() { return cpVersionString; }

std::unique_ptr<FieldWorld> create_chipmunk(const WorldSettings& settings) {
  return std::make_unique<ChipmunkWorld>(settings);
}

}  // namespace plumb::field
