// Box2D 2.4, float. Masses are the scene's. Features that it lacks are built from existing ones, as the
// settings say.
#include <box2d/box2d.h>

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "bench/field/adapters.h"
#include "engine/scene/error.h"

namespace plumb::field {
namespace {

float narrow(double value) { return static_cast<float>(value); }
b2Vec2 narrow(Vec2d v) { return {narrow(v.x), narrow(v.y)}; }
Vec2d widen(const b2Vec2& v) { return {v.x, v.y}; }
b2Body* body_of(BodyHandle handle) { return reinterpret_cast<b2Body*>(handle.bits); }

b2BodyType type_of(BodyType type) {
  if (type == BodyType::Static) return b2_staticBody;
  return type == BodyType::Kinematic ? b2_kinematicBody : b2_dynamicBody;
}

/// Returns the corners of `polygon` with every edge moved outwards by its radius: sharp, unlike the scene's.
std::vector<Vec2d> grown(const Polygon& polygon) {
  if (polygon.radius == 0) return polygon.points;
  std::vector<Vec2d> out;
  const std::size_t n = polygon.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2d in = polygon.points[i] - polygon.points[(i + n - 1) % n];
    const Vec2d on = polygon.points[(i + 1) % n] - polygon.points[i];
    const Vec2d n0 = (-1 / std::sqrt(length_squared(in))) * perpendicular(in);
    const Vec2d n1 = (-1 / std::sqrt(length_squared(on))) * perpendicular(on);
    // Both moved edges meet along n0 + n1.
    out.push_back(polygon.points[i] + (polygon.radius / (1 + dot(n0, n1))) * (n0 + n1));
  }
  return out;
}

class Box2dWorld final : public FieldWorld {
 public:
  explicit Box2dWorld(const WorldSettings& settings) : settings_(settings), world_(narrow(settings.gravity)) {
    world_.SetAllowSleeping(settings.sleeping);
    world_.SetContinuousPhysics(settings.continuous);
  }

  BodyHandle create_body(const BodyDefinition& body, std::span<const ShapeDefinition> shapes,
                         const MassProperties& mass) override {
    b2BodyDef def;
    def.type = type_of(body.type);
    def.position = narrow(body.position);
    def.angle = narrow(body.angle);
    def.linearVelocity = narrow(body.velocity);
    def.angularVelocity = narrow(body.spin);
    def.linearDamping = narrow(body.linear_damping);
    def.angularDamping = narrow(body.angular_damping);
    def.gravityScale = narrow(body.gravity_scale);
    def.bullet = body.bullet;
    b2Body* out = world_.CreateBody(&def);
    for (const ShapeDefinition& shape : shapes)
      std::visit([&](const auto& geometry) { attach(*out, shape, geometry); }, shape.geometry);
    if (body.type == BodyType::Dynamic) {
      b2MassData data;
      data.mass = narrow(mass.mass);
      data.center = narrow(mass.centre);
      data.I = narrow(mass.inertia + mass.mass * length_squared(mass.centre));  // about the origin
      out->SetMassData(&data);
      out->SetLinearVelocity(narrow(body.velocity));  // of the centre, which has just moved
    }
    return {reinterpret_cast<std::uint64_t>(out)};
  }

  void destroy_body(BodyHandle body) override { world_.DestroyBody(body_of(body)); }

  void create_revolute(BodyHandle a, BodyHandle b, const RevoluteDefinition& joint) override {
    b2RevoluteJointDef def;
    def.bodyA = body_of(a);
    def.bodyB = body_of(b);
    def.localAnchorA = narrow(joint.anchor_a);
    def.localAnchorB = narrow(joint.anchor_b);
    def.referenceAngle = narrow(joint.reference_angle);
    def.collideConnected = joint.collide;
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
    world_.CreateJoint(&def);
  }

  void set_velocity(BodyHandle body, Vec2d velocity, double spin) override {
    body_of(body)->SetLinearVelocity(narrow(velocity));
    body_of(body)->SetAngularVelocity(narrow(spin));
  }

  void step() override {
    world_.Step(narrow(settings_.dt), settings_.velocity_iterations, settings_.position_iterations);
  }

  BodyState state(BodyHandle handle) const override {
    const b2Body& body = *body_of(handle);
    return {widen(body.GetPosition()), body.GetAngle(), widen(body.GetLinearVelocity()),
            body.GetAngularVelocity()};
  }

  Counts counts() const override {
    Counts out{world_.GetBodyCount(), 0, world_.GetJointCount(), 0};
    for (const b2Body* body = world_.GetBodyList(); body != nullptr; body = body->GetNext())
      for (const b2Fixture* fixture = body->GetFixtureList(); fixture != nullptr;
           fixture = fixture->GetNext())
        ++out.shapes;
    for (const b2Contact* contact = world_.GetContactList(); contact != nullptr; contact = contact->GetNext())
      out.touching += contact->IsTouching();
    return out;
  }

  Settings settings() const override {
    const auto number = [](float value) { return fmt::format("{}", value); };
    return {{"precision", "float"},
            {"velocity_iterations", std::to_string(settings_.velocity_iterations)},
            {"position_iterations", std::to_string(settings_.position_iterations)},
            {"continuous", settings_.continuous ? "on" : "off"},
            {"sleeping", settings_.sleeping ? "on" : "off"},
            {"linear_slop", number(b2_linearSlop) + " m"},
            {"polygon_radius", number(b2_polygonRadius) + " m"},
            {"max_translation", number(b2_maxTranslation) + " m a step"},
            {"friction", "geometric mean"},
            {"restitution", "the larger, above 1 m/s"},
            {"capsule", "a box and two circles"},
            {"rounded_polygon", "sharp, grown by the radius"},
            {"angular_spring", "none: left out"},
            {"library", "as Debian builds it, assertions on"}};
  }

 private:
  static void attach(b2Body& body, const ShapeDefinition& shape, const Circle& circle) {
    b2CircleShape geometry;
    geometry.m_p = narrow(circle.centre);
    geometry.m_radius = narrow(circle.radius);
    attach(body, shape, static_cast<const b2Shape&>(geometry));
  }

  static void attach(b2Body& body, const ShapeDefinition& shape, const Capsule& capsule) {
    const Vec2d axis = capsule.b - capsule.a, middle = 0.5 * (capsule.a + capsule.b);
    b2PolygonShape geometry;
    geometry.SetAsBox(narrow(std::sqrt(length_squared(axis)) / 2), narrow(capsule.radius), narrow(middle),
                      narrow(std::atan2(axis.y, axis.x)));
    attach(body, shape, static_cast<const b2Shape&>(geometry));
    attach(body, shape, Circle{capsule.a, capsule.radius});
    attach(body, shape, Circle{capsule.b, capsule.radius});
  }

  static void attach(b2Body& body, const ShapeDefinition& shape, const Polygon& polygon) {
    const std::vector<Vec2d> corners = grown(polygon);
    if (corners.size() > b2_maxPolygonVertices)
      throw Error(Error::Kind::Unsupported, "polygon", "points", std::to_string(corners.size()),
                  "Box2D 2.4 takes " + std::to_string(b2_maxPolygonVertices) + " corners at most");
    b2Vec2 points[b2_maxPolygonVertices];
    for (std::size_t i = 0; i < corners.size(); ++i) points[i] = narrow(corners[i]);
    b2PolygonShape geometry;
    geometry.Set(points, static_cast<int32>(corners.size()));
    attach(body, shape, static_cast<const b2Shape&>(geometry));
  }

  static void attach(b2Body& body, const ShapeDefinition& shape, const Segment& segment) {
    b2EdgeShape geometry;
    geometry.SetTwoSided(narrow(segment.a), narrow(segment.b));
    attach(body, shape, static_cast<const b2Shape&>(geometry));
  }

  static void attach(b2Body& body, const ShapeDefinition& shape, const b2Shape& geometry) {
    b2FixtureDef def;
    def.shape = &geometry;
    def.density = 0;  // the mass is given
    def.friction = narrow(shape.friction);
    def.restitution = narrow(shape.restitution);
    def.filter.groupIndex = static_cast<int16>(-shape.group);
    def.filter.categoryBits = shape.category;
    def.filter.maskBits = shape.mask;
    body.CreateFixture(&def);
  }

  WorldSettings settings_;
  b2World world_;
};

}  // namespace

std::unique_ptr<FieldWorld> create_box2d(const WorldSettings& settings) {
  return std::make_unique<Box2dWorld>(settings);
}

}  // namespace plumb::field
