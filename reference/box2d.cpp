//! cmake: include(box2d/libraries.cmake)
//! cmake: set_property(SOURCE ${file} PROPERTY COMPILE_DEFINITIONS PLUMB_BOX2D_VERSION="${box2d_VERSION}")
//! link: box2d::box2d
//! missing: Box2D 2.4 was not found; install libbox2d-dev and build again

// Box2D 2.4 in float. The scene's contact rules replace its own. Compiled-in constants (slop, skin, clamps)
// are printed among the effective settings.
#include <box2d/box2d.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/text.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "engine/scene/features.h"
#include "reference/backend.h"
#include "reference/box2d/joints.h"
#include "reference/support/applied_forces.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

constexpr const char* kName = "box2d";

Vec2d from_box2d(const b2Vec2& v) { return {v.x, v.y}; }

/// `StepSettings` with this engine's options read.
struct Box2dSettings {
  int substeps = 1;
  float substep = 0;
  double exact_substep = 0;
  int velocity_iterations = 8;
  int position_iterations = 3;
  bool continuous = true;
};

/// Applies the scene's rules instead of Box2D's: which shapes touch, and with which coefficients.
class ContactRulesOfScene final : public b2ContactFilter, public b2ContactListener {
 public:
  explicit ContactRulesOfScene(const ContactRules& rules) : rules_(rules) {}

  bool ShouldCollide(b2Fixture* a, b2Fixture* b) override {
    return may_touch(shape_of(a).filter, shape_of(b).filter);
  }

  // Sets the scene's friction and restitution; Box2D keeps them until the shapes separate.
  void BeginContact(b2Contact* contact) override {
    const Shape& a = shape_of(contact->GetFixtureA());
    const Shape& b = shape_of(contact->GetFixtureB());
    contact->SetFriction(static_cast<float>(combine(rules_.friction, a.friction, b.friction)));
    contact->SetRestitution(static_cast<float>(combine(rules_.restitution, a.restitution, b.restitution)));
  }

 private:
  static const Shape& shape_of(b2Fixture* fixture) {
    return *reinterpret_cast<const Shape*>(fixture->GetUserData().pointer);
  }

  ContactRules rules_;
};

class Box2dSimulator final : public Simulator {
 public:
  Box2dSimulator(const Scene& scene, const Box2dSettings& settings)
      : scene_(scene),
        settings_(settings),
        rules_(scene_.contact_rules),
        world_(to_box2d(scene_.gravity)),
        forces_(scene_) {
    world_.SetAllowSleeping(false);
    world_.SetContinuousPhysics(settings_.continuous);
    world_.SetContactFilter(&rules_);
    world_.SetContactListener(&rules_);
    for (const Body& body : scene_.bodies) bodies_.push_back(add_body(body));
    const auto called = [this](const std::string& name) { return body_called(name); };
    Box2dJointMaker(world_, scene_, called).make_all();
  }

  double advance(int steps) override {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps * settings_.substeps; ++i) {
      apply_forces();
      world_.Step(settings_.substep, settings_.velocity_iterations, settings_.position_iterations);
      ++substeps_done_;
    }
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }

  double time() const override { return static_cast<double>(substeps_done_) * settings_.exact_substep; }

  void read(std::span<BodyState> out) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) out[i] = state_of(*bodies_[i]);
  }

 private:
  // The sweep's angle is not wrapped.
  static BodyState state_of(const b2Body& body) {
    return {.position = from_box2d(body.GetWorldCenter()),
            .angle = body.GetAngle(),
            .velocity = from_box2d(body.GetLinearVelocity()),
            .angular_velocity = body.GetAngularVelocity()};
  }

  b2Body* add_body(const Body& body) {
    b2BodyDef def;
    def.type = body.type == BodyType::Static      ? b2_staticBody
               : body.type == BodyType::Kinematic ? b2_kinematicBody
                                                  : b2_dynamicBody;
    def.position = to_box2d(body.position);
    def.angle = static_cast<float>(body.angle);
    def.linearVelocity = to_box2d(body.velocity);
    def.angularVelocity = static_cast<float>(body.angular_velocity);
    def.allowSleep = false;
    def.fixedRotation = body.fixed_rotation;
    def.gravityScale = static_cast<float>(body.gravity_scale);
    def.linearDamping = static_cast<float>(body.linear_damping);
    def.angularDamping = static_cast<float>(body.angular_damping);
    b2Body* out = world_.CreateBody(&def);
    for (const Shape& shape : body.shapes) add_shape(*out, shape);
    if (body.type == BodyType::Dynamic) {
      b2MassData mass;
      mass.mass = static_cast<float>(body.mass);
      mass.center.SetZero();
      mass.I = static_cast<float>(inertia_of(body));
      out->SetMassData(&mass);
    }
    return out;
  }

  void add_shape(b2Body& body, const Shape& shape) {
    std::visit([&](const auto& geometry) { add_geometry(body, shape, geometry); }, shape.geometry);
  }

  void add_fixture(b2Body& body, const Shape& shape, const b2Shape& geometry) {
    b2FixtureDef def;
    def.shape = &geometry;
    def.density = 0;  // the scene states the mass
    def.restitutionThreshold = static_cast<float>(scene_.contact_rules.restitution_threshold);
    def.userData.pointer = reinterpret_cast<std::uintptr_t>(&shape);
    body.CreateFixture(&def);
  }

  void add_geometry(b2Body& body, const Shape& shape, const Circle& round) {
    b2CircleShape circle;
    circle.m_radius = static_cast<float>(round.radius);
    circle.m_p = to_box2d(shape.position);
    add_fixture(body, shape, circle);
  }

  void add_geometry(b2Body& body, const Shape& shape, const Box& box) {
    b2PolygonShape polygon;
    polygon.SetAsBox(static_cast<float>(box.width / 2), static_cast<float>(box.height / 2),
                     to_box2d(shape.position), static_cast<float>(shape.angle));
    add_fixture(body, shape, polygon);
  }

  void add_geometry(b2Body& body, const Shape& shape, const Polygon& polygon) {
    const std::vector<b2Vec2> corners = placed(shape, convex_corners(polygon.points));
    b2PolygonShape out;
    out.Set(corners.data(), static_cast<int>(corners.size()));
    add_fixture(body, shape, out);
  }

  void add_geometry(b2Body& body, const Shape& shape, const Segment& segment) {
    const std::vector<b2Vec2> ends = placed(shape, {segment.start, segment.end});
    b2EdgeShape edge;
    edge.SetTwoSided(ends[0], ends[1]);
    add_fixture(body, shape, edge);
  }

  void add_geometry(b2Body& body, const Shape& shape, const Chain& chain) {
    const std::vector<b2Vec2> points = placed(shape, chain.points);
    const int count = static_cast<int>(points.size());
    b2ChainShape out;
    if (chain.closed) {
      out.CreateLoop(points.data(), count);
    } else {  // continues straight at both ends
      const b2Vec2 before = 2 * points[0] - points[1], after = 2 * points[count - 1] - points[count - 2];
      out.CreateChain(points.data(), count, before, after);
    }
    add_fixture(body, shape, out);
  }

  void add_geometry(b2Body&, const Shape&, const Capsule&) {}  // refused

  static std::vector<b2Vec2> placed(const Shape& shape, const std::vector<Vec2d>& points) {
    const Rotation<double> turn = rotation_of(shape.angle);
    std::vector<b2Vec2> out;
    for (const Vec2d point : points) out.push_back(to_box2d(shape.position + turn * point));
    return out;
  }

  b2Body* body_called(const std::string& name) {
    if (const auto index = find_body(scene_, name)) return bodies_[*index];
    if (fixed_frame_ == nullptr) {
      const b2BodyDef at_origin;
      fixed_frame_ = world_.CreateBody(&at_origin);
    }
    return fixed_frame_;
  }

  // Evaluates forces at the step's start and keeps them constant during the step, as users of Box2D do.
  void apply_forces() {
    const double start = time(), end = static_cast<double>(substeps_done_ + 1) * settings_.exact_substep;
    forces_.apply(
        start, end, [&](std::size_t body) { return state_of(*bodies_[body]); },
        [&](std::size_t body, const Wrench<double>& wrench) {
          bodies_[body]->ApplyForceToCenter(to_box2d(wrench.force), true);
          bodies_[body]->ApplyTorque(static_cast<float>(wrench.torque), true);
        });
  }

  Scene scene_;  // fixtures point at its shapes
  Box2dSettings settings_;
  ContactRulesOfScene rules_;
  b2World world_;
  AppliedForces forces_;
  std::vector<b2Body*> bodies_;
  b2Body* fixed_frame_ = nullptr;
  std::int64_t substeps_done_ = 0;
};

class Box2dBackend final : public Backend {
 public:
  std::string_view name() const override { return kName; }
  std::string_view summary() const override { return "Box2D 2.4: sequential impulses"; }
  Identity identity() const override { return {.version = PLUMB_BOX2D_VERSION, .precision = "float"}; }

  std::vector<Option> options() const override {
    return {{"velocity_iterations", "8", "velocity iterations per substep"},
            {"position_iterations", "3", "position iterations per substep"},
            {"continuous", "on", "on or off: continuous collision against static bodies"}};
  }
  std::vector<Knob> knobs() const override {
    return {{"velocity_iterations", {"1", "2", "4", "8", "16", "32", "64", "128"}},
            {"position_iterations", {"0", "1", "3", "6", "12", "24"}},
            {"continuous", {"off", "on"}, false}};
  }

  Method method(const StepSettings& settings) const override {
    return {.scheme = Scheme::SemiImplicitEuler,
            .order = 1,
            .substep = read_settings(settings).exact_substep,
            .epsilon = std::numeric_limits<float>::epsilon()};
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    read_settings(settings);
    if (const std::string rule = unusual_rule(scene); !rule.empty())
      return rule + ", which Box2D does not have; 'plumb-precise' runs it";
    for (const Body& body : scene.bodies) {
      if (const std::string reason = missing(body); !reason.empty())
        return "body " + plumb::quoted(body.name) + ": " + reason;
    }
    const Box2dJointLimits limits(scene);
    for (const Joint& joint : scene.joints) {
      if (std::string reason = limits.reason(joint); !reason.empty()) return reason;
    }
    return out_of_range(scene, kFloatRange);
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const Box2dSettings chosen = read_settings(settings);
    Settings out{{"dt", shortest(settings.dt)},
                 {"substeps", std::to_string(chosen.substeps)},
                 {"velocity_iterations", std::to_string(chosen.velocity_iterations)},
                 {"position_iterations", std::to_string(chosen.position_iterations)},
                 {"continuous", chosen.continuous ? "on" : "off"},
                 {"warm_starting", "on"},
                 {"sleeping", "off"},
                 {"linear_damping", "the scene's"},
                 {"angular_damping", "the scene's"},
                 {"inertia", "the scene's"},
                 {"filters", "the scene's"}};
    append_contact_rules(out, scene);
    const auto number = [](float value) { return shortest(static_cast<double>(value)); };
    out.insert(out.end(), {{"forces", "at the start of each substep"},
                           {"linear_slop", number(b2_linearSlop) + " m"},
                           {"polygon_radius", number(b2_polygonRadius) + " m"},
                           {"max_translation", number(b2_maxTranslation) + " m a substep"},
                           {"max_rotation", number(b2_maxRotation) + " rad a substep"},
                           {"max_linear_correction", number(b2_maxLinearCorrection) + " m"},
                           {"baumgarte", number(b2_baumgarte)},
                           {"precision", "float"}});
    return out;
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return std::make_unique<Box2dSimulator>(scene, read_settings(settings));
  }

 private:
  static std::string missing(const Body& body) {
    if (body.lock_x || body.lock_y) return "Box2D locks rotation only";
    for (const Shape& shape : body.shapes) {
      if (shape.rolling_resistance != 0) return "Box2D has no rolling resistance";
      if (shape.surface_speed != 0) return "Box2D 2.4 sets surface speeds by callbacks, contact by contact";
      if (std::holds_alternative<Capsule>(shape.geometry)) return "Box2D 2.4 has no capsule";
      if (const auto* polygon = std::get_if<Polygon>(&shape.geometry)) {
        if (polygon->radius > 0) return "Box2D 2.4 has no rounded polygons";
        if (convex_corners(polygon->points).size() > b2_maxPolygonVertices)
          return "Box2D's polygons have at most " + std::to_string(b2_maxPolygonVertices) + " corners";
        if (too_close(convex_corners(polygon->points), true))
          return "Box2D merges corners that are this close";
      }
      if (const auto* chain = std::get_if<Chain>(&shape.geometry)) {
        if (too_close(chain->points, chain->closed)) return "Box2D rejects chain points that are this close";
      }
    }
    return "";
  }

  static bool too_close(const std::vector<Vec2d>& points, bool closed) {
    for (std::size_t i = closed ? 0 : 1; i < points.size(); ++i) {
      const Vec2d way = points[i] - points[i == 0 ? points.size() - 1 : i - 1];
      constexpr double kSlop = static_cast<double>(b2_linearSlop);
      if (length_squared(way) <= kSlop * kSlop) return true;
    }
    return false;
  }

  static Box2dSettings read_settings(const StepSettings& settings) {
    check_steps(kName, settings, Stepping::Fixed);
    const OptionReader given(kName, settings, Box2dBackend().options());
    Box2dSettings out;
    out.substeps = settings.substeps.value_or(1);
    out.exact_substep = settings.dt / out.substeps;
    out.substep = static_cast<float>(out.exact_substep);
    out.velocity_iterations = given.integer("velocity_iterations", 0);
    out.position_iterations = given.integer("position_iterations", 0);
    out.continuous = given.toggle("continuous");
    require_float_step(kName, out.exact_substep);
    return out;
  }
};

const Registration registration{std::make_unique<Box2dBackend>()};

}  // namespace
}  // namespace plumb::reference
