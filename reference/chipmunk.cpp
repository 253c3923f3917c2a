//! cmake: include(chipmunk/library.cmake)
//! link: plumb_chipmunk
//! guest: yes
//! missing: Chipmunk was not found; install libchipmunk-dev and build again

// Chipmunk 7 in double. The scene's contact rules replace its own. Its slop and its overlap correction are
// options.
#include <chipmunk/chipmunk.h>

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
#include "reference/guests.h"
#include "reference/support/applied_forces.h"
#include "reference/support/plain_scene.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"
#include "reference/support/silence.h"

namespace plumb::reference {
namespace {

cpVect to_chipmunk(Vec2d v) { return cpv(v.x, v.y); }
Vec2d from_chipmunk(cpVect v) { return {v.x, v.y}; }

// Returns a new space. A debug build of the library prints a banner when a process makes its first one, so
// that one is made in silence.
cpSpace* new_space() {
  static const bool greeted = [] {
    const Silence silence;
    cpSpaceFree(cpSpaceNew());
    return true;
  }();
  static_cast<void>(greeted);
  return cpSpaceNew();
}

struct ChipmunkSettings {
  int substeps = 1;
  double substep = 0;  ///< s
  int iterations = 10;
  double slop = 0;  ///< m
  bool equalised = true;
};

class ChipmunkSimulator final : public Simulator {
 public:
  ChipmunkSimulator(const Scene& scene, const ChipmunkSettings& settings)
      : scene_(scene), settings_(settings), space_(new_space()), forces_(scene_) {
    cpSpaceSetGravity(space_, to_chipmunk(scene_.gravity));
    cpSpaceSetIterations(space_, settings.iterations);
    if (settings.equalised) {
      cpSpaceSetCollisionSlop(space_, settings.slop);
      cpCollisionHandler* handler = cpSpaceAddDefaultCollisionHandler(space_);
      handler->userData = this;
      handler->beginFunc = [](cpArbiter* contact, cpSpace*, cpDataPointer) -> cpBool {
        const auto [a, b] = shapes_of(contact);
        return may_touch(a.filter, b.filter) ? cpTrue : cpFalse;
      };
      handler->preSolveFunc = [](cpArbiter* contact, cpSpace*, cpDataPointer self) -> cpBool {
        const ContactRules& rules = static_cast<ChipmunkSimulator*>(self)->scene_.contact_rules;
        const auto [a, b] = shapes_of(contact);
        cpArbiterSetFriction(contact, combine(rules.friction, a.friction, b.friction));
        cpArbiterSetRestitution(contact, combine(rules.restitution, a.restitution, b.restitution));
        return cpTrue;
      };
    }
    for (const Body& body : scene_.bodies) bodies_.push_back(add_body(body));
    for (const Joint& joint : scene_.joints) std::visit([this](const auto& j) { add_joint(j); }, joint);
  }

  ~ChipmunkSimulator() override {
    for (cpConstraint* joint : joints_) cpSpaceRemoveConstraint(space_, joint), cpConstraintFree(joint);
    for (cpShape* shape : shapes_) cpSpaceRemoveShape(space_, shape), cpShapeFree(shape);
    for (cpBody* body : bodies_) cpSpaceRemoveBody(space_, body), cpBodyFree(body);
    cpSpaceFree(space_);
  }

  double advance(int steps) override {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps * settings_.substeps; ++i) {
      const double from = time(), to = static_cast<double>(done_ + 1) * settings_.substep;
      forces_.apply(
          from, to, [this](std::size_t body) { return state_of(bodies_[body]); },
          [this](std::size_t body, const Wrench<double>& wrench) {
            cpBodySetForce(bodies_[body], to_chipmunk(wrench.force));
            cpBodySetTorque(bodies_[body], wrench.torque);
          });
      cpSpaceStep(space_, settings_.substep);
      ++done_;
    }
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }

  double time() const override { return static_cast<double>(done_) * settings_.substep; }

  void read(std::span<BodyState> out) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) out[i] = state_of(bodies_[i]);
  }

 private:
  struct Pair {
    const Shape& a;
    const Shape& b;
  };
  static Pair shapes_of(cpArbiter* contact) {
    cpShape *a = nullptr, *b = nullptr;
    cpArbiterGetShapes(contact, &a, &b);
    return {*static_cast<const Shape*>(cpShapeGetUserData(a)),
            *static_cast<const Shape*>(cpShapeGetUserData(b))};
  }

  static BodyState state_of(const cpBody* body) {
    return {.position = from_chipmunk(cpBodyGetPosition(body)),
            .angle = cpBodyGetAngle(body),
            .velocity = from_chipmunk(cpBodyGetVelocity(body)),
            .angular_velocity = cpBodyGetAngularVelocity(body)};
  }

  cpBody* add_body(const Body& body) {
    cpBody* out = body.type == BodyType::Static ? cpBodyNewStatic()
                  : body.type == BodyType::Kinematic
                      ? cpBodyNewKinematic()
                      : cpBodyNew(body.mass, body.fixed_rotation ? INFINITY : inertia_of(body));
    cpBodySetPosition(out, to_chipmunk(body.position));
    cpBodySetAngle(out, body.angle);
    cpBodySetVelocity(out, to_chipmunk(body.velocity));
    cpBodySetAngularVelocity(out, body.angular_velocity);
    cpBodySetUserData(out, const_cast<Body*>(&body));
    if (body.gravity_scale != 1)
      cpBodySetVelocityUpdateFunc(out, [](cpBody* self, cpVect gravity, cpFloat damping, cpFloat dt) {
        const double scale = static_cast<const Body*>(cpBodyGetUserData(self))->gravity_scale;
        cpBodyUpdateVelocity(self, cpvmult(gravity, scale), damping, dt);
      });
    cpSpaceAddBody(space_, out);
    for (const Shape& shape : body.shapes)
      std::visit([&](const auto& geometry) { add_shape(out, shape, geometry); }, shape.geometry);
    return out;
  }

  void add(cpShape* out, const Shape& shape) {
    cpShapeSetFriction(out, shape.friction);
    cpShapeSetElasticity(out, shape.restitution);
    cpShapeSetUserData(out, const_cast<Shape*>(&shape));
    if (!settings_.equalised)
      cpShapeSetFilter(out, cpShapeFilterNew(0, folded(shape.filter.category), folded(shape.filter.mask)));
    shapes_.push_back(cpSpaceAddShape(space_, out));
  }

  static cpTransform place_of(const Shape& shape) {
    return cpTransformRigid(to_chipmunk(shape.position), shape.angle);
  }

  void add_shape(cpBody* body, const Shape& shape, const Circle& circle) {
    add(cpCircleShapeNew(body, circle.radius, to_chipmunk(shape.position)), shape);
  }
  void add_shape(cpBody* body, const Shape& shape, const Box& box) {
    const double x = box.width / 2, y = box.height / 2;
    const cpVect corners[] = {cpv(x, -y), cpv(x, y), cpv(-x, y), cpv(-x, -y)};
    add(cpPolyShapeNew(body, 4, corners, place_of(shape), 0), shape);
  }
  void add_shape(cpBody* body, const Shape& shape, const Capsule& capsule) {
    const cpTransform place = place_of(shape);
    add(cpSegmentShapeNew(body, cpTransformPoint(place, to_chipmunk(capsule.start)),
                          cpTransformPoint(place, to_chipmunk(capsule.end)), capsule.radius),
        shape);
  }
  void add_shape(cpBody* body, const Shape& shape, const Segment& segment) {
    const cpTransform place = place_of(shape);
    add(cpSegmentShapeNew(body, cpTransformPoint(place, to_chipmunk(segment.start)),
                          cpTransformPoint(place, to_chipmunk(segment.end)), 0),
        shape);
  }
  void add_shape(cpBody* body, const Shape& shape, const Polygon& polygon) {
    std::vector<cpVect> corners;
    for (const Vec2d point : polygon.points) corners.push_back(to_chipmunk(point));
    add(cpPolyShapeNew(body, static_cast<int>(corners.size()), corners.data(), place_of(shape),
                       polygon.radius),
        shape);
  }
  void add_shape(cpBody*, const Shape&, const Chain&) {}  // refused

  cpBody* body_called(const std::string& name) {
    const auto index = find_body(scene_, name);
    return index ? bodies_[*index] : cpSpaceGetStaticBody(space_);
  }

  void keep(cpConstraint* joint, bool collide) {
    cpConstraintSetCollideBodies(joint, collide ? cpTrue : cpFalse);
    joints_.push_back(cpSpaceAddConstraint(space_, joint));
  }
  void add_joint(const RevoluteJoint& joint) {
    keep(cpPivotJointNew2(body_called(joint.body_a), body_called(joint.body_b), to_chipmunk(joint.anchor_a),
                          to_chipmunk(joint.anchor_b)),
         joint.collide);
  }
  void add_joint(const DistanceJoint& joint) {
    cpConstraint* out = cpPinJointNew(body_called(joint.body_a), body_called(joint.body_b),
                                      to_chipmunk(joint.anchor_a), to_chipmunk(joint.anchor_b));
    cpPinJointSetDist(out, joint.length);
    keep(out, joint.collide);
  }
  template <class Other>
  void add_joint(const Other&) {}  // refused

  Scene scene_;  // bodies and shapes point into it
  ChipmunkSettings settings_;
  cpSpace* space_;
  AppliedForces forces_;
  std::vector<cpBody*> bodies_;
  std::vector<cpShape*> shapes_;
  std::vector<cpConstraint*> joints_;
  std::int64_t done_ = 0;
};

class ChipmunkBackend final : public Backend {
 public:
  explicit ChipmunkBackend(bool equalised) : equalised_(equalised) {}

  std::string_view name() const override { return equalised_ ? "chipmunk" : "chipmunk-default"; }
  std::string_view summary() const override {
    return equalised_ ? "Chipmunk 7: sequential impulses; settings equalised"
                      : "Chipmunk 7: sequential impulses; with its default settings";
  }
  Identity identity() const override {
    return {.version = cpVersionString,
            .precision = "double",
            .guest = true,
            .limits =
                "Chipmunk integrates positions before velocities, so that forces act one step late. It makes "
                "10 iterations per step and removes a tenth of an overlap in 1/60 s."};
  }

  std::vector<Option> options() const override {
    std::vector<Option> out{{"iterations", "10", "iterations per substep"}};
    if (equalised_)
      out.push_back({"slop", "0.001", "m, of overlap that contacts leave alone; Chipmunk's own is 0.1"});
    return out;
  }
  std::vector<Knob> knobs() const override { return {{"iterations", {"1", "5", "10", "20", "50", "100"}}}; }

  // Positions use the old velocities, velocities the new positions: with the forces of the step's start this
  // is the explicit Euler method.
  Method method(const StepSettings& settings) const override {
    return {.scheme = Scheme::ExplicitEuler,
            .order = 1,
            .substep = read_settings(settings).substep,
            .epsilon = std::numeric_limits<double>::epsilon()};
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    read_settings(settings);
    for (const Body& body : scene.bodies)
      if (const std::string reason = missing(body); !reason.empty())
        return "body " + plumb::quoted(body.name) + ": " + reason;
    if (std::string reason = not_plain_joints(scene); !reason.empty()) return reason;
    return out_of_range(scene, kDoubleRange);
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const ChipmunkSettings chosen = read_settings(settings);
    Settings out{{"dt", shortest(settings.dt)},
                 {"substeps", std::to_string(chosen.substeps)},
                 {"iterations", std::to_string(chosen.iterations)},
                 {"collision_slop", shortest(equalised_ ? chosen.slop : 0.1) + " m"},
                 {"collision_bias", "0.9^60 of an overlap is left after a second"},
                 {"sleeping", "off"},
                 {"inertia", "the scene's"}};
    if (equalised_) {
      append_contact_rules(out, scene);
    } else {
      out.emplace_back("contact_rules", "friction product, restitution product");
    }
    out.insert(out.end(), {{"forces", "at the start of each substep"}, {"precision", "double"}});
    return out;
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return std::make_unique<ChipmunkSimulator>(scene, read_settings(settings));
  }

 private:
  static std::string missing(const Body& body) {
    if (body.lock_x || body.lock_y) return "Chipmunk locks rotation only";
    if (body.linear_damping != 0 || body.angular_damping != 0)
      return "Chipmunk has one damping for all bodies";
    for (const Shape& shape : body.shapes) {
      if (shape.rolling_resistance != 0) return "Chipmunk has no rolling resistance";
      if (shape.surface_speed != 0) return "Chipmunk's surface velocities are not mapped";
      if (std::holds_alternative<Chain>(shape.geometry))
        return "Chipmunk's chains of segments are not mapped";
    }
    return "";
  }

  ChipmunkSettings read_settings(const StepSettings& settings) const {
    check_steps(name(), settings, Stepping::Fixed);
    const OptionReader given(name(), settings, options());
    ChipmunkSettings out;
    out.substeps = settings.substeps.value_or(1);
    out.substep = settings.dt / out.substeps;
    out.iterations = given.integer("iterations", 1);
    out.equalised = equalised_;
    if (equalised_) out.slop = given.number("slop", 0);
    return out;
  }

  bool equalised_;
};

const GuestRegistration equalised{std::make_unique<ChipmunkBackend>(true)};
const GuestRegistration out_of_the_box{std::make_unique<ChipmunkBackend>(false)};

}  // namespace
}  // namespace plumb::reference
