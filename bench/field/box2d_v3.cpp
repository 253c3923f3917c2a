// Box2D 3, float: soft contacts and joints in substeps. Masses are the scene's. Supports all shapes and
// joints of the scenes except polygons of more than eight corners.
#include <box2d/box2d.h>

#include <cstring>

#include "bench/field/adapters.h"
#include "engine/scene/error.h"

namespace plumb::field {
namespace {

float narrow(double value) { return static_cast<float>(value); }
b2Vec2 narrow(Vec2d v) { return {narrow(v.x), narrow(v.y)}; }
Vec2d widen(auto v) { return {static_cast<double>(v.x), static_cast<double>(v.y)}; }

static_assert(sizeof(b2BodyId) == sizeof(BodyHandle::bits));
b2BodyId body_of(BodyHandle handle) {
  b2BodyId out;
  std::memcpy(&out, &handle.bits, sizeof out);
  return out;
}
BodyHandle handle_of(b2BodyId body) {
  BodyHandle out;
  std::memcpy(&out.bits, &body, sizeof body);
  return out;
}

b2BodyType type_of(BodyType type) {
  if (type == BodyType::Static) return b2_staticBody;
  return type == BodyType::Kinematic ? b2_kinematicBody : b2_dynamicBody;
}

class Box2dV3World final : public FieldWorld {
 public:
  explicit Box2dV3World(const WorldSettings& settings) : settings_(settings) {
    b2WorldDef def = b2DefaultWorldDef();
    def.gravity = narrow(settings.gravity);
    def.enableSleep = settings.sleeping;
    def.enableContinuous = settings.continuous;
    world_ = b2CreateWorld(&def);
  }
  Box2dV3World(const Box2dV3World&) = delete;
  Box2dV3World& operator=(const Box2dV3World&) = delete;
  ~Box2dV3World() override { b2DestroyWorld(world_); }

  BodyHandle create_body(const BodyDefinition& body, std::span<const ShapeDefinition> shapes,
                         const MassProperties& mass) override {
    b2BodyDef def = b2DefaultBodyDef();
    def.type = type_of(body.type);
    def.position = {narrow(body.position.x), narrow(body.position.y)};
    def.rotation = b2MakeRot(narrow(body.angle));
    def.linearVelocity = narrow(body.velocity);
    def.angularVelocity = narrow(body.spin);
    def.linearDamping = narrow(body.linear_damping);
    def.angularDamping = narrow(body.angular_damping);
    def.gravityScale = narrow(body.gravity_scale);
    def.isBullet = body.bullet;
    const b2BodyId out = b2CreateBody(world_, &def);
    for (const ShapeDefinition& shape : shapes)
      std::visit([&](const auto& geometry) { attach(out, shape, geometry); }, shape.geometry);
    if (body.type == BodyType::Dynamic) {
      b2Body_ApplyMassFromShapes(out);  // sets its extents, which the next call keeps
      b2MassData data{};
      data.mass = narrow(mass.mass);
      data.center = narrow(mass.centre);
      data.rotationalInertia = narrow(mass.inertia);  // about the centre
      b2Body_SetMassData(out, data);
      b2Body_SetLinearVelocity(out, narrow(body.velocity));  // of the centre, which has just moved
    }
    bodies_.push_back(out);
    return handle_of(out);
  }

  void destroy_body(BodyHandle body) override { b2DestroyBody(body_of(body)); }

  void create_revolute(BodyHandle a, BodyHandle b, const RevoluteDefinition& joint) override {
    b2RevoluteJointDef def = b2DefaultRevoluteJointDef();
    set_ends(def, body_of(a), body_of(b), joint);
    if (joint.limits) {
      def.enableLimit = true;
      def.lowerAngle = narrow(joint.limits->lower);
      def.upperAngle = narrow(joint.limits->upper);
    }
    if (joint.motor) {
      def.enableMotor = true;
      def.motorSpeed = narrow(joint.motor->speed);
      def.maxMotorTorque = narrow(joint.motor->max_torque);
    }
    if (joint.spring) {
      def.enableSpring = true;
      def.hertz = narrow(joint.spring->hertz);
      def.dampingRatio = narrow(joint.spring->damping_ratio);
    }
    b2CreateRevoluteJoint(world_, &def);
  }

  void set_velocity(BodyHandle body, Vec2d velocity, double spin) override {
    b2Body_SetLinearVelocity(body_of(body), narrow(velocity));
    b2Body_SetAngularVelocity(body_of(body), narrow(spin));
  }

  void step() override { b2World_Step(world_, narrow(settings_.dt), settings_.substeps); }

  BodyState state(BodyHandle handle) const override {
    const b2BodyId body = body_of(handle);
    return {widen(b2Body_GetPosition(body)), static_cast<double>(b2Rot_GetAngle(b2Body_GetRotation(body))),
            widen(b2Body_GetLinearVelocity(body)), static_cast<double>(b2Body_GetAngularVelocity(body))};
  }

  Counts counts() const override {
    const b2Counters found = b2World_GetCounters(world_);
    int touching = 0;  // each contact is in the list of both of its bodies
    std::vector<b2ContactData> contacts;
    for (const b2BodyId body : bodies_) {
      if (!b2Body_IsValid(body)) continue;
      contacts.resize(static_cast<std::size_t>(b2Body_GetContactCapacity(body)));
      touching += b2Body_GetContactData(body, contacts.data(), static_cast<int>(contacts.size()));
    }
    return {found.bodyCount, found.shapeCount, found.jointCount, touching / 2};
  }

  Settings settings() const override {
    return {{"precision", "float"},
            {"substeps", std::to_string(settings_.substeps)},
            {"continuous", settings_.continuous ? "on" : "off"},
            {"sleeping", settings_.sleeping ? "on" : "off"},
            {"max_speed", "400 m/s"},
            {"friction", "geometric mean"},
            {"restitution", "the larger, above 1 m/s"}};
  }

 private:
  // Since 3.2 the ends are in a base, and the reference angle is a rotation of the first frame.
  template <class Def>
  static void set_ends(Def& def, b2BodyId a, b2BodyId b, const RevoluteDefinition& joint) {
    if constexpr (requires { def.base; }) {
      def.base.bodyIdA = a, def.base.bodyIdB = b;
      def.base.localFrameA = {narrow(joint.anchor_a), b2MakeRot(narrow(joint.reference_angle))};
      def.base.localFrameB.p = narrow(joint.anchor_b);
      def.base.collideConnected = joint.collide;
    } else {
      def.bodyIdA = a, def.bodyIdB = b;
      def.localAnchorA = narrow(joint.anchor_a), def.localAnchorB = narrow(joint.anchor_b);
      def.referenceAngle = narrow(joint.reference_angle);
      def.collideConnected = joint.collide;
    }
  }

  static b2ShapeDef definition_of(const ShapeDefinition& shape) {
    b2ShapeDef def = b2DefaultShapeDef();
    def.density = narrow(shape.density);
    def.updateBodyMass = false;  // once, when all shapes exist
    def.material.friction = narrow(shape.friction);
    def.material.restitution = narrow(shape.restitution);
    def.filter.categoryBits = shape.category;
    def.filter.maskBits = shape.mask;
    def.filter.groupIndex = -shape.group;
    return def;
  }
  static void attach(b2BodyId body, const ShapeDefinition& shape, const Circle& circle) {
    const b2ShapeDef def = definition_of(shape);
    const b2Circle geometry{narrow(circle.centre), narrow(circle.radius)};
    b2CreateCircleShape(body, &def, &geometry);
  }
  static void attach(b2BodyId body, const ShapeDefinition& shape, const Capsule& capsule) {
    const b2ShapeDef def = definition_of(shape);
    const b2Capsule geometry{narrow(capsule.a), narrow(capsule.b), narrow(capsule.radius)};
    b2CreateCapsuleShape(body, &def, &geometry);
  }
  static void attach(b2BodyId body, const ShapeDefinition& shape, const Segment& segment) {
    const b2ShapeDef def = definition_of(shape);
    const b2Segment geometry{narrow(segment.a), narrow(segment.b)};
    b2CreateSegmentShape(body, &def, &geometry);
  }
  static void attach(b2BodyId body, const ShapeDefinition& shape, const Polygon& polygon) {
    const std::size_t count = polygon.points.size();
    if (count > B2_MAX_POLYGON_VERTICES)
      throw Error(Error::Kind::Unsupported, "polygon", "points", std::to_string(count),
                  "Box2D 3 takes " + std::to_string(B2_MAX_POLYGON_VERTICES) + " corners at most");
    b2Vec2 points[B2_MAX_POLYGON_VERTICES];
    for (std::size_t i = 0; i < count; ++i) points[i] = narrow(polygon.points[i]);
    const b2ShapeDef def = definition_of(shape);
    const b2Hull hull = b2ComputeHull(points, static_cast<int>(count));
    const b2Polygon geometry = b2MakePolygon(&hull, narrow(polygon.radius));
    b2CreatePolygonShape(body, &def, &geometry);
  }

  WorldSettings settings_;
  b2WorldId world_{};
  std::vector<b2BodyId> bodies_;
};

}  // namespace

std::unique_ptr<FieldWorld> create_box2d_v3(const WorldSettings& settings) {
  return std::make_unique<Box2dV3World>(settings);
}

}  // namespace plumb::field
