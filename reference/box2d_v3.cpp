//! cmake: include(box2d/libraries.cmake)
//! cmake: set_property(SOURCE ${file} PROPERTY INCLUDE_DIRECTORIES "${PLUMB_BOX2D_V3_HEADERS}")
//! link: plumb_box2d_v3
//! guest: yes
//! missing: find_package(box2d 3) found none; npm has it: plumb engines --install box2d3

// Box2D 3 in float: soft contacts in substeps. The scene's contact rules replace its own.
#include <box2d/box2d.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/text.h"
#include "reference/backend.h"
#include "reference/bullet/turns.h"
#include "reference/guests.h"
#include "reference/support/applied_forces.h"
#include "reference/support/plain_scene.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

b2Vec2 to_box2d(Vec2d v) { return {static_cast<float>(v.x), static_cast<float>(v.y)}; }

struct V3Settings {
  int steps = 1;     // of a dt
  double step = 0;   ///< s
  int substeps = 4;  // per step; Box2D's own default
  bool equalised = true;
};

// One world runs at a time: Box2D's callbacks have no context.
ContactRules rules_in_force;
float mix_friction(float a, auto, float b, auto) {
  return static_cast<float>(combine(rules_in_force.friction, static_cast<double>(a), static_cast<double>(b)));
}
float mix_restitution(float a, auto, float b, auto) {
  return static_cast<float>(
      combine(rules_in_force.restitution, static_cast<double>(a), static_cast<double>(b)));
}

// Reads the centre of mass in world coordinates; versions after 3.1 have renamed the call.
template <class Id>
auto centre_of_mass(Id body) {
  if constexpr (requires { b2Body_GetWorldCenter(body); }) {
    return b2Body_GetWorldCenter(body);
  } else {
    return b2Body_GetWorldCenterOfMass(body);
  }
}

class V3Simulator final : public Simulator {
 public:
  V3Simulator(const Scene& scene, const V3Settings& settings)
      : scene_(scene), settings_(settings), forces_(scene_) {
    b2WorldDef def = b2DefaultWorldDef();
    def.gravity = to_box2d(scene_.gravity);
    def.enableSleep = !settings.equalised;
    if (settings.equalised) {
      def.restitutionThreshold = static_cast<float>(scene_.contact_rules.restitution_threshold);
      def.maximumLinearSpeed = 1e5F;
      def.frictionCallback = mix_friction;
      def.restitutionCallback = mix_restitution;
      rules_in_force = scene_.contact_rules;
    }
    world_ = b2CreateWorld(&def);
    for (const Body& body : scene_.bodies) add_body(body);
    const b2BodyDef at_origin = b2DefaultBodyDef();
    ground_ = b2CreateBody(world_, &at_origin);
    for (const Joint& joint : scene_.joints) std::visit([this](const auto& j) { add_joint(j); }, joint);
  }

  ~V3Simulator() override { b2DestroyWorld(world_); }

  double advance(int steps) override {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps * settings_.steps; ++i) {
      const double from = time(), to = static_cast<double>(done_ + 1) * settings_.step;
      forces_.apply(
          from, to, [this](std::size_t body) { return state_of(body); },
          [this](std::size_t body, const Wrench<double>& wrench) {
            b2Body_ApplyForceToCenter(bodies_[body], to_box2d(wrench.force), true);
            b2Body_ApplyTorque(bodies_[body], static_cast<float>(wrench.torque), true);
          });
      b2World_Step(world_, static_cast<float>(settings_.step), settings_.substeps);
      ++done_;
      for (std::size_t body = 0; body < bodies_.size(); ++body) {
        const b2Rot turn = b2Body_GetRotation(bodies_[body]);
        turns_[body].update(static_cast<double>(turn.c), static_cast<double>(turn.s));
      }
    }
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }

  double time() const override { return static_cast<double>(done_) * settings_.step; }

  void read(std::span<BodyState> out) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) out[i] = state_of(i);
  }

 private:
  BodyState state_of(std::size_t i) const {
    const auto place = centre_of_mass(bodies_[i]);
    const b2Vec2 rate = b2Body_GetLinearVelocity(bodies_[i]);
    return {.position = {static_cast<double>(place.x), static_cast<double>(place.y)},
            .angle = turns_[i].angle(),
            .velocity = {static_cast<double>(rate.x), static_cast<double>(rate.y)},
            .angular_velocity = static_cast<double>(b2Body_GetAngularVelocity(bodies_[i]))};
  }

  void add_body(const Body& body) {
    b2BodyDef def = b2DefaultBodyDef();
    def.type = body.type == BodyType::Static      ? b2_staticBody
               : body.type == BodyType::Kinematic ? b2_kinematicBody
                                                  : b2_dynamicBody;
    def.position = {static_cast<float>(body.position.x), static_cast<float>(body.position.y)};
    def.rotation = b2MakeRot(static_cast<float>(body.angle));
    def.linearVelocity = to_box2d(body.velocity);
    def.angularVelocity = static_cast<float>(body.angular_velocity);
    def.gravityScale = static_cast<float>(body.gravity_scale);
    def.linearDamping = static_cast<float>(body.linear_damping);
    def.angularDamping = static_cast<float>(body.angular_damping);
    def.enableSleep = !settings_.equalised;
    def.allowFastRotation = settings_.equalised;
    fix_rotation(def, body.fixed_rotation);
    const b2BodyId out = b2CreateBody(world_, &def);
    bodies_.push_back(out);
    turns_.emplace_back(body.angle, std::cos(body.angle), std::sin(body.angle));
    for (const Shape& shape : body.shapes) add_shape(out, shape);
    if (body.type != BodyType::Dynamic) return;
    b2MassData mass{};
    mass.mass = static_cast<float>(body.mass);
    mass.rotationalInertia = static_cast<float>(inertia_of(body));
    b2Body_SetMassData(out, mass);
  }

  // One flag became three locks in 3.2.
  template <class Def>
  static void fix_rotation(Def& def, bool fixed) {
    if constexpr (requires { def.motionLocks; }) {
      def.motionLocks.angularZ = fixed;
    } else {
      def.fixedRotation = fixed;
    }
  }

  void add_shape(b2BodyId body, const Shape& shape) {
    b2ShapeDef def = b2DefaultShapeDef();
    def.density = 0;  // the scene states the mass
    def.updateBodyMass = false;
    def.material.friction = static_cast<float>(shape.friction);
    def.material.restitution = static_cast<float>(shape.restitution);
    def.material.rollingResistance = static_cast<float>(shape.rolling_resistance);
    def.material.tangentSpeed = static_cast<float>(shape.surface_speed);
    def.filter.categoryBits = shape.filter.category;
    def.filter.maskBits = shape.filter.mask;
    def.filter.groupIndex = shape.filter.group;
    if (const auto* round = std::get_if<Circle>(&shape.geometry)) {
      const b2Circle circle{to_box2d(shape.position), static_cast<float>(round->radius)};
      b2CreateCircleShape(body, &def, &circle);
    } else if (const auto* box = std::get_if<Box>(&shape.geometry)) {
      const b2Polygon polygon =
          b2MakeOffsetBox(static_cast<float>(box->width / 2), static_cast<float>(box->height / 2),
                          to_box2d(shape.position), b2MakeRot(static_cast<float>(shape.angle)));
      b2CreatePolygonShape(body, &def, &polygon);
    }
  }

  b2BodyId body_called(const std::string& name) const {
    const auto index = find_body(scene_, name);
    return index ? bodies_[*index] : ground_;
  }

  // Since 3.2 the ends of joint definitions are in a base.
  template <class Def, class Of>
  void set_ends(Def& def, const Of& joint) const {
    const b2BodyId a = body_called(joint.body_a), b = body_called(joint.body_b);
    if constexpr (requires { def.base; }) {
      def.base.bodyIdA = a;
      def.base.bodyIdB = b;
      def.base.localFrameA.p = to_box2d(joint.anchor_a);
      def.base.localFrameB.p = to_box2d(joint.anchor_b);
      def.base.collideConnected = joint.collide;
    } else {
      def.bodyIdA = a;
      def.bodyIdB = b;
      def.localAnchorA = to_box2d(joint.anchor_a);
      def.localAnchorB = to_box2d(joint.anchor_b);
      def.collideConnected = joint.collide;
    }
  }

  void add_joint(const RevoluteJoint& joint) {
    b2RevoluteJointDef def = b2DefaultRevoluteJointDef();
    set_ends(def, joint);
    b2CreateRevoluteJoint(world_, &def);
  }
  void add_joint(const DistanceJoint& joint) {
    b2DistanceJointDef def = b2DefaultDistanceJointDef();
    set_ends(def, joint);
    def.length = static_cast<float>(joint.length);
    b2CreateDistanceJoint(world_, &def);
  }
  template <class Other>
  void add_joint(const Other&) {}  // refused

  Scene scene_;
  V3Settings settings_;
  AppliedForces forces_;
  b2WorldId world_{};
  b2BodyId ground_{};
  std::vector<b2BodyId> bodies_;
  std::vector<TurnCounter> turns_;
  std::int64_t done_ = 0;
};

class V3Backend final : public Backend {
 public:
  explicit V3Backend(bool equalised) : equalised_(equalised) {}

  std::string_view name() const override { return equalised_ ? "box2d-v3" : "box2d-v3-default"; }
  std::string_view summary() const override {
    return equalised_ ? "Box2D 3: soft contacts in substeps; settings equalised"
                      : "Box2D 3: soft contacts in substeps; with its default settings";
  }
  Identity identity() const override {
    return {.version = PLUMB_BOX2D_V3_VERSION,
            .precision = "float",
            .guest = true,
            .limits =
                "Box2D v3 finds contacts once per step, solves them and joints as soft constraints in 4 "
                "substeps, leaves a slop of 5 mm, and applies restitution at the end of the step."};
  }

  std::vector<Option> options() const override { return {{"soft_substeps", "4", "Box2D substeps per step"}}; }
  std::vector<Knob> knobs() const override { return {{"soft_substeps", {"1", "2", "4", "8", "16", "32"}}}; }

  Method method(const StepSettings& settings) const override {
    const V3Settings chosen = read_settings(settings);
    return {.scheme = Scheme::SoftStep,
            .order = 1,
            .substep = chosen.step / chosen.substeps,
            .epsilon = static_cast<double>(std::numeric_limits<float>::epsilon())};
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    read_settings(settings);
    for (const Body& body : scene.bodies) {
      if (body.lock_x || body.lock_y) return "locked axes are not mapped";
      if (std::string reason = not_circles_and_boxes(body); !reason.empty()) return reason;
    }
    if (std::string reason = not_plain_joints(scene); !reason.empty()) return reason;
    return out_of_range(scene, kFloatRange);
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const V3Settings chosen = read_settings(settings);
    Settings out{{"dt", shortest(settings.dt)},
                 {"substeps", std::to_string(chosen.steps)},
                 {"soft_substeps", std::to_string(chosen.substeps)},
                 {"contact_hertz", "30"},
                 {"sleeping", equalised_ ? "off" : "on"},
                 {"inertia", "the scene's"}};
    if (equalised_) {
      append_contact_rules(out, scene);
    } else {
      out.emplace_back("contact_rules", "friction geometric mean, restitution maximum, threshold 1 m/s");
    }
    out.insert(out.end(), {{"forces", "at the start of each step"}, {"precision", "float"}});
    return out;
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return std::make_unique<V3Simulator>(scene, read_settings(settings));
  }

 private:
  V3Settings read_settings(const StepSettings& settings) const {
    check_steps(name(), settings, Stepping::Fixed);
    const OptionReader given(name(), settings, options());
    V3Settings out;
    out.steps = settings.substeps.value_or(1);
    out.step = settings.dt / out.steps;
    out.substeps = given.integer("soft_substeps", 1);
    out.equalised = equalised_;
    require_float_step(name(), out.step);
    return out;
  }

  bool equalised_;
};

const GuestRegistration equalised{std::make_unique<V3Backend>(true)};
const GuestRegistration out_of_the_box{std::make_unique<V3Backend>(false)};

}  // namespace
}  // namespace plumb::reference
